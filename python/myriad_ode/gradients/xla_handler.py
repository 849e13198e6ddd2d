# SPDX-License-Identifier: MIT
"""Batched functions in programs of XLA's: handlers of its foreign-function interface, compiled when they are first
needed, hand over where its buffers are. That of CPUs calls the core, that of a GPU Python."""

from __future__ import annotations

import ctypes
import functools
import itertools
import math
import pathlib
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import _core
from ..base.errors import Error
from ..kernels import compiled_files, compiler

if TYPE_CHECKING:
    from .protocol import FunctionOfValues

# Behind the text of XLA's header c_api.h, which is C, has no other headers of XLA's, and takes no time to compile.
_handlers = r"""
#define EXPORTED extern "C" __attribute__((visibility("default")))

constexpr int64_t most_results = 3;
struct of_frame {
    explicit of_frame(XLA_FFI_CallFrame* f) : frame(f) {
        for (int64_t r = 0; r < f->rets.size && r < most_results; ++r)
            results[r] = static_cast<XLA_FFI_Buffer*>(f->rets.rets[r])->data;
    }
    const XLA_FFI_Buffer& argument() const { return *static_cast<XLA_FFI_Buffer*>(frame->args.args[0]); }
    int64_t function() const {
        return *static_cast<int64_t*>(static_cast<XLA_FFI_Scalar*>(frame->attrs.attrs[0])->value);
    }
    XLA_FFI_Error* error() const {
        XLA_FFI_Error_Create_Args all{XLA_FFI_Error_Create_Args_STRUCT_SIZE, nullptr, message,
                                      XLA_FFI_Error_Code_INTERNAL};
        return frame->api->XLA_FFI_Error_Create(&all);
    }

    XLA_FFI_CallFrame* frame;
    void* results[most_results] = {};
    char message[2000] = "";
};

// Whether the frame asks for something else than a call.
static bool is_other(XLA_FFI_CallFrame* frame) {
    for (auto* e = frame->extension_start; e != nullptr; e = e->next) {
        if (e->type != XLA_FFI_Extension_Metadata) continue;
        auto* const metadata = reinterpret_cast<XLA_FFI_Metadata_Extension*>(e)->metadata;
        metadata->api_version.major_version = XLA_FFI_API_MAJOR;
        metadata->api_version.minor_version = XLA_FFI_API_MINOR;
        metadata->traits = 0;
        return true;
    }
    return frame->stage != XLA_FFI_ExecutionStage_EXECUTE;
}

using core_call = int (*)(int64_t function, int single, int64_t rows, void* argument, void* const* results,
                          char* message, size_t most);
static core_call call_core = nullptr;

EXPORTED void myriad_set_core(core_call c) { call_core = c; }

EXPORTED XLA_FFI_Error* myriad_on_cpu(XLA_FFI_CallFrame* frame) {
    if (is_other(frame)) return nullptr;
    of_frame of(frame);
    const bool single = of.argument().dtype == XLA_FFI_DataType_F32;
    return call_core(of.function(), single, of.argument().dims[0], of.argument().data, of.results, of.message,
                     sizeof of.message) == 0 ? nullptr : of.error();
}

using solver = int (*)(int64_t function, int64_t rows, int32_t device, void* stream, void* argument, void** results,
                       char* message, size_t most);
static solver solve_in_python = nullptr;

EXPORTED void myriad_set_solver(solver s) { solve_in_python = s; }

EXPORTED XLA_FFI_Error* myriad_on_gpu(XLA_FFI_CallFrame* frame) {
    if (is_other(frame)) return nullptr;
    const XLA_FFI_Api& api = *frame->api;
    const auto forget = [&](XLA_FFI_Error* error) {
        XLA_FFI_Error_Destroy_Args all{XLA_FFI_Error_Destroy_Args_STRUCT_SIZE, nullptr, error};
        if (error != nullptr) api.XLA_FFI_Error_Destroy(&all);
    };
    // A CPU has neither: that is an error, and the values stay as they are.
    XLA_FFI_Stream_Get_Args stream{XLA_FFI_Stream_Get_Args_STRUCT_SIZE, nullptr, frame->ctx, nullptr};
    forget(api.XLA_FFI_Stream_Get(&stream));
    XLA_FFI_DeviceOrdinal_Get_Args device{XLA_FFI_DeviceOrdinal_Get_Args_STRUCT_SIZE, nullptr, frame->ctx, 0};
    forget(api.XLA_FFI_DeviceOrdinal_Get(&device));
    of_frame of(frame);
    return solve_in_python(of.function(), of.argument().dims[1], device.device_ordinal, stream.stream,
                           of.argument().data, of.results, of.message, sizeof of.message) == 0 ? nullptr : of.error();
}
"""

_on_cpu, _on_gpu = "myriad_on_cpu", "myriad_on_gpu"
_solver = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_int64, ctypes.c_int64, ctypes.c_int32, ctypes.c_void_p,
                           ctypes.c_void_p, ctypes.POINTER(ctypes.c_void_p), ctypes.c_void_p, ctypes.c_size_t)

# Programs of XLA's name a function by its number, and do not tell when they are gone: functions are kept for good.
_functions: dict[int, Solution] = {}
_numbers = itertools.count()


@_solver
def _solve(number: int, rows: int, device: int, stream: int | None, argument: int, results: Any, message: int,
           most: int) -> int:
    """What the handler calls, in any thread. Returns 0, or 1 with a message."""
    try:
        _functions[number](rows, device, stream or 0, argument, results)
        return 0
    except BaseException as error:  # which no caller but XLA could take
        said = (str(error) or type(error).__name__).encode()[:most - 1] + b"\0"
        ctypes.memmove(message, said, len(said))
        return 1


