# SPDX-License-Identifier: MIT
"""Models from files of CellML, the format of cell physiology."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ...base.errors import users_line
from ...codegen.model import Model
from ...models.components import Components, name_of
from ...symbolic import symbols as sym
from ...symbolic.folding import constant
from ...symbolic.node import Node
from ..deep_stack import deeply
from .equations import Equations, usable
from .library import Analysed
from .units import text

if TYPE_CHECKING:
    from ...symbolic.types import Names, Path

__all__ = ["read_cellml", "CellmlModel"]


def read_cellml(source: Path | str, *, parameters: Names | None = None, name: str | None = None) -> CellmlModel:
    """The model of a file of CellML (1.0, 1.1 and 2.0), given by its path or as text. It needs the package libcellml.

    Variables with a derivative are states, constants are parameters with the file's values, and what is computed is an
    output of a run by its name; the variable of integration is time. A variable keeps its name, with that of its
    component before it where several have it, as in `sodium_m_gate_alpha`; `component.variable` names it too. Connected
    variables are one, in the units in which the file computes it or gives its value; units that differ are converted.

    `parameters` names the constants that sweeps may set; the others are written into the equations. Without it sweeps
    may set all.

    Files that it imports are looked for beside the file and in folders below, and nothing else is opened.

    Raises `my.Error` with component, variable and line for what is not supported: resets, reactions of CellML 1.0,
    variables that an equation has to be solved for, derivatives by something else than time or of a higher order, and
    for what is not valid.
    """
    swept = None
    if parameters is not None:
        swept = [name_of(n) for n in ([parameters] if isinstance(parameters, Node) else sym.names(parameters))]
    return deeply(lambda: CellmlModel(Equations(Analysed(source), swept), name))


class CellmlModel(Model):
    """A model from a file of CellML. `outputs` are expressions by name that a run computes from states and parameters;
    `defaults` are the values of the file by component, `aliases` the names of components by `component.variable`;
    `units` has the file's units by component or output, as texts, and `time_unit` that of time."""

    is_from_a_file = True

    def __init__(self, found: Equations, name: str | None) -> None:
        names = found.names
        equations: dict[Any, Any] = {found.value(key): found.slope(key) for key in found.states}
        if not equations:
            equations = {sym.symbol("state", sym.free_name("nothing", names.values())): constant(0.0)}
        starts = {names[key]: found.start(key) for key in found.states}
        parameters = {key: found.value(key) for key in found.constants}
        declared = [symbol for symbol in parameters.values() if symbol.op == "symbol"]
        called = sym.free_name(usable(name or found.analysed.name or "model"), names.values())
        self._reserved = {*names.values()}
        super().__init__(equations, (), None, None, None, None, None, None, declared, (), called)
        self.line, self.hidden = users_line(), frozenset([*self.accessories, *self.integer_accessories])
        self.defaults: dict[str, Any] = {**self.shared_values, **dict.fromkeys(self.states, constant(0.0)), **starts}
        self.defaults |= {names[key]: found.start(key) for key, symbol in parameters.items() if symbol.op == "symbol"}
        self.outputs: dict[str, Any] = {names[key]: found.value(key) for key in found.computed}
        self.outputs |= {names[key]: value for key, value in parameters.items() if value.op != "symbol"}
        self.units = {name: unit for key, name in names.items()
                      if (unit := text(found.variables[key].variable().units()))}
        self.time_unit = "" if found.time is None else text(found.model.voi().variable().units())
        self.aliases = found.aliases()

    def start(self, given: dict[str, Any] | None = None) -> dict[str, float]:
        """The values of states and parameters at the start, for some that are given."""
        values = Components(self).completed(dict(given or {}), 0.0)
        return {n: float(v) for n, v in values.items()}
