# SPDX-License-Identifier: MIT
"""The cache of compiled models on disk, which the program `myriad` has too: the core's."""

from __future__ import annotations

import pathlib

from .. import _core
from . import compiler

__all__ = ["clear", "directory", "prepare"]


def directory() -> pathlib.Path:
    """The folder of the cache: $MYRIAD_CACHE_DIR, or myriad in the user's folder of caches. It may not exist yet."""
    return pathlib.Path(_core.cache_folder())


def prepare() -> bool:
    """Has the compiler prepare the library's headers now, as after an installation or while an image of a container is
    made, so that the very first model compiles as fast as later ones. Returns False where the compiler prepares none.
    Raises `Error` if there is no compiler, or if the folder of the cache cannot be used."""
    return compiler.compiler().prepare()


def clear() -> int:
    """Removes all compiled models from the cache; returns how many."""
    return _core.clear_cache()


def __dir__() -> list[str]:
    return sorted(__all__)
