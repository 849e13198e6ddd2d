# SPDX-License-Identifier: MIT
"""Runs from their files."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..sweeps.inputs import path_text
from . import saved_file
from .run import Run

if TYPE_CHECKING:
    from ..symbolic.types import Path

__all__ = ["load"]


def load(path: Path) -> Run:
    """The run that `run.save(path)` has written, with all its results, derivatives and counts by the same names, and
    its report. It needs neither the model nor a compiler, and nothing in the file is executed. Raises `Error` of a file
    that is damaged, of another kind, or of a newer version."""
    path = path_text(path)
    header, arrays = saved_file.read(path)
    try:
        return Run._restored(header, arrays)
    except saved_file.damages as error:
        raise saved_file.damaged(path, error) from None
