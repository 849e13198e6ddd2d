# SPDX-License-Identifier: MIT
"""Files that are made once and kept in the cache of compiled models, which the program `myriad` has too: the core's."""

from __future__ import annotations

import ctypes
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from .. import _core


@dataclass(frozen=True)
class Obtained:
    """What `obtain` loaded, whether it was in the cache, and why it is not kept, if that is so."""

    loaded: Any
    hit: bool
    unusable: object = None


def obtain(made_from: bytes, make: Callable[[str], object], load: Callable[[str], object]) -> Obtained:
    """What `load(path)` makes of a file that was made from something, as `Obtained`. `made_from` has everything that it
    depends on, as bytes. If there is no such file that is whole and can be loaded, `make(folder)` writes it there, as
    model.so; other processes that want the same wait for it. A file that cannot be loaded is not kept."""
    loaded, hit, objection, distrusted = _core.obtain(made_from, make, load)
    if distrusted:
        warnings.warn(objection, RuntimeWarning, stacklevel=2)
    return Obtained(loaded, hit, None if hit else objection or None)


def functions(by: _core.Compiler, source: str, make: Callable[[str], object]) -> ctypes.CDLL:
    """The functions of a library that `make(folder)` has a compiler make of a source, for `ctypes`."""
    made_from = by.made_from(source)

    def load(path: str) -> ctypes.CDLL:
        return ctypes.CDLL(path, handle=_core.load_library(path, made_from))

    library: ctypes.CDLL = obtain(made_from, make, load).loaded
    return library
