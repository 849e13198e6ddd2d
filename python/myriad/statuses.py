# SPDX-License-Identifier: MIT
"""How instances end."""

from . import _core

status_names = tuple(_core.status_names())
first_failure = status_names.index("max_steps")
