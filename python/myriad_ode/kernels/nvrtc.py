# SPDX-License-Identifier: MIT
"""Compiles models to kernels for GPUs by NVRTC, of a wheel or of the system's CUDA, and keeps them in the cache."""

from __future__ import annotations

import ctypes
import functools
import importlib.util
import json
import os
import pathlib
import re
import sys
import time
from collections.abc import Callable, Sequence
from typing import Any

from .. import _core
from ..base.errors import Error
from ..models.methods import stages_of
from . import compiled_files
from .compiler import Kernel, kernel_of
from .told import seconds_to_compile, told

_oldest = 12, 6  # older ones crash
_include = pathlib.Path(__file__).parents[1] / "include"
_options = ["-std=c++20", "-default-device", f"-I{_include}"]
_exact_float = "#define MYRIAD_EXACT_FLOAT\n"  # in a model: as in the library for C++ (cmake/MyriadKernelFlags.cmake)
# NVRTC has no standard library: the part that kernels use is one header.
_standard = {name: "#include <myriad/python/standard_library.hpp>\n" for name in (
    "algorithm", "array", "bit", "cmath", "concepts", "cstddef", "cstdint", "cstring", "iterator", "limits", "numbers",
    "string_view", "type_traits", "utility")}


def _candidates() -> list[pathlib.Path]:
    """Where NVRTC may be: $MYRIAD_NVRTC, the wheels nvidia-cuda-nvrtc (-cu12), Conda's, Debian's and CUDA's own
    folders."""
    if chosen := os.environ.get("MYRIAD_NVRTC"):
        return [pathlib.Path(chosen)]
    found: list[pathlib.Path] = []
    spec = importlib.util.find_spec("nvidia")
    for folder in (spec.submodule_search_locations or ()) if spec else ():
        found += pathlib.Path(folder).glob("*/lib/libnvrtc.so.[0-9]*")
    for home in (os.environ.get("CUDA_HOME"), os.environ.get("CUDA_PATH"), "/usr/local/cuda"):
        if home:
            found += pathlib.Path(home).glob("lib64/libnvrtc.so.[0-9][0-9]")
    found += pathlib.Path(sys.prefix).glob("lib/libnvrtc.so.[0-9][0-9]")
    found += pathlib.Path("/usr/lib").glob("*-linux-gnu/libnvrtc.so.[0-9][0-9]")
    return found


def _major(path: pathlib.Path) -> int:
    number = re.search(r"\.so\.(\d+)", path.name)
    return int(number.group(1)) if number else 0


@functools.lru_cache(maxsize=4)
def _find(chosen: str | None, driver: int) -> pathlib.Path | None:
    """The newest NVRTC that the driver can load kernels of; where there is none such, the oldest."""
    found = sorted((p for p in _candidates() if p.is_file()), key=_major)  # of equal ones, a wheel's comes first
    fitting = [p for p in found if _major(p) <= driver]
    if fitting:
        newest = _major(fitting[-1])
        return next(p for p in fitting if _major(p) == newest)
    return found[0] if found else None


