# SPDX-License-Identifier: MIT
"""The kernel for a model, a method and a device."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ..base import component_kinds as kinds
from ..base.errors import Error
from ..models.any_model import AnyModel
from ..models.components import Components
from ..models.mass_matrix import check_method
from ..models.methods import method_type
from . import compiler, interpreter, nvrtc

if TYPE_CHECKING:
    from .compiler import Kernel


def kernel_for(device: str, model: AnyModel, components: Components, method: str, control: str | Sequence[str],
               sampled: bool, precision: str, interpreted: bool | None) -> tuple[Kernel, dict[str, list[str]]]:
    """The kernel of a model and a method for a device of the core, and the names of all components that it has."""
    check_method(model, method)
    if not device.startswith("cuda"):
        return choose_kernel(model, components, method, control, sampled, precision, interpreted)
    if interpreted:
        raise Error("a model is interpreted on the CPU alone: leave out interpreted=, or give device=\"cpu\"")
    names = components.names
    return nvrtc.kernel(*model.device_source(method, precision), method_type(method, control, sampled), precision,
                        tuple(len(names[kind]) for kind in kinds.shared), int(device.partition(":")[2]),
                        bool(components.generated),
                        lambda library: interpreter.give_model(library, model, components, method)), names


def choose_kernel(model: AnyModel, components: Components, method: str, control: str | Sequence[str], sampled: bool,
                  precision: str, interpreted: bool | None) -> tuple[Kernel, dict[str, list[str]]]:
    """The kernel for a model and a method, compiled or interpreted, and the names of all components that it has."""
    written = method_type(method, control, sampled)
    if interpreted or (interpreted is None and compiler.known_compiler() is None):
        why = "as asked" if interpreted else "as there is no C++ compiler"
        if precision != "double" or control:
            raise Error(f"a model is interpreted, {why}, in double precision and with the usual control alone: leave "
                        "out precision= and control=, or install a C++ compiler")
        return interpreter.kernel(model, components, method, why), components.names
    return compiler.kernel(*model.source(), written, precision, model.name), components.names
