# SPDX-License-Identifier: MIT
"""Compiles models to kernels in shared objects, by the C++ compiler of this machine, and keeps them in the cache."""

import importlib.util
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import time
from dataclasses import dataclass

from . import _core, cache, precompiled
from .errors import Error

_include = pathlib.Path(__file__).parent / "include"

# -march for each of the core's instruction sets, spelt out so that machines that share a cache agree on its meaning.
_architectures = {"avx512": "x86-64-v4", "avx2": "x86-64-v3", "sse2": "x86-64-v2", "generic": None}
_flags = ["-std=c++20", "-O3", "-fPIC", "-shared", "-fvisibility=hidden", "-ffp-contract=off", "-fno-math-errno"]
_oldest = {"g++": 12, "clang++": 14}


@dataclass(frozen=True)
class Compiler:
    """A C++ compiler: the command, what it is, and what tells it from others and from its own updates."""

    command: tuple
    kind: str
    identity: str

    def flags(self, instruction_set):
        """The flags for kernels."""
        flags = list(_flags)
        architecture = _architectures[instruction_set]
        if architecture:
            flags.append("-march=" + (architecture.replace("-", "_") if self.kind == "zig" else architecture))
        if self.kind == "g++":  # large objects in registers, as in the C++ build
            flags.append("--param=sra-max-scalarization-size-Ospeed=2048")
        else:
            flags.append("-Wno-pass-failed")
        return flags


def _identity(program):
    facts = os.stat(program)
    return f"{os.path.realpath(program)} {facts.st_size} {facts.st_mtime_ns}"


def _major_version(command):
    try:
        told = subprocess.run([*command, "-dumpversion"], capture_output=True, text=True, timeout=60, check=True).stdout
        return int(told.split(".")[0])
    except (OSError, ValueError, subprocess.SubprocessError):
        return 0


def _kind_of(program):
    name = os.path.basename(program)
    return "clang++" if "clang" in name else "g++"


def _compiler_of(chosen, variable):
    """The compiler that a variable of the environment names: a program, maybe with arguments, and maybe behind one that
    calls it, as in "ccache g++ -fno-plt"."""
    try:
        words = [chosen] if shutil.which(chosen) else shlex.split(chosen)  # a path may have blanks
    except ValueError as why:
        raise Error(f"{variable} is {chosen!r}, which is no command: {why}") from None
    program = shutil.which(words[0]) if words else None
    if program is None:
        raise Error(f"{variable} is {chosen!r}, and there is no such program: give a C++ compiler (g++ 12, clang++ 14 "
                    "or newer) by its path, maybe with arguments, or unset the variable")
    called = next((found for word in words[1:] if not word.startswith("-") and _is_compiler(word) and
                   (found := shutil.which(word))), program)
    return Compiler((program, *words[1:]), _kind_of(called), f"{_identity(called)} {words[1:]}")


def _is_compiler(word):
    return re.search(r"(g|clang|c)\+\+(-[0-9.]+)?$", word) is not None


def find_compiler():
    """The compiler to use: that of $MYRIAD_CXX or $CXX, clang++ or g++ on the PATH, or the one of the package ziglang;
    None if there is none."""
    if chosen := os.environ.get("MYRIAD_CXX"):
        return _compiler_of(chosen, "MYRIAD_CXX")
    if chosen := os.environ.get("CXX"):  # meant for all programs: one that cannot compile models is passed over
        named = _compiler_of(chosen, "CXX")
        if any(map(_is_compiler, named.command)) and _major_version(named.command) >= _oldest[named.kind]:
            return named
    for name, oldest in (("clang++", _oldest["clang++"]), ("g++", _oldest["g++"])):
        program = shutil.which(name)
        if program is not None and _major_version([program]) >= oldest:
            return Compiler((program,), name, _identity(program))
    zig = importlib.util.find_spec("ziglang")
    if zig is not None and zig.origin is not None:
        # Its program, and not `python -m ziglang`, which would run a ziglang.py of the current folder.
        program = pathlib.Path(zig.origin).parent / "zig"
        if program.is_file():
            return Compiler((str(program), "c++"), "zig", _identity(program))
    return None


_found: dict = {}


def known_compiler():
    """What `find_compiler` found for these variables of the environment."""
    asked = tuple(map(os.environ.get, ("MYRIAD_CXX", "CXX", "PATH")))
    if asked not in _found:
        _found[asked] = find_compiler()
    return _found[asked]