class Solution:
    """A batched function, or one with its derivatives, as the handler calls it."""

    def __init__(self, function: FunctionOfValues, with_jacobian: bool) -> None:
        self._function = function
        of = [str(one) for one in function.of]
        #: what each result has, one array of the run after another
        self.results = [of, *([[f"{one}_by_{k}" for k in function.free for one in of]] if with_jacobian else []),
                        ["status_codes"]]
        self._with_jacobian = with_jacobian
        self.number = next(_numbers)
        _functions[self.number] = self

    def __call__(self, rows: int, device: int, stream: int, argument: int, results: Any) -> None:
        """Integrates for values at an address on the GPU, [component of free=, row], and copies the results."""
        function = self._function
        if device != function.gpu:
            raise Error(f"the argument is on the GPU with number {device}, and the function integrates on "
                        f"cuda:{function.gpu}: give device=\"cuda:{device}\" to my.batched")
        apart = rows * function.real.itemsize
        run = function.run_columns([_Column(argument + i * apart, rows, function.real)
                                    for i in range(len(function.free))], self._with_jacobian)
        samples = () if function.n_samples is None else (function.n_samples,)
        copies: list[tuple[int, int, int]] = []
        for names, to in zip(self.results, results):
            for name in names:
                array = run.device[name] if name == "status_codes" else run.device.of_component(name)
                size = array.dtype.itemsize * math.prod(array.shape)
                expected = (rows,) if name == "status_codes" else (rows, *samples)
                if array.shape != expected:
                    raise Error(f"'{name}' has the shape {array.shape} on the GPU, and {expected} is expected")
                if copies and (copies[-1][0] + copies[-1][2], copies[-1][1] + copies[-1][2]) == (to, array.address):
                    copies[-1] = (*copies[-1][:2], copies[-1][2] + size)
                else:
                    copies.append((to, array.address, size))
                to += size
        _core.copy_on_gpu(device, stream, copies)  # and waits, as the run's memory is used again


class _Column:
    """One value per row in the memory of a GPU, as `solve` takes it."""

    def __init__(self, address: int, rows: int, dtype: np.dtype[Any]) -> None:
        self.__cuda_array_interface__ = {"shape": (rows,), "typestr": dtype.str, "data": (address, True), "version": 3}


@functools.cache
def solution(function: FunctionOfValues, with_jacobian: bool) -> Solution:
    """The only one of a function."""
    return Solution(function, with_jacobian)


@functools.cache
def _library() -> Any:
    """The handlers. Raises `Error` if there is no C++ compiler."""
    import jax

    by = compiler.compiler()
    header = pathlib.Path(jax.ffi.include_dir(), "xla", "ffi", "api", "c_api.h").read_text()
    source = header + _handlers
    # its headers are not prepared
    library = compiled_files.functions(by, source, lambda folder: by.compile(source, folder, compiler.most_seconds()))
    library.myriad_set_core(ctypes.c_void_p(_core.repeated_call))
    library.myriad_set_solver(_solve)
    return library


@functools.cache
def _register(target: str, platform: str) -> None:
    """Has XLA know a handler on a platform, as "CUDA" or "cpu"."""
    import jax

    jax.ffi.register_ffi_target(target, jax.ffi.pycapsule(getattr(_library(), target)), platform=platform)


@functools.cache
def is_there() -> bool:
    """Whether there are handlers: not without a C++ compiler, or with a JAX whose header is none that they know."""
    if compiler.known_compiler() is None:
        return False
    try:
        _library()
    except (Error, OSError, AttributeError):
        return False
    return True


@functools.cache
def _kept(function: FunctionOfValues, with_jacobian: bool) -> int:
    """The number by which the core has a function for good."""
    number: int = function.repeated(with_jacobian).keep()
    return number


def call_on_cpu(function: FunctionOfValues, with_jacobian: bool, rows: Any) -> list[Any]:
    """The results for rows of values in a program of JAX's on a CPU, [row, ...], and their derivatives if they are
    wanted; NaN of rows that have failed."""
    import jax

    _register(_on_cpu, "cpu")
    shapes = [jax.ShapeDtypeStruct((rows.shape[0], *function.shape, *by), rows.dtype)
              for by in ((), (len(function.free),))[:1 + with_jacobian]]
    return list(jax.ffi.ffi_call(_on_cpu, shapes)(rows, function=np.int64(_kept(function, with_jacobian))))


def call_on_gpu(function: FunctionOfValues, with_jacobian: bool, rows: Any, platform: str) -> Sequence[Any]:
    """The results for rows of values in a program of JAX's on a GPU: quantities [quantity, row] or [quantity, sample,
    row], derivatives [component of free=, quantity, ...] if they are wanted, and the statuses of the rows."""
    import jax

    _register(_on_gpu, "CUDA" if platform == "cuda" else platform)
    count = rows.shape[0]
    inner = (len(function.of), *(() if function.n_samples is None else (function.n_samples,)), count)
    shapes = [jax.ShapeDtypeStruct(inner, rows.dtype), jax.ShapeDtypeStruct((len(function.free), *inner), rows.dtype)]
    return jax.ffi.ffi_call(_on_gpu, [*shapes[:1 + with_jacobian], jax.ShapeDtypeStruct((count,), np.uint8)])(
        rows.T, function=np.int64(solution(function, with_jacobian).number))
