# SPDX-License-Identifier: MIT
"""Batched functions in programs that XLA runs on a GPU: a handler of XLA's foreign-function interface, compiled when it
is first needed, hands over where its buffers are."""

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
_handler = r"""
using solver = int (*)(int64_t function, int64_t rows, int32_t device, void* stream, void* argument, void** results,
                       char* message, size_t most);
static solver solve_in_python = nullptr;

#define EXPORTED extern "C" __attribute__((visibility("default")))

EXPORTED void myriad_set_solver(solver s) { solve_in_python = s; }

EXPORTED XLA_FFI_Error* myriad_solve(XLA_FFI_CallFrame* frame) {
    for (auto* e = frame->extension_start; e != nullptr; e = e->next) {
        if (e->type != XLA_FFI_Extension_Metadata) continue;
        auto* const metadata = reinterpret_cast<XLA_FFI_Metadata_Extension*>(e)->metadata;
        metadata->api_version.major_version = XLA_FFI_API_MAJOR;
        metadata->api_version.minor_version = XLA_FFI_API_MINOR;
        metadata->traits = 0;
        return nullptr;
    }
    if (frame->stage != XLA_FFI_ExecutionStage_EXECUTE) return nullptr;
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

    constexpr int64_t most_results = 3;
    void* results[most_results] = {};
    for (int64_t r = 0; r < frame->rets.size && r < most_results; ++r)
        results[r] = static_cast<XLA_FFI_Buffer*>(frame->rets.rets[r])->data;
    const auto& argument = *static_cast<XLA_FFI_Buffer*>(frame->args.args[0]);
    const auto& function = *static_cast<XLA_FFI_Scalar*>(frame->attrs.attrs[0]);
    char message[2000] = "";
    if (solve_in_python(*static_cast<int64_t*>(function.value), argument.dims[1], device.device_ordinal, stream.stream,
                        argument.data, results, message, sizeof message) == 0)
        return nullptr;
    XLA_FFI_Error_Create_Args error{XLA_FFI_Error_Create_Args_STRUCT_SIZE, nullptr, message,
                                    XLA_FFI_Error_Code_INTERNAL};
    return api.XLA_FFI_Error_Create(&error);
}
"""

_target = "myriad_solve"
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


_registered: dict[str, Any] = {}


def register(platform: str) -> None:
    """Has XLA know the handler on a platform, "CUDA". Raises `Error` if there is no C++ compiler."""
    if platform in _registered:
        return
    import jax

    by = compiler.compiler()
    header = pathlib.Path(jax.ffi.include_dir(), "xla", "ffi", "api", "c_api.h").read_text()
    source = header + _handler
    # its headers are not prepared
    library = compiled_files.functions(by, source, lambda folder: by.compile(source, folder, compiler.most_seconds()))
    library.myriad_set_solver(_solve)
    jax.ffi.register_ffi_target(_target, jax.ffi.pycapsule(library.myriad_solve), platform=platform)
    _registered[platform] = library


def call(function: FunctionOfValues, with_jacobian: bool, rows: Any) -> Sequence[Any]:
    """The results for rows of values in a program of JAX: quantities [quantity, row] or [quantity, sample, row],
    derivatives [component of free=, quantity, ...] if they are wanted, and the statuses of the rows."""
    import jax

    count = rows.shape[0]
    inner = (len(function.of), *(() if function.n_samples is None else (function.n_samples,)), count)
    shapes = [jax.ShapeDtypeStruct(inner, rows.dtype), jax.ShapeDtypeStruct((len(function.free), *inner), rows.dtype)]
    return jax.ffi.ffi_call(_target, [*shapes[:1 + with_jacobian], jax.ShapeDtypeStruct((count,), np.uint8)])(
        rows.T, function=np.int64(solution(function, with_jacobian).number))