def compiler():
    """The compiler of this process. Raises `Error` if there is none."""
    found = known_compiler()
    if found is None:
        raise Error("there is no C++ compiler to compile the model with: install clang++ 14 or g++ 12 or newer, or "
                    "`pip install ziglang`, or name a compiler in the environment variable MYRIAD_CXX")
    return found


def first_message(output):
    """The first error of a compiler's output, without the path of the file it compiled."""
    for line in output.splitlines():
        if "error:" in line:
            return line.split("error:", 1)[1].strip()
    lines = output.strip().splitlines()
    return lines[-1] if lines else "it says nothing"


def source_of(header, struct, method, real):
    """The file that is compiled: the model's header and the request for its kernel."""
    return (f"#include <{precompiled.HEADER}>\n\n{header}\n"
            f"using myriad_method = {method};\nMYRIAD_KERNEL_LIBRARY({struct}, myriad_method, {real})\n")


def _run(command):
    try:
        return subprocess.run(command, capture_output=True, text=True, errors="replace", check=False,
                              stdin=subprocess.DEVNULL)
    except OSError as why:
        raise Error(f"the compiler {command[0]} cannot be run: {why.strerror}") from None


def _compile(by, flags, source, workplace):
    file, made = workplace / "model.cpp", workplace / "model.so"
    file.write_text(source, encoding="utf-8")
    command = [*by.command, *flags, f"-I{_include}", str(file), "-o", str(made)]
    key = precompiled.key_of(by, flags, _core.headers)
    headers = precompiled.arguments(key, by)
    done = _run([*command, *headers])
    if headers and done.returncode != 0:  # they may be damaged, and messages are better without
        done = _run(command)
    elif not headers and done.returncode == 0:
        precompiled.begin(key, by, flags, _include)
    if done.returncode != 0 or not made.exists():
        raise Error(f"the model does not compile ({os.path.basename(by.command[0])}): "
                    f"{first_message(done.stderr + done.stdout)}")
    return made


def _load(by, path):
    try:
        return _core.Library(str(path))
    except Error as error:
        raise Error(f"what {os.path.basename(by.command[0])} made of the model cannot be loaded: use a C++ compiler, "
                    f"such as g++ and not gcc ({error})") from None


@dataclass(frozen=True)
class Kernel:
    """A loaded kernel and where it came from."""

    library: object
    origin: str  # "compiled by g++", "cache", "memory", or "interpreted" and why
    seconds: float  # that it took to get


_loaded: dict = {}


def _instruction_set():
    chosen = os.environ.get("MYRIAD_INSTRUCTION_SET") or _core.instruction_set()
    if chosen not in _architectures:
        raise Error(f"MYRIAD_INSTRUCTION_SET is {chosen!r}: name one of {', '.join(_architectures)}, or unset the "
                    "variable")
    return chosen


def prepare():
    """Has the compiler of this process prepare the library's headers; returns whether it can."""
    by = compiler()
    flags = by.flags(_instruction_set())
    return precompiled.prepare(precompiled.key_of(by, flags, _core.headers), by, flags, _include)


def kernel(header, struct, method, real):
    """The kernel of a model, which is C++ source with a struct of that name, for a method and a real type, both as C++
    types. Raises `Error` if there is no compiler, or with its first message if it refuses the model."""
    begin = time.perf_counter()
    instruction_set = _instruction_set()
    asked = (header, struct, method, real, instruction_set, os.environ.get("MYRIAD_CXX"),
             os.environ.get("CXX"))
    if asked in _loaded:
        return Kernel(_loaded[asked], "memory", time.perf_counter() - begin)
    by = compiler()
    flags = by.flags(instruction_set)
    source = source_of(header, struct, method, real)
    key = cache.key_of({"source": source, "version": _core.version, "headers": _core.headers, "flags": flags,
                        "compiler": by.identity})
    obtained = cache.obtain(key, lambda workplace: _compile(by, flags, source, workplace), lambda path: _load(by, path))
    _loaded[asked] = obtained.loaded
    origin = "cache" if obtained.hit else f"compiled by {by.kind}"
    if obtained.unusable is not None:
        origin += f" ({obtained.unusable}; MYRIAD_CACHE_DIR names another folder)"
    return Kernel(_loaded[asked], origin, time.perf_counter() - begin)
