# SPDX-License-Identifier: MIT
"""Compiles models to kernels in shared objects, by the C++ compiler of this machine, and keeps them in the cache."""

import contextlib
import importlib.util
import math
import os
import pathlib
import threading
import time
from dataclasses import dataclass
from typing import Any

from .. import _core
from ..base.errors import Error
from ..models.methods import stages_of
from . import compiled_files
from .told import seconds_to_compile, told

_include = pathlib.Path(__file__).parents[1] / "include"


def find_compiler() -> _core.Compiler | None:
    """The compiler to use: what $MYRIAD_CXX or $CXX names, g++ or clang++ on the PATH, or the compiler of the package
    ziglang; None if there is none."""
    zig = importlib.util.find_spec("ziglang")
    # Its program, and not `python -m ziglang`, which would run a ziglang.py of the current folder.
    program = "" if zig is None or zig.origin is None else str(pathlib.Path(zig.origin).parent / "zig")
    return _core.find_compiler(str(_include), program)


_found: dict[Any, _core.Compiler | None] = {}


def known_compiler() -> _core.Compiler | None:
    """What `find_compiler` found for these variables of the environment."""
    asked = tuple(map(os.environ.get, ("MYRIAD_CXX", "CXX", "PATH")))
    if asked not in _found:
        _found[asked] = find_compiler()
    return _found[asked]


def compiler() -> _core.Compiler:
    """The compiler of this process. Raises `Error` if there is none."""
    if (found := known_compiler()) is not None:
        return found
    _core.refuse_without_compiler()
    raise AssertionError  # never, as that raises


def source_of(header: str, struct: str, method: str, real: str) -> str:
    """The file that is compiled: the model's header and the request for its kernel."""
    return (f"#include <myriad/python/kernel_library.hpp>\n\n{header}\n"
            f"using myriad_method = {method};\nMYRIAD_KERNEL_LIBRARY({struct}, myriad_method, {real})\n")


_begun: set[str] = set()


def most_seconds() -> float:
    """How long a compiler may take before it counts as hanging: $MYRIAD_COMPILE_SECONDS, or a quarter of an hour."""
    given = os.environ.get("MYRIAD_COMPILE_SECONDS") or "900"
    try:
        seconds = float(given)
    except ValueError:
        seconds = math.nan
    if not seconds > 0:
        raise Error(f"MYRIAD_COMPILE_SECONDS is {given!r}, and not a number of seconds above zero: set it to one, or "
                    "unset it")
    return seconds


def _compile(by: _core.Compiler, source: str, folder: str) -> None:
    """Compiles, and then has the compiler prepare the library's headers beside the program's own work, if they are not.
    A program that ends earlier waits for that, a few seconds at most."""
    if not by.compile(source, folder, most_seconds()) and by.identity not in _begun:
        _begun.add(by.identity)
        threading.Thread(target=_prepare, args=(by,)).start()


def _prepare(by: _core.Compiler) -> None:
    with contextlib.suppress(Error):  # the cache cannot be used, of which the call itself has told
        by.prepare()


def _load(by: _core.Compiler, path: str, made_from: bytes) -> _core.Library:
    try:
        return _core.Library(path, made_from)
    except Error as error:
        raise Error(f"what {by.name} made of the model cannot be loaded: use a C++ compiler, such as g++ and not gcc "
                    f"({error})") from None


@dataclass(frozen=True)
class Kernel:
    """A loaded kernel and where it came from."""

    library: Any  # of the core; None for a run without instances
    origin: str  # "compiled by g++", "cache", "memory", or "interpreted" and why
    seconds: float  # that it took to get


def kernel_of(obtained: compiled_files.Obtained, by: str, begin: float) -> Kernel:
    """What was obtained from the cache as a `Kernel`."""
    why = f" ({obtained.unusable})" if obtained.unusable else ""
    return Kernel(obtained.loaded, "cache" if obtained.hit else f"compiled by {by}{why}", time.perf_counter() - begin)


_loaded: dict[Any, _core.Library] = {}


def kernel(header: str, struct: str, method: str, real: str, name: str = "") -> Kernel:
    """The kernel of a model, which is C++ source with a struct of that name, for a method and a real type, both as C++
    types; `name`: of the model, for what users are told. Raises `Error` if there is no compiler, or with its first
    message if it refuses the model."""
    begin = time.perf_counter()
    asked = (header, struct, method, real,
             *map(os.environ.get, ("MYRIAD_INSTRUCTION_SET", "MYRIAD_CXX", "CXX")))
    if asked in _loaded:
        return Kernel(_loaded[asked], "memory", time.perf_counter() - begin)
    by = compiler()
    source = source_of(header, struct, method, real)
    made_from = by.made_from(source)
    with told(name or struct, seconds_to_compile(header, stages_of(method))):
        obtained = compiled_files.obtain(made_from, lambda folder: _compile(by, source, folder),
                                         lambda path: _load(by, path, made_from))
    _loaded[asked] = obtained.loaded
    return kernel_of(obtained, by.kind, begin)
