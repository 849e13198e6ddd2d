# SPDX-License-Identifier: MIT
"""Results of a run where they are, on a GPU."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import _core
from ..base.errors import Error, UnknownName
from ..sweeps.gpu_inputs import cuda

if TYPE_CHECKING:
    from ..symbolic.types import Component
    from .protocol import Results


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
        return cuda, self.device

    @property
    def __cuda_array_interface__(self) -> dict[str, Any]:
        strides = tuple(s * self.dtype.itemsize for s in self._strides)
        return {"shape": self.shape, "typestr": self.dtype.str, "data": (self.address, False), "version": 3,
                "strides": strides, "stream": None}

    def __len__(self) -> int:
        return self.shape[0]

    def __repr__(self) -> str:
        return f"<myriad_ode.DeviceArray of shape {self.shape}, {self.dtype}, on cuda:{self.device}>"


class DeviceResults:
    """The results of a run that are still on the GPU, by name, as the run itself has them on the host."""

    def __init__(self, run: Results) -> None:
        self._run = run

    def __getitem__(self, name: Component) -> DeviceArray:
        return self._named(self._run._find(name))

    def of_component(self, name: str) -> DeviceArray:
        """What a component stands for by itself, whatever else has its name."""
        return self._named(self._run._of_component(name) or name)

    def _named(self, found: str) -> DeviceArray:
        make = self._run._quantities[found].device
        if make is None:
            instead = ", or run.device[\"status_codes\"]" if found == "status" else ""
            raise UnknownName(f"there is no {found!r} on the GPU: ask run[{found!r}]{instead}")
        return _on_gpu(found, make)

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