def find() -> pathlib.Path | None:
    """The path of NVRTC's library, or None if there is none."""
    return _find(os.environ.get("MYRIAD_NVRTC"), _core.driver_version() // 1000 or 1 << 30)


def _found() -> pathlib.Path:
    """The same. Raises `Error` if there is none."""
    path = find()
    if path is None:
        if chosen := os.environ.get("MYRIAD_NVRTC"):
            raise Error(f"MYRIAD_NVRTC is {chosen!r}, and there is no such file: give the path of libnvrtc.so, or "
                        "unset the variable")
        raise Error("there is no NVRTC to compile the model for the GPU with: `pip install nvidia-cuda-nvrtc`, or "
                    "name its library in the environment variable MYRIAD_NVRTC")
    return path


def library() -> _Nvrtc:
    """NVRTC's library. Raises `Error` if there is none."""
    return _load(_found())


@functools.lru_cache(maxsize=4)
def _load(path: pathlib.Path) -> _Nvrtc:
    try:
        return _Nvrtc(ctypes.CDLL(str(path)))
    except (OSError, AttributeError) as why:
        raise Error(f"NVRTC cannot be loaded from {path} ({why}): `pip install nvidia-cuda-nvrtc`, or name its library "
                    "in the environment variable MYRIAD_NVRTC") from None


class _Nvrtc:
    """The functions of NVRTC that compile a program."""

    def __init__(self, functions: ctypes.CDLL) -> None:
        self._functions = functions
        count = ctypes.c_int()
        self._call("nvrtcGetNumSupportedArchs", ctypes.byref(count))
        architectures = (ctypes.c_int * count.value)()
        self._call("nvrtcGetSupportedArchs", architectures)
        self.architectures = sorted(architectures)  #: 75 for compute capability 7.5, and so on
        major, minor = ctypes.c_int(), ctypes.c_int()
        self._call("nvrtcVersion", ctypes.byref(major), ctypes.byref(minor))
        self.version = f"{major.value}.{minor.value}"
        if (major.value, minor.value) < _oldest:
            raise Error(f"NVRTC {self.version} is too old: install {_oldest[0]}.{_oldest[1]} or newer, by `pip install "
                        "nvidia-cuda-nvrtc`, or `nvidia-cuda-nvrtc-cu12` for a driver of CUDA 12")

    def _call(self, name: str, *arguments: Any) -> None:
        status = getattr(self._functions, name)(*arguments)
        if status != 0:
            self._functions.nvrtcGetErrorString.restype = ctypes.c_char_p
            raise Error(f"NVRTC failed ({name}: {self._functions.nvrtcGetErrorString(status).decode()})")

    def _text(self, program: ctypes.c_void_p, what: str) -> bytes:
        """A result of a program by the name of its functions, as bytes."""
        size = ctypes.c_size_t()
        self._call(f"nvrtcGet{what}Size", program, ctypes.byref(size))
        text = ctypes.create_string_buffer(max(size.value, 1))
        self._call(f"nvrtcGet{what}", program, text)
        return text.raw

    def target(self, capability: int) -> tuple[str, str]:
        """What to compile for a GPU: an option, and whether the result is machine code or PTX, which the driver of a
        GPU that is newer than NVRTC compiles."""
        same = [a for a in self.architectures if a <= capability and a // 10 == capability // 10]
        if same:  # machine code is for all later GPUs of its generation
            return f"-arch=sm_{same[-1]}", "CUBIN"
        older = [a for a in self.architectures if a < capability]
        if not older:
            raise Error(f"NVRTC {self.version} compiles for GPUs of compute capability "
                        f"{_dotted(self.architectures[0])} and newer, and this one has {_dotted(capability)}: install "
                        "an older one, such as `pip install nvidia-cuda-nvrtc-cu12`")
        return f"-arch=compute_{older[-1]}", "PTX"

    def compile(self, source: str, capability: int, options: Sequence[str] = ()) -> tuple[bytes, str]:
        """A program for GPUs of that compute capability, and what NVRTC says. Raises `Error` with its first message
        if it refuses the source."""
        architecture, kind = self.target(capability)
        program = ctypes.c_void_p()
        texts = (ctypes.c_char_p * len(_standard))(*(text.encode() for text in _standard.values()))
        names = (ctypes.c_char_p * len(_standard))(*(name.encode() for name in _standard))
        self._call("nvrtcCreateProgram", ctypes.byref(program), source.encode(), b"model.cu", len(_standard), texts,
                   names)
        try:
            quotients = f"-prec-div={str(source.startswith(_exact_float)).lower()}"
            chosen = [option.encode() for option in [*_options, quotients, architecture, *options]]
            done = self._functions.nvrtcCompileProgram(program, len(chosen), (ctypes.c_char_p * len(chosen))(*chosen))
            said = self._text(program, "ProgramLog").rstrip(b"\0").decode(errors="replace")
            if done != 0:
                raise Error(f"the model does not compile (NVRTC {self.version}): {_core.first_error(said)}")
            return self._text(program, kind), said
        finally:
            self._call("nvrtcDestroyProgram", ctypes.byref(program))


def _dotted(capability: int) -> str:
    return f"{capability // 10}.{capability % 10}"


def placement(model_shared_bytes: int, limit: int) -> str:
    """The place of so many bytes of shared parameters on a GPU whose blocks have up to `limit` of shared memory."""
    if model_shared_bytes <= 1024:
        return "constant_bank"
    return "shared_memory" if model_shared_bytes <= limit else "cache"


def source_of(header: str, struct: str, method: str, real: str, place: str, generates: bool = False) -> str:
    """The file that is compiled: the model's header and the request for its kernel, and for one that sets the instances
    of studies if the model `generates` them."""
    exact = _exact_float if _exact_float in header else ""  # before the library's headers
    program = (f"{exact}#include <myriad/python/device_program.cuh>\n\n{header}\n"
               f"using myriad_method = {method};\nMYRIAD_DEVICE_PROGRAM({struct}, myriad_method, {real}, {place})\n")
    if generates:
        program += f"#include <myriad/python/device_generate.cuh>\nMYRIAD_DEVICE_GENERATE({struct}, {real})\n"
    return program


def _program(header: str, struct: str, method: str, real: str, shared: tuple[int, ...], device: int,
             generates: bool) -> tuple[str, int]:
    """The file that is compiled for a GPU by its number, and the compute capability of that."""
    _, capability, shared_bytes = _core.gpu(device)
    place = placement(shared[0] * (8 if real == "double" else 4) + shared[1] * 4, shared_bytes)
    return source_of(header, struct, method, real, place, generates), capability


_loaded: dict[Any, _core.Library] = {}
_single_kernels: dict[Any, _core.GpuKernel] = {}


def _cached(source: str, capability: int, load: Callable[[bytes], object]) -> compiled_files.Obtained:
    """Takes a program from the cache, or compiles it into the cache, and loads it: `load` gets its content."""
    path = _found()
    driver = _core.driver_version() // 1000
    if _major(path) > driver:
        raise Error(f"NVRTC of CUDA {_major(path)} compiles for newer drivers than this one, of CUDA {driver}: update "
                    f"the driver, or `pip install nvidia-cuda-nvrtc-cu{driver}`")
    facts = path.stat()  # which tell its version without loading it
    made_from = json.dumps([source, _core.version, _core.headers, _options[:-1], capability, path.name, facts.st_size,
                            facts.st_mtime_ns])

    def make(folder: str) -> None:
        pathlib.Path(folder, "model.so").write_bytes(library().compile(source, capability)[0])

    return compiled_files.obtain(made_from.encode(), make, lambda made: load(pathlib.Path(made).read_bytes()))


def kernel(header: str, struct: str, method: str, real: str, shared: tuple[int, ...], device: int,
           generates: bool = False, use: Callable[[_core.Library], None] | None = None) -> Kernel:
    """The kernel of a model, which is C++ source with a struct of that name, for a method and a real type, both as C++
    types, and a GPU by its number; `shared`: the numbers of real and integer shared parameters; `generates`: whether
    the model sets the instances of studies; `use` is called with a library that was loaded. Raises `Error` if there is
    no NVRTC, or with its first message if it refuses the model."""
    begin = time.perf_counter()
    source, capability = _program(header, struct, method, real, shared, device, generates)
    asked = (source, capability, os.environ.get("MYRIAD_NVRTC"))
    if asked in _loaded:
        return Kernel(_loaded[asked], "memory", time.perf_counter() - begin)
    with told(struct, seconds_to_compile(header, stages_of(method))):
        obtained = _cached(source, capability, lambda program: _core.Library(program, device))
    if use is not None:
        use(obtained.loaded)
    _loaded[asked] = obtained.loaded
    return kernel_of(obtained, "" if obtained.hit else f"NVRTC {library().version}", begin)


def prepare(header: str, struct: str, method: str, real: str, shared: tuple[int, ...], device: int,
            generates: bool = False) -> None:
    """Compiles the same kernel into the cache, and loads nothing: for processes that do not use the GPU themselves."""
    _cached(*_program(header, struct, method, real, shared, device, generates), lambda program: True)


def single_kernel(source: str, name: str, device: int) -> _core.GpuKernel:
    """Compiles a file for the GPU of that number, and returns its kernel of that name."""
    _, capability, _ = _core.gpu(device)
    asked = source, name, device, os.environ.get("MYRIAD_NVRTC")
    if asked not in _single_kernels:
        obtained = _cached(source, capability, lambda program: _core.GpuKernel(program, name, device))
        _single_kernels[asked] = obtained.loaded
    return _single_kernels[asked]


@functools.cache
def load_study_kernels(device: int) -> None:
    """Loads the kernels that set and reduce the instances of studies on a GPU by its number."""
    _, capability, _ = _core.gpu(device)
    _cached("#include <myriad/python/study_program.cuh>\n", capability,
            lambda program: _core.load_study_kernels(program, device))
