# SPDX-License-Identifier: MIT
"""A recorded model as the header that a C++ user would write: enumerations, rhs, events and hooks."""

from __future__ import annotations

import re
from collections.abc import Sequence

from .._core import factor_entries
from ..models.mass_matrix import left_sides, mass_entries
from ..models.noise import equation_texts
from ..symbolic.operations import cost
from .cpp_body import wrap
from .cpp_hooks import HookWriter
from .jacobian import is_autonomous, jacobian_of


class Writer(HookWriter):
    """Writes one model."""

    def header(self, name: str) -> str:
        model = self.model
        out = ["// SPDX-License-Identifier: MIT", "// Written by Myriad's Python package from a traced model.",
               "#pragma once", "", *["#define MYRIAD_EXACT_FLOAT", ""] * model.exact_float,
               *["#include <myriad/action_queue.hpp>"] * bool(model.queue),
               "#include <myriad/model.hpp>", ""]
        macros = [n for n in model.component_names if re.search("[A-Z]{2}", n)]  # maybe, in headers of C
        out += [f"#undef {name}" for name in macros] + [""] * bool(macros)
        out += [f"/// {line}" for line in self.description()]
        out += [f"struct {name} {{"]
        out += ["    " + d for d in self.declarations()]
        last_elements = {f"{t.name}_last": f"{t.name}_last = {t.name} + {t.values.size - 1}" for t in model.tables}
        for kind, names in model.enumerations():
            if names:
                written = ", ".join(last_elements.get(n, n) if kind == "shared" else n for n in names)
                out += ["    " + line for line in wrap(f"enum {kind} {{ {written}, n_{kind} }};", 0)]
        if model.queue:
            out += ["    " + line for line in wrap(self.queue_type(model.queue), 0)]
        if model.summaries:
            out.append("    static constexpr myriad::summary summaries[] = {")
            out += [f"        {{{r.observed}, myriad::over_phase::{r.kind}, {r.accessory}}}," for r in model.summaries]
            out.append("    };")
        pattern, jacobian = self.jacobian()
        out += ["    " + line for line in pattern]
        if model.mass_matrix is not None:
            mass = f"static constexpr myriad::mass_entry mass_matrix[] = {{{mass_entries(model)}}};"
            out += ["    " + line for line in wrap(mass, 0)]
        blocks = [self.function("rhs", "n_state", model.rhs)] + jacobian
        if model.noise is not None:
            blocks.append(self.function("diffusion", "n_state", model.noise.factors,
                                        row="n_noise" if model.noise.processes else ""))
        if model.events:
            blocks.append(self.function("events", "n_event", [e.function for e in model.events]))
        if model.observed:
            blocks.append(self.function("observe", "n_observed", [q for _, q in model.observed]))
        if model.delays:
            blocks += self.past()
        if model.initialise:
            blocks.append(self.hook("initialise", model.initialise))
        if model.after_step:
            blocks.append(self.after_step())
        blocks += self.actions()
        if model.finalise:
            blocks.append(self.hook("finalise", model.finalise))
        if model.generate:
            blocks.append(Writer(model, self.names.in_generate()).hook("generate", model.generate))
        for block in blocks:
            out += [""] + ["    " + line if line else line for line in block]
        return "\n".join(out + ["};", ""])

    def description(self) -> list[str]:
        lines = equation_texts(self.model, left_sides(self.model), self.model.rhs)
        return lines if len(lines) <= 8 else lines[:7] + [f"... and {len(lines) - 7} more equations"]

    def declarations(self) -> list[str]:
        model = self.model
        declared = [name for name in ("accessories_are_outputs", "writes_parameters", "writes_time_domain")
                    if getattr(model, name)]
        declared += ["additive_noise"] * (model.noise is not None and model.noise.is_additive)
        # From which the library sees whether a kernel is to have one copy of rhs; in C++ it has to count.
        weight = [f"static constexpr int rhs_weight = {cost(model.rhs)};"]
        return [f"static constexpr bool {name} = true;" for name in declared] + weight

    def jacobian(self) -> tuple[list[str], list[list[str]]]:
        """What stiff methods need of a large model: the pattern of its Jacobian, whether it depends on time, as lines,
        and the derivatives, in a list of one function or none."""
        model = self.model
        entries, values = jacobian_of(model)
        if not entries:
            return [], []
        lines = [f"// {self.matrix(entries)}"]
        if is_autonomous(model):
            lines.append("static constexpr bool autonomous = true;")
        written = ", ".join(f"{{{model.states[row]}, {model.states[column]}}}" for row, column in entries)
        lines += wrap(f"static constexpr myriad::jacobian_entry jacobian_pattern[] = {{{written}}};", 0)
        return lines, [self.function("jacobian", len(entries), values)] if values else []

    def matrix(self, entries: Sequence[tuple[int, int]]) -> str:
        """What stiff methods make of the entries of the Jacobian."""
        n, mass = len(self.model.states), self.model.mass_matrix
        every, diagonal = list(entries), set(range(n))
        if mass is not None:
            every += [(int(i), int(j)) for i, j in zip(*mass.nonzero())]
            diagonal = {i for i, j in every if i == j}
        factors = factor_entries(n, every) if len(diagonal) == n else -1
        made = f"the factors of stiff methods have {factors}" if factors >= 0 else "stiff methods factorise all of it"
        return f"{len(entries)} of {n * n} entries of the Jacobian may differ from zero; {made}"
