# SPDX-License-Identifier: MIT
"""How instances end."""

from __future__ import annotations

from .. import _core

status_names: tuple[str, ...] = tuple(_core.status_names())  #: the names of statuses, by their numbers
first_failure = status_names.index("max_steps")
