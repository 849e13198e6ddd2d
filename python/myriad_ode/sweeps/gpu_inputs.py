# SPDX-License-Identifier: MIT
"""Other libraries' arrays on GPUs as values of a sweep."""

from __future__ import annotations

from typing import Any

import numpy as np

from .. import _core
from ..base.errors import Error

cuda = 2  # the kind of device in DLPack


def is_on_gpu(value: Any) -> bool:
    """Whether an array of another library, such as CuPy, PyTorch or JAX, is on an NVIDIA GPU."""
    if isinstance(value, (np.ndarray, int, float, list, tuple)):
        return False
    if hasattr(value, "__dlpack_device__"):
        return value.__dlpack_device__()[0] == cuda
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
