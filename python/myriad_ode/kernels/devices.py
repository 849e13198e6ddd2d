# SPDX-License-Identifier: MIT
"""The names of devices."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from .. import _core
from ..base.errors import Error
from . import nvrtc


def _device_name(device: str, interpreted: bool | None) -> tuple[str, str | None]:
    """The name of a device as the core knows it, and why "auto" takes no GPU where there is one."""
    device = str(device)
    # first, as the driver finds no GPU in a fork
    forked = ((device == "auto" or device.startswith("cuda")) and _core.driver_version() > 0
              and not _core.may_use_gpus())
    if device == "auto":
        if forked:
            return "cpu", "a GPU was not looked for, as this process was forked from one that has done so"
        if interpreted or _core.no_gpu():
            return "cpu", None
        if nvrtc.find() is None:
            return "cpu", "the GPU was not used, as there is no NVRTC: `pip install nvidia-cuda-nvrtc`"
        return "cuda:0", None
    if forked:
        raise Error(f"device {device!r} is not available, as this process was forked from one that has looked for "
                    "GPUs: fork before that, start processes by \"spawn\", or use \"cpu\"")
    return _core.check_device(device), None


def device_names(device: str | Sequence[str], interpreted: bool | None) -> tuple[list[str], str | None]:
    """The names of one device or of several, each once, as the core knows them, and why "auto" takes no GPU."""
    named: Sequence[Any] = device if isinstance(device, (list, tuple)) else [device]
    for one in named:
        if not isinstance(one, str):
            raise Error(f"device {one!r} is unknown: use \"auto\", \"cpu\", \"cuda\", \"cuda:1\" for the second GPU, "
                        "or a list of such names")
    found = [_device_name(d, interpreted) for d in named]
    if not found:
        raise Error("device= names no device: leave it out, or give \"cpu\"")
    return list(dict.fromkeys(name for name, _ in found)), next((why for _, why in found if why), None)
