# SPDX-License-Identifier: MIT
"""How a run went, or what ended it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NoReturn

from ..base.core_words import in_words
from ..base.errors import Error
from ..base.statuses import status_names


class Interrupted(KeyboardInterrupt):
    """Ctrl-C ended a call. Of `solve` and of studies `run` has the instances that were done, and the others as
    not_started, or as interrupted if they were under way and took more than half a second longer. Of `fit` `fit` has
    the best values so far, and `run` is None."""

    def __init__(self, run: Any, fit: Any = None) -> None:
        super().__init__(f"{run.done} of {run.size} instances were done; .run has them" if fit is None else
                         f"the least loss so far is {fit.loss[fit.index]:.6g}; .fit has its values")
        self.run = run
        self.fit = fit


class Report:
    """How the instances ended, the work, where it was done, and where the kernel came from."""

    def __init__(self, report: Any, kernel: Any, seconds: float, notes: Sequence[str] = ()) -> None:
        self._report = report
        self.notes = [*map(in_words, report.notes), *notes]  #: what else to know
        #: "compiled by g++", "cache" (on disk), "memory" (of this process), or "interpreted" and why;
        #: with a note if the cache cannot be used
        self.kernel = kernel.origin
        self.compile_seconds = kernel.seconds  #: that it took to get the kernel, compiled or from the cache
        self.total_seconds = seconds  #: of the whole call

    def __getattr__(self, name: str) -> Any:
        if name == "_report":  # of one that was made without __init__, as by `copy`
            raise AttributeError(name)
        return getattr(self._report, name)

    def __reduce__(self) -> NoReturn:
        raise Error("a report cannot be pickled or copied: keep str(report), or the numbers that you need")

    @property
    def by_status(self) -> dict[str, int]:
        """Number of instances by the name of their status, those that occur."""
        return {name: count for name, count in zip(status_names, self._report.by_status) if count}

    def __str__(self) -> str:
        text = "\n".join([str(self._report).rstrip("\n"), *(f"note: {note}" for note in self.notes)])
        origin = f"from {self.kernel}" if self.kernel in ("cache", "memory") else self.kernel
        if not self.kernel.startswith("interpreted"):
            origin += f" in {self.compile_seconds:.3g} s"
        return f"{text}\nkernel {origin}; {self.total_seconds:.3g} s in all"

    __repr__ = __str__
