# SPDX-License-Identifier: MIT
"""Formulas of files that are nested, or follow from each other, more deeply than Python's stack allows."""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable
from typing import Any, TypeVar

from ..base.errors import Error, caller, users_line

Result = TypeVar("Result")
_frames = 100_000
_stack = 512 << 20  # of which a reader that is not so deep touches little


def deeply(read: Callable[[], Result]) -> Result:
    """What a reader returns, which starts anew on a deep stack if the usual one is not enough."""
    try:
        return read()
    except RecursionError:
        pass
    line, found, failure = users_line(), list[Result](), list[BaseException]()

    def work() -> None:
        caller.line = line
        try:
            found.append(read())
        except BaseException as why:
            failure.append(why)

    usual_frames, usual_stack = sys.getrecursionlimit(), threading.stack_size(_stack)
    try:
        sys.setrecursionlimit(max(usual_frames, _frames))
        thread = threading.Thread(target=work, daemon=True)
        thread.start()
        thread.join()
    finally:
        threading.stack_size(usual_stack)
        sys.setrecursionlimit(usual_frames)
    if failure:
        why: Any = failure[0]
        if isinstance(why, RecursionError):
            raise Error("the formulas of the file are nested too deeply: write them in parts") from None
        raise why
    return found[0]
