# SPDX-License-Identifier: MIT
"""How instances end."""

from __future__ import annotations

from typing import Any

import numpy as np

from .. import _core

status_names: tuple[str, ...] = tuple(_core.status_names())  #: the names of statuses, by their numbers
first_failure = status_names.index("max_steps")
# A number beyond the last stands for a status that there is not yet: of what a study has not done.
_words = np.array([*status_names, *["not_started"] * (256 - len(status_names))])


def in_words(codes: Any) -> Any:
    """Statuses in words, of an array of their numbers."""
    return _words[np.asarray(codes)]
