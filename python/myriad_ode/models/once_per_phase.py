# SPDX-License-Identifier: MIT
"""What follows from constants alone, computed once per phase and not at every evaluation of the equations.

Models from files name each constant of a rate: `Vmax * S / Km`, `compartment * k1`, `pow(K, n)`. Such parts become
accessories that the start of a phase sets, and divisions by them are multiplications by the reciprocal. The model that
users see, in `cpp()` and in messages, has its formulas as they are.
"""

from __future__ import annotations

import copy
from typing import TYPE_CHECKING, Any

from ..symbolic import expression as ex, symbols as sym
from ..symbolic.operations import cost
from ..symbolic.functions import draws
from ..symbolic.node import real, walk
from ..symbolic.folding import constant, is_constant, value_of
from ..symbolic.rewrite import rebuilt, replaced
from .any_model import counts_of

if TYPE_CHECKING:
    from ..symbolic.expression import Expression
    from ..symbolic.node import Node
    from .recorded import RecordedModel


def prepared(model: Any) -> Any:
    """The model that is compiled or interpreted for one from a file; others, as users write them, stay as they are."""
    if not model.is_from_a_file:
        return model
    if "prepared" not in model._made:
        model._made["prepared"] = _prepared(model)
    return model._made["prepared"]


class _Parts:
    """The accessories of some expressions. `most`: how many there may be; those that save most are taken."""

    def __init__(self, model: RecordedModel, rhs: list[Expression], functions: list[Expression], most: int) -> None:
        self._assigned = {t for _, assignments in model._hooks for t, _ in assignments}
        self._fixed: dict[Node, bool] = {}
        self._functions = functions
        divided = rebuilt(rhs, self._by_reciprocal)
        order = walk([*divided, *functions])
        used = {a for node in order if not self._is_stored(node) for a in node.args} | {*divided, *functions}
        saved = {node: cost([node]) for node in order if node in used and self._is_stored(node)}
        taken = [*model.component_names, *model.outputs, *model.aliases]
        self._accessories: dict[Node, Node] = {}
        for node in sorted(saved, key=lambda one: -saved[one])[:most]:
            taken.append(sym.free_name(f"per_phase_{len(self._accessories) + 1}", taken))
            self._accessories[node] = sym.symbol("accessory", taken[-1])
        self.values = {accessory: node for node, accessory in self._accessories.items()}
        # Where there was no room for a reciprocal, the division stays.
        self._rhs = rebuilt(rhs, lambda node: self._by_reciprocal(node, self._accessories))

    def _is_fixed(self, node: Node) -> bool:
        """Whether an expression follows from constants that nothing changes."""
        if node not in self._fixed:
            for n in walk([node]):
                if n.op == "symbol":
                    self._fixed[n] = n.value[0] in ("parameter", "shared") and n not in self._assigned
                elif n not in self._fixed:
                    self._fixed[n] = n.op not in draws and all(self._fixed[a] for a in n.args)
        return self._fixed[node]

    def _by_reciprocal(self, node: Node, among: dict[Node, Node] | None = None) -> Node:
        """A division by what is fixed as a multiplication; by reciprocals among these alone, if they are given."""
        if node.op != "divide" or self._is_fixed(node.args[0]) or not self._is_fixed(node.args[1]):
            return node
        value, by = node.args
        if not is_constant(by):
            reciprocal = ex.make("divide", (constant(1.0), by))
            return ex.make("multiply", (value, reciprocal)) if among is None or reciprocal in among else node
        inverse = 1 / value_of(by) if value_of(by) else 0.0
        return ex.make("multiply", (value, constant(inverse))) if 1e-300 < abs(inverse) < 1e300 else node

    def _is_stored(self, node: Node) -> bool:
        """Whether an expression can be an accessory, and costs more than to read one."""
        return self._is_fixed(node) and node.type == real and bool(node.args) and not is_constant(node) and not (
            node.op == "negate" and not node.args[0].args) and any(n.op == "symbol" for n in walk([node]))

    def rhs(self) -> list[Expression]:
        """The equations, with the accessories."""
        return self._with_accessories(self._rhs)

    def functions(self) -> list[Expression]:
        """The other expressions."""
        return self._with_accessories(self._functions)

    def _with_accessories(self, roots: list[Expression]) -> list[Expression]:
        return replaced(roots, self._accessories)


# The most accessories of small models, of larger ones, and of those with stops or triggers: each is memory of every
# instance, which a step of a small model hardly needs otherwise.
most_accessories = (6, 128, 512)
_small = {"state": 8, "parameter": 16, "accessory": 6, "integer_accessory": 3, "event": 3}


def _room(model: RecordedModel) -> int:
    """How many accessories a model may have more."""
    counts = counts_of(model)
    few, many, most = most_accessories
    if counts["stop"] or counts["trigger"] or max(counts[kind] for kind in _small) > many:
        return max(0, most - counts["accessory"])
    return (few if all(counts[kind] <= limit for kind, limit in _small.items()) else many) - counts["accessory"]


def _prepared(model: RecordedModel) -> RecordedModel:
    parts = _Parts(model, list(model.rhs), [e.function for e in model.events], _room(model))
    made = model.changeable()
    made.rhs = parts.rhs()
    made.events = [copy.copy(e) for e in model.events]
    for one, function in zip(made.events, parts.functions()):
        one.function = function
    made.initialise = [*parts.values.items(), *model.initialise]
    made._accessory_targets = [*model._accessory_targets, *parts.values]
    made._collect([sym.symbol("state", name) for name in model.states])
    made.hidden = model.hidden | frozenset(a.value[1] for a in parts.values)
    return made
