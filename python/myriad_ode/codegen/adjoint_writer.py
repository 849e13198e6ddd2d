# SPDX-License-Identifier: MIT
"""The functions of a discrete adjoint in C++: transposed derivatives of a model's equations and actions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from ..base.errors import Error
from ..models.event import Event, Stop
from ..models.methods import method_type, stiff
from ..symbolic import symbols as sym
from ..symbolic.derivatives import directional, transposed
from ..symbolic.expression import constant, make
from .cpp_body import Names
from .cpp_writer import Writer
from .model import Model

if TYPE_CHECKING:
    from ..symbolic.node import Node

_cure = "leave out adjoint=True, for forward sensitivities"


def no_adjoint(why: str) -> Error:
    return Error(f"there is no adjoint, as {why}: {_cure}")


class _Writer(Writer):
    """Writes the functions that kernel/adjoint/transposed_step.hpp names. Weights of a product with a transposed
    derivative are v, the direction of a derivative along the state u, and along time tau."""

    def __init__(self, model: Model) -> None:
        names = Names(model)
        self.vectors = {what: names._free(what, f"{what}_") for what in ("v", "u", "tau")}
        names.taken |= set(self.vectors.values())
        super().__init__(model, names)

    def in_function(self, node: Node) -> str:
        kind, name = node.value
        if kind == "vector":
            what, number = name
            return self.vectors[what] + ("" if number is None else f"[{number}]")
        return super().in_function(node)

    def argument(self, what: str, count: str) -> str:
        """The text of an argument that is a vector, or a number if `count` is empty."""
        R = self.names.R
        return f"const {f'myriad::vec<{R}, {count}>' if count else R}& {self.vectors[what]}"


def _vector(what: str, count: int) -> list[Any]:
    return [make("symbol", value=("vector", (what, i))) for i in range(count)]


def adjoint_source(model: Model, wrt: Sequence[str], quantities: Sequence[Any], actions: Sequence[Any], method: str,
                   library: str) -> str:
    """The file that is compiled: the adjoint of quantities by the states and by parameters `wrt`, with the actions that
    change states, by a header of the package."""
    text, struct = model.source()
    states = [sym.symbol("state", name) for name in model.states]
    n, chosen, writer = len(states), len(wrt), _Writer(model)
    symbols = [*states, *(sym.symbol("parameter", name) for name in wrt)]
    v, u, tau = _vector("v", n), _vector("u", n), make("symbol", value=("vector", ("tau", None)))
    of_rhs = transposed(model.rhs, v, symbols)
    of_quantities = transposed(quantities, _vector("v", len(quantities)), symbols)
    if of_rhs is None or of_quantities is None:
        raise no_adjoint("the model looks up a table")
    count = f"n_state + {chosen}"
    functions = [
        writer.function("transposed_rhs", count, of_rhs, [writer.argument("v", "n_state")]),
        writer.function("quantities", len(quantities), quantities),
        writer.function("transposed_quantities", count, of_quantities, [writer.argument("v", str(len(quantities)))])]
    if method in stiff:
        moved = directional(model.rhs, [*states, sym.time], [*u, tau])
        of_slope = None if moved is None else transposed(moved, v, symbols)
        if of_slope is None:
            raise no_adjoint("the equations have no second derivatives")
        functions.append(writer.function("transposed_slope", count, of_slope, [
            writer.argument("u", "n_state"), writer.argument("tau", ""), writer.argument("v", "n_state")]))
    for number, one in enumerate(actions):
        functions += _action(one, writer, number, states, v, [*symbols, sym.time], count)
    switches = model.switches
    between = model.accessories.index(switches.switches[0].between.value[1]) if switches.switches else -1
    are_events = ", ".join("true" if isinstance(one, Event) else "false" for one in actions)
    body = "\n\n".join("\n".join(f"    {line}" for line in function) for function in functions)
    return (f"#include <myriad/python/{library}>\n\n{text}\nstruct {struct}_adjoint : {struct} {{\n"
            f"    static constexpr int n_wrt = {chosen}, n_quantity = {len(quantities)}, "
            f"n_action = {len(actions)}, between_jumps = {between};\n"
            f"    static constexpr bool is_event[] = {{{are_events or 'false'}}};\n\n{body}\n}};\n"
            f"using myriad_method = {method_type(method)};\n"
            f"MYRIAD_ADJOINT({struct}_adjoint, myriad_method)\n")


def _action(one: Event | Stop, writer: _Writer, number: int, states: list[Any], v: list[Any], symbols: list[Any],
            count: str) -> list[list[str]]:
    """The functions of an action."""
    new = {target.value[1]: value for target, value in one.do}
    after = [new.get(s.value[1], s) for s in states]
    this = f"myriad::detail::constant_index<{number}>"
    of_state = transposed(after, v, symbols)
    of_event = transposed([one.function], [constant(1.0)], symbols) if isinstance(one, Event) else []
    if of_state is None or of_event is None:
        raise no_adjoint(f"'{one.name}' looks up a table")
    made = [writer.function("act", "n_state", after, [this]),
            writer.function("transposed_act", f"{count} + 1", of_state, [writer.argument("v", "n_state"), this])]
    return [*made, writer.function("slope_of_event", f"{count} + 1", of_event, [this])] if of_event else made
