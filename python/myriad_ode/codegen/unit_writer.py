# SPDX-License-Identifier: MIT
"""A model of coupled units as that of one unit, in C++: what teams of a GPU's threads integrate."""

from __future__ import annotations

import copy
from typing import TYPE_CHECKING

from ..base.component_kinds import accessories
from ..models.delays import Delay
from ..symbolic.node import Node, symbols_of
from .cpp_body import Body, Names, branches, wrap
from .cpp_writer import Writer
from .units_alike import NotAlike, UnitsAlike

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from ..models.recorded import RecordedModel
    from ..models.units import CouplingTable
    from ..symbolic.types import Assignments


# What a unit has by these names, beside those that begin like its own variables.
_members = {"unit", "publish", "publication", "n_publication", "couplings", "diffusion", "observe", "events",
            "summaries", "threads_per_instance", "wanted", "delayed_unit"}


class UnitWriter(Writer):
    """Writes units that are alike, as one of them."""

    def __init__(self, alike: UnitsAlike) -> None:
        self.alike, self._in_generate = alike, False
        super().__init__(alike.model, Names(alike.model, [*alike.groups, *alike.delayed_of_unit.values(), "unit"]))

    def source(self, struct: str) -> str:
        """The text of a model of that name."""
        model, n = self.model, self.alike.units.count
        lines = [f"static constexpr bool {name} = true;" for name in (
            "accessories_are_outputs", "writes_parameters", "writes_time_domain") if getattr(model, name)]
        if model.noise is not None and model.noise.is_additive:
            lines.append("static constexpr bool additive_noise = true;")
        if self.alike.units.threads_per_instance is not None:
            lines.append(f"static constexpr int threads_per_instance = {self.alike.units.threads_per_instance};")
        lines += self._enumerations()
        if self.alike.couplings:
            lines.append(f"static constexpr myriad::coupling couplings[] = {{{', '.join(self._couplings())}}};")
        if self.alike.summaries:
            lines.append("static constexpr myriad::summary summaries[] = {" + ", ".join(
                f"{{{quantity}, myriad::over_phase::{kind}, {accessory}}}"
                for quantity, kind, accessory in self.alike.summaries) + "};")
        published = list(self.alike.published)
        blocks = [self._function("publish", "n_publication", published)] if published else []
        blocks.append(self._function("rhs", "n_unit_state", self.alike.roots))
        for name, count, roots in (("diffusion", "n_unit_state", self.alike.factors),
                                   ("events", "n_unit_event", self.alike.event_functions),
                                   ("observe", "n_unit_observed", self.alike.quantities)):
            blocks += [self._function(name, count, roots)] if roots else []
        blocks += [*self._past_functions(), *self._hook_functions()]
        out = ["// SPDX-License-Identifier: MIT", "// Written by Myriad's Python package from traced units.", "",
               f"struct {struct}_unit {{", *("    " + line for one in lines for line in wrap(one, 0))]
        for block in blocks:
            out += ["", *("    " + line if line else line for line in block)]
        return "\n".join([*out, "};", f"using {struct} = myriad::coupled_units<{struct}_unit, {n}>;", ""])

    def _enumerations(self) -> Iterable[str]:
        """The components of the unit and of the system."""
        model = self.model
        last = {f"{t.name}_last": f"{t.name}_last = {t.name} + {t.values.size - 1}" for t in model.tables}
        of_couplings = {name for table, _ in self.alike.couplings for name in (table.name, f"{table.name}_last")}
        for kind in ("state", "accessory", "integer_accessory", "event_count", "observed", "delayed"):
            if several := self.alike.of_unit[kind]:
                short = kind.removesuffix("_count")
                yield f"enum unit_{short} {{ {', '.join(several)}, n_unit_{short} }};"
        for kind, several in model.enumerations():
            if kind in ("accessory", "integer_accessory"):
                several = [name for name in several if self.alike.number(kind, name) is None]
            own = [last.get(c, c) for c in several if c not in of_couplings]
            if own and kind not in ("state", "event", "observed", "delayed"):
                yield f"enum {kind} {{ {', '.join(own)}, n_{kind} }};"
        if self.alike.published:
            yield f"enum publication {{ {', '.join(f'published_{i}' for i in self.alike.published.values())}, " \
                  "n_publication };"

    def _couplings(self) -> Iterable[str]:
        """The declarations of the couplings."""
        with_matrix: dict[CouplingTable, int] = {}
        for (table, what), number in self.alike.couplings.items():
            form, arguments = "same", [f"published_{self.alike.published[what]}"]
            if with_matrix.setdefault(table, number) != number:
                arguments.append(str(with_matrix[table]))
            else:
                form = table.form
                arguments += [] if table.bandwidth is None else [str(table.bandwidth)]
            yield f"myriad::{form}_coupling({', '.join(arguments)})"

    def other_units(self, nodes: Iterable[Node]) -> list[str]:
        """The numbers of the other units that are named."""
        distances = sorted({s.value[1][2] for s in symbols_of(nodes) if s.value[0] in ("of_unit", "sum")} - {0})
        return [f"const int unit_{d} = (unit + {d}) % {self.alike.units.count};" for d in distances]

    @staticmethod
    def _of(distance: int) -> tuple[str, str]:
        """What stands for a unit at that distance: as an index, and behind what belongs to the unit itself."""
        return (f"unit_{distance}", f".of(unit_{distance})") if distance else ("unit", "")

    def in_function(self, node: Node) -> str:
        names, (kind, value) = self.names, node.value
        if kind == "sum":
            return f"{names.y}{self._of(value[2])[1]}.coupled({self.alike.couplings[value[:2]]})"
        if kind != "of_unit":
            if self.alike.number(kind, value) is not None and kind in accessories:  # in stop_time
                of_kind = self.model.accessories if kind == "accessory" else self.model.integer_accessories
                return f"{names.p}.{kind}[{list(of_kind).index(value)}]"
            return super().in_function(node)
        kind, base, distance = value
        index, of = self._of(distance)
        if kind == "state":
            return f"{names.y}{of}[{base}]"
        if kind in ("parameter", "shared"):
            return f"{names.p if kind == 'parameter' else names.p + '.shared'}[{base}_0 + {index}]"
        return f"{names.p}{of}.unit_{kind}[{base}]"

    def in_hook(self, node: Node) -> str:
        lane, (kind, value) = self.names.lane, node.value
        if kind == "of_unit":
            kind, base, distance = value
            index, of = self._of(distance)
        else:
            unit = self.alike.number(kind, value) if isinstance(value, str) else None
            if unit is None:
                return super().in_hook(node)
            base, index, of = value.rpartition("_")[0], str(unit), f".of({unit})"
            if self._in_generate and kind == "state":
                return f"{lane}.y[{list(self.model.states).index(value)}]"
            if self._in_generate and kind not in ("parameter", "shared"):
                of_kind = self.model.accessories if kind == "accessory" else self.model.integer_accessories
                return f"{lane}.{kind}[{list(of_kind).index(value)}]"
        if kind in ("parameter", "shared"):
            return f"{lane}.{kind}[{base}_0 + {index}]"
        member = {"state": "y", "event_count": "event_count"}.get(kind, f"unit_{kind}")
        return f"{lane}{of}.{member}[{base}]"

    def _function(self, name: str, count: str, roots: Sequence[Node]) -> list[str]:
        names = self.names
        body = Body(roots, names, self.in_function, scalar=False)
        values = [f"{names.R}({body.text(root)})" for root in roots]
        out = [f"template <class {names.R}>"]
        out += wrap(f"MYRIAD_FUNCTION static myriad::vec<{names.R}, {count}> {name}([[maybe_unused]] int unit, "
                     f"[[maybe_unused]] auto {names.t}, [[maybe_unused]] const auto& {names.y}, "
                     f"[[maybe_unused]] const auto& {names.p}) {{", 0)
        for line in [*self.other_units(roots), *body.lines]:
            out += wrap(line, 4)
        return [*out, *wrap(f"return myriad::vec<{names.R}, {count}>{{{', '.join(values)}}};", 4), "}"]

    def _past_functions(self) -> Iterable[list[str]]:
        """The functions of delayed values, if there are any."""
        if not self.alike.delayed_of_unit:
            return
        n, number = self.alike.units.count, self.names.number
        delays = [Delay(name, None, past.state.value[1][1], past.lag, True, past.is_slope)
                  for past, name in self.alike.delayed_of_unit.items()]
        of_system = not any(s.value[0] == "of_unit" for s in symbols_of([one.lag for one in delays]))
        yield from self.past_of(delays, self.alike.before, "u", "p" if of_system else "up")
        distances = [(name, past.state.value[1][2]) for past, name in self.alike.delayed_of_unit.items()]
        if any(distance for _, distance in distances):
            lines = self.by_delay([(name, [f"return (unit + {distance}) % {n};" if distance else "return unit;"])
                                   for name, distance in distances])
            yield ["/// The unit whose state it is of.",
                   f"MYRIAD_FUNCTION static int delayed_unit(int unit, [[maybe_unused]] int {number}) {{",
                   *self.block(lines), "}"]

    def real_text(self, body: Body, root: Node) -> str:
        return f"{self.names.R}({body.text(root)})"

    def _hook_functions(self) -> Iterable[list[str]]:
        """The hooks that there are."""
        lane, model = f"auto& {self.names.lane}", self.model
        for name, (system, own) in self.alike.hooks.items():
            if system or own:
                yield self._hook(name, f"[[maybe_unused]] int unit, {lane}", self._statements_of_each(system, own))
        if any(self.alike.at_events):
            several = zip(self.alike.of_unit["event_count"], self.alike.at_events)
            acting = [(name, self._statements_of_event(do)) for name, do in several if do]
            lines = branches("event", acting, len(self.alike.at_events))
            yield self._hook("after_event", f"[[maybe_unused]] int unit, [[maybe_unused]] int event, {lane}", lines)
        if model.stops:
            yield self.stop_time()
        if any(system or own for system, own in self.alike.at_stops):
            acting = [(str(stop.name), self._statements_of_each(system, own))
                      for stop, (system, own) in zip(model.stops, self.alike.at_stops) if system or own]
            lines = branches("stop", acting, len(model.stops))
            which = "int stop" if len(model.stops) > 1 else "int"
            number = self.number_of([("", lines)])
            yield self._hook("after_stop", f"[[maybe_unused]] int unit, {which}, {number}, {lane}", lines)
        if model.generate:
            writer = copy.copy(self)
            writer.names, writer._in_generate = self.names.in_generate(), True
            yield writer.hook("generate", model.generate)

    def _hook(self, name: str, arguments: str, lines: list[str]) -> list[str]:
        """A hook that returns an action if one of its statements does."""
        ends = any("return" in line for line in lines)
        last = ["    return myriad::action::proceed;"] if ends and not lines[-1].startswith("return") else []
        return [f"MYRIAD_FUNCTION static {'myriad::action' if ends else 'void'} {name}({arguments}) {{",
                *self.block(lines), *last, "}"]

    def _statements_of_event(self, do: Assignments) -> list[str]:
        return [*self.other_units([node for pair in do for node in pair]), *self.done(do)]

    def _statements_of_each(self, system: Assignments, own: Assignments) -> list[str]:
        """The statements of a hook that is called for one unit after the other. What belongs to the system is done in
        the first call, before anything is assigned to units."""
        lines: list[str] = []
        result = []
        if system:
            statements, conditions = self.statements(system, scalar=True)
            wanted = [f"if ({conditions[action]}) wanted = myriad::action::{action};"
                      for action in ("end_phase", "end_instance") if action in conditions]
            if wanted:
                lines.append("myriad::action wanted = myriad::action::proceed;")
                result = ["return wanted;"]
            lines += ["if (unit == 0) {", *("    " + line for line in [*statements, *wanted]), "}"]
        if own:
            statements, _ = self.statements(own, scalar=True)
            lines += [*self.other_units([value for _, value in own]), *statements]
        return [*lines, *result]

    def title(self, target: Node) -> str:
        return target.value[1][1] if target.value[0] == "of_unit" else super().title(target)


def unit_form(model: RecordedModel) -> UnitWriter | None:
    """The model as that of one unit; None if its units are not alike, or have what units do not."""
    units = model.units_of_states
    if units is None or units.count < 2 or model.triggers or model.queue:
        return None
    if model.mass_matrix is not None or model.noise is not None and model.noise.processes:
        return None
    try:
        alike = UnitsAlike(model, units)
    except NotAlike:
        return None
    own = {base for several in alike.of_unit.values() for base in several}
    if own & set(model.component_names) or any(
            name in _members or name.startswith(("unit_", "n_unit_", "published_")) for name in [
                *own, *model.component_names]):
        return None
    return UnitWriter(alike)
