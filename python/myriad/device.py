# SPDX-License-Identifier: MIT
"""Arrays on GPUs: other libraries' arrays as values of a sweep, and results where they are."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core
from .components import name_of
from .errors import Error
from .kinds import of_instances
from .symbols import time

if TYPE_CHECKING:
    from .hints import Component
    from .run import Run

_cuda = 2  # the kind of device in DLPack


def is_on_gpu(value: Any) -> bool:
    """Whether an array of another library, such as CuPy, PyTorch or JAX, is on an NVIDIA GPU."""
    if isinstance(value, (np.ndarray, int, float, list, tuple)):
        return False
    if hasattr(value, "__dlpack_device__"):
        return value.__dlpack_device__()[0] == _cuda
    return hasattr(value, "__cuda_array_interface__")


class DeviceInput:
    """One value per instance in the memory of a GPU, as `solve` takes it."""

    ndim = 1

    def __init__(self, array: Any, name: str) -> None:
        self._array = array  # kept, and with it the memory
        interface = getattr(array, "__cuda_array_interface__", None)
        if interface is not None:
            dimensions, type_of = len(interface["shape"]), interface["typestr"]
            if dimensions != 1:
                raise Error(f"'{name}' has {dimensions} dimensions on the GPU: give one number per instance, in one")
            self.address, self._length = interface["data"][0], interface["shape"][0]
            kind, size = type_of[1], int(type_of[2:])
            strides = interface.get("strides")
            step = strides[0] if strides else size
        else:
            try:
                self.address, self._length, step, kind, bits, _ = _core.facts_of_device_array(array)
            except Error as error:
                raise Error(f"'{name}': {error}: give one number per instance, in one dimension") from None
            size = bits // 8
        if kind != "f" or size not in (4, 8):
            raise Error(f"'{name}' on the GPU is no array of float64 or float32: convert it there")
        self.dtype = np.dtype(f"f{size}")
        if step != size and self._length > 1:
            raise Error(f"'{name}' on the GPU has its values {step} bytes apart: make it contiguous there")

    def __len__(self) -> int:
        return self._length


class DeviceArray:
    """An array of results in the memory of a GPU. torch, CuPy, JAX and others take it without a copy, by DLPack or
    `__cuda_array_interface__`: `torch.from_dlpack(a)`, `cupy.asarray(a)`, `jax.dlpack.from_dlpack(a)`. It is there as
    long as one of these uses it."""

    def __init__(self, capsule: Any, make: Callable[[], Any]) -> None:
        self._make = make  # another capsule, as each is for one use
        self.address, self.shape, dtype, self.device, self._strides = _core.facts_of_own_array(capsule)
        self.dtype = np.dtype(dtype)

    def __dlpack__(self, **_: object) -> object:
        return self._make()

    def __dlpack_device__(self) -> tuple[int, int]:
        return _cuda, self.device

    @property
    def __cuda_array_interface__(self) -> dict[str, Any]:
        strides = tuple(s * self.dtype.itemsize for s in self._strides)
        return {"shape": self.shape, "typestr": self.dtype.str, "data": (self.address, False), "version": 3,
                "strides": strides, "stream": None}

    def __len__(self) -> int:
        return self.shape[0]

    def __repr__(self) -> str:
        return f"<myriad.DeviceArray of shape {self.shape}, {self.dtype}, on cuda:{self.device}>"


class DeviceResults:
    """The results of a run that are still on the GPU, by name, as the run itself has them on the host."""

    def __init__(self, run: Run) -> None:
        self._run = run

    def __getitem__(self, name: Component) -> DeviceArray:
        run = self._run
        name = name if name is time else name_of(name)
        kind, number = run._components.place.get(name, (name, 0))
        if name in run._sampled:
            return self.samples(name)
        elif name in run._recorded:
            make = functools.partial(run._records.records, *run._recorded[name], on_device=True)
        elif kind in (*of_instances, "t", "status", "phases_done"):
            make = functools.partial(run._ensemble.device_array, kind, number)
        else:
            raise KeyError(f"there is no {name!r} on the GPU: ask run[{name!r}]")
        return _on_gpu(name, make)

    def samples(self, name: str | None) -> DeviceArray:
        """The samples of a state, or their times."""
        number = -1 if name is None else self._run._sampled[name]
        return _on_gpu(name or "time", functools.partial(self._run._ensemble.samples, number, on_device=True))

    def has_samples(self) -> bool:
        """Whether samples are there, and were not copied to the host in parts."""
        return self._run._ensemble.samples(-1, on_device=True) is not None


def _on_gpu(name: str, make: Callable[[], Any]) -> DeviceArray:
    capsule = make()
    if capsule is None:
        raise Error(f"{name!r} is not on a GPU: the run was on the CPU, or in parts, as its results would have "
                    "taken much of the GPU's memory; run[...] has them on the host")
    return DeviceArray(capsule, make)
