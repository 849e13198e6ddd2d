# SPDX-License-Identifier: MIT
"""What users are told while they wait for a compiler."""

from __future__ import annotations

import contextlib
import sys
import threading
from collections.abc import Iterator

_patience = 0.5  # seconds without a word


def seconds_to_compile(source: str, stages: int) -> float:
    """A rough guess at how long a compiler takes for a kernel, from the length of the model's source and the stages of
    its method."""
    return 1.5 + len(source) * (1 + stages / 8) / 3000


def _in_words(seconds: float) -> str:
    """How long that is on a computer of which nobody knows how fast and how busy it is."""
    return "some seconds" if seconds < 8 else "up to a minute" if seconds < 30 else "minutes"


@contextlib.contextmanager
def told(what: str, seconds: float) -> Iterator[None]:
    """Says on standard error what is being compiled, if it takes longer than half a second."""
    timer = threading.Timer(_patience, lambda: print(f"compiling {what} ({_in_words(seconds)}, once)",
                                                     file=sys.stderr, flush=True))
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()
