# SPDX-License-Identifier: MIT
"""The equations of coupled units as those of one unit, in C++: what teams of a GPU's threads integrate."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .cpp import Body, Names, _wrap
from .expression import Node, make, symbols_of
from .units import CouplingTable, of_units

if TYPE_CHECKING:
    from collections.abc import Iterable

    from .model import Model
    from .units import Units


# What a unit has by these names, beside those that begin like its own variables.
_members = {"unit", "publish", "publication", "n_publication", "n_unit_state", "couplings",
            "threads_per_instance"}


class _NotAlike(Exception):
    """The equations of two units differ in more than the numbers of the units."""


class UnitForm:
    """Equations that are alike, as those of one unit. Its symbols of components of units are ("of_unit", (kind, name,
    distance)), those of sums of a coupling ("sum", (table, what is summed, distance of the row))."""

    def __init__(self, model: Model, units: Units, names: list[str]) -> None:
        self.model, self.units, self.names = model, units, names
        self._shifted: dict[tuple[int, int], Node] = {}
        self._numbers = {str(i) for i in range(units.count)}
        of_kind = {"state": model.states, "parameter": model.parameters, "shared": model.scalar_shared}
        #: the kind of components that each unit has, by name without number
        self.groups = {base: kind for kind, several in of_kind.items() for base in of_units(several, units.count)}
        self.roots = [self._equation(name) for name in names]
        several = dict.fromkeys(s.value[1][:2] for s in symbols_of(self.roots) if s.value[0] == "sum")
        if {table for table, _ in several} != {t for t in model.tables if isinstance(t, CouplingTable)}:
            raise _NotAlike
        in_order = sorted(several, key=lambda one: model.tables.index(one[0]))
        #: the numbers of the couplings, as (table, what is summed), in the order of the tables' entries
        self.couplings = {one: i for i, one in enumerate(in_order)}
        self.published = {what: i for i, what in enumerate(dict.fromkeys(what for _, what in in_order))}

    def _equation(self, name: str) -> Node:
        equations = dict(zip(self.model.states, self.model.rhs))
        several = [self._shift(equations[f"{name}_{i}"], i) for i in range(self.units.count)]
        if any(one is not several[0] for one in several):
            raise _NotAlike
        return several[0]

    def _shift(self, root: Node, unit: int) -> Node:
        """An expression of a unit with distances to it in the place of numbers, the same node for units alike."""
        n = self.units.count
        waiting = [root]
        while waiting:
            node = waiting[-1]
            key = id(node), unit
            arguments = [] if node.op == "dot" else node.args
            missing = [a for a in arguments if (id(a), unit) not in self._shifted]
            if key in self._shifted or not missing:
                waiting.pop()
                if key not in self._shifted:
                    self._shifted[key] = self._one(node, unit, n)
            else:
                waiting += missing
        return self._shifted[id(root), unit]

    def _one(self, node: Node, unit: int, n: int) -> Node:
        if node.op == "dot":
            table, row = node.value
            if not isinstance(table, CouplingTable) or table.count != n:
                raise _NotAlike
            summed = {self._shift(a, j) for j, a in zip(table.columns(row), node.args)}
            what = summed.pop()
            if summed or any(s.value[0] == "of_unit" and s.value[1][2] != 0 or s.value[0] == "sum"
                             for s in symbols_of([what])):
                raise _NotAlike
            return make("symbol", value=("sum", (table, what, (row - unit) % n)))
        if node.op == "symbol":
            kind, name = node.value
            base, _, number = name.rpartition("_")
            if self.groups.get(base) == kind and number in self._numbers:
                return make("symbol", value=("of_unit", (kind, base, (int(number) - unit) % n)))
            return node
        return make(node.op, tuple(self._shifted[id(a), unit] for a in node.args), node.value,
                    node.type) if node.args else node

    # C++

    def source(self, struct: str) -> str:
        """The text of a model of that name."""
        model, n, names = self.model, self.units.count, Names(self.model, [*self.names, "unit"])
        out = ["// SPDX-License-Identifier: MIT", "// Written by Myriad's Python package from traced units.", "",
               f"struct {struct}_unit {{", f"    enum unit_state {{ {', '.join(self.names)}, n_unit_state }};"]
        if self.units.threads_per_instance is not None:
            out.append(f"    static constexpr int threads_per_instance = {self.units.threads_per_instance};")
        last = {f"{t.name}_last": f"{t.name}_last = {t.name} + {t.values.size - 1}" for t in model.tables}
        of_couplings = {name for table, _ in self.couplings for name in (table.name, f"{table.name}_last")}
        for kind, several in model.enumerations():
            own = [last.get(c, c) for c in several if c not in of_couplings]
            if own and kind != "state":
                out += ["    " + line for line in _wrap(f"enum {kind} {{ {', '.join(own)}, n_{kind} }};", 0)]
        if self.published:
            several = [f"published_{i}" for i in range(len(self.published))]
            out.append(f"    enum publication {{ {', '.join(several)}, n_publication }};")
            declared = f"static constexpr myriad::coupling couplings[] = {{{', '.join(self._couplings())}}};"
            out += ["    " + line for line in _wrap(declared, 0)]
            out += self._function("publish", "n_publication", self.published, names)
        out += self._function("rhs", "n_unit_state", self.roots, names)
        return "\n".join([*out, "};", f"using {struct} = myriad::coupled_units<{struct}_unit, {n}>;", ""])

    def _couplings(self) -> Iterable[str]:
        """The declarations of the couplings."""
        with_matrix: dict[CouplingTable, int] = {}
        for (table, what), number in self.couplings.items():
            form, arguments = "same", [f"published_{self.published[what]}"]
            if with_matrix.setdefault(table, number) != number:
                arguments.append(str(with_matrix[table]))
            else:
                form = table.form
                arguments += [] if table.bandwidth is None else [str(table.bandwidth)]
            yield f"myriad::{form}_coupling({', '.join(arguments)})"

    def _function(self, name: str, count: str, roots: Iterable[Node], names: Names) -> list[str]:
        roots, n, lines = list(roots), self.units.count, []
        symbols = symbols_of(roots)
        distances = sorted({s.value[1][2] for s in symbols if s.value[0] in ("of_unit", "sum")} - {0})
        lines += [f"const int unit_{d} = (unit + {d}) % {n};" for d in distances]
        number = {d: f"unit_{d}" if d else "unit" for d in [0, *distances]}

        def component(kind: str, base: str, unit: str) -> str:
            if kind == "state":
                return f"{names.y}[{base}]" if unit == "unit" else f"{names.y}.of({unit})[{base}]"
            member = names.p if kind == "parameter" else f"{names.p}.{kind}"
            return f"{member}[{base}_0 + {unit}]"

        def symbol(node: Node) -> str:
            kind, value = node.value
            if kind == "built-in":
                return names.t
            if kind == "of_unit":
                return component(value[0], value[1], number[value[2]])
            if kind == "sum":
                of_unit = names.y if value[2] == 0 else f"{names.y}.of({number[value[2]]})"
                return f"{of_unit}.coupled({self.couplings[value[:2]]})"
            return f"{names.p}[{value}]" if kind == "parameter" else f"{names.p}.{kind}[{value}]"

        body = Body(roots, names, symbol, scalar=False)
        values = [f"{names.R}({body.text(root)})" for root in roots]
        out = ["", f"template <class {names.R}>"]
        out += _wrap(f"MYRIAD_FUNCTION static myriad::vec<{names.R}, {count}> {name}([[maybe_unused]] int unit, "
                     f"[[maybe_unused]] auto {names.t}, [[maybe_unused]] const auto& {names.y}, "
                     f"[[maybe_unused]] const auto& {names.p}) {{", 0)
        for line in [*lines, *body.lines]:
            out += _wrap(line, 4)
        out += _wrap(f"return myriad::vec<{names.R}, {count}>{{{', '.join(values)}}};", 4)
        return ["    " + line if line else line for line in [*out, "}"]]


def unit_form(model: Model) -> UnitForm | None:
    """The model's equations as those of one unit; None if they are not alike, or are not all that the model has."""
    units = model.units_of_states
    if units is None or units.count < 2 or model.events or model.stops or model.observed or model.generate or \
            model.mass_matrix is not None or any(assignments for _, assignments in model._hooks):
        return None
    names = [name.rpartition("_")[0] for name in model.states[:len(model.states) // units.count]]
    if set(names) & set(model.component_names) or any(
            name in _members or name.startswith(("unit_", "published_")) for name in [
                *names, *model.component_names]):
        return None
    try:
        return UnitForm(model, units, names)
    except _NotAlike:
        return None
