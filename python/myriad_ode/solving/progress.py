# SPDX-License-Identifier: MIT
"""What shows how many instances are done: a function of the user's, or a bar."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from typing import TYPE_CHECKING

from ..base.errors import Error

if TYPE_CHECKING:
    from ..symbolic.types import Progress


def in_notebook() -> bool:
    """Whether a shell of IPython runs in this process; a program that only imports its packages is none."""
    ipython = sys.modules.get("IPython")
    return ipython is not None and ipython.get_ipython() is not None


class ProgressDisplay:
    """A function of the numbers of instances done and of all, or a bar."""

    def __init__(self, wanted: Progress) -> None:
        self._function, self._bar = wanted if callable(wanted) else None, None
        if wanted and not callable(wanted):
            try:
                from tqdm.auto import tqdm
            except ImportError:
                raise Error("progress=True shows a bar of the package tqdm, which is missing: `pip install tqdm`, or "
                            "give a function of two numbers, instances done and all") from None
            # a file keeps every frame, which a terminal or a notebook draws over
            seconds = 0.1 if sys.stderr.isatty() or in_notebook() else 5.0
            self._bar = tqdm(unit="instance", unit_scale=True, mininterval=seconds, miniters=1)

    def __call__(self, done: int, total: int, earlier: int = 0, seconds: float = 0.0,
                 by_status: Mapping[str, int] | None = None) -> None:
        if self._function is not None:
            self._function(done, total)
        if self._bar is not None:
            self._bar.total, self._bar.initial = total, earlier
            failed = {n: c for n, c in (by_status or {}).items() if not n.startswith(("success", "stopped"))}
            self._bar.set_postfix(failed, refresh=False)
            self._bar.update(done - self._bar.n)  # draws it if it was drawn `mininterval` ago

    def close(self) -> None:
        """Ends the bar."""
        if self._bar is not None:
            self._bar.close()
