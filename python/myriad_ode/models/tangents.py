# SPDX-License-Identifier: MIT
"""A model with solutions of its variational equations, by `myriad::with_tangents`."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..base.errors import Error, at, users_line
from ..symbolic.numbers import is_whole
from . import delays
from .extended import Extended
from .noise import refuse_derivatives
from .recorded import RecordedModel
from .triggers_as_events import with_events

if TYPE_CHECKING:
    from .any_model import AnyModel

__all__ = ["with_tangents"]


def with_tangents(model: AnyModel, vectors: int = 1, *, transient_phases: int = 0) -> WithTangents:
    """The model with tangent vectors: one gives the largest Lyapunov exponent, as many as there are states the full
    spectrum. They are orthonormalised at the end of every phase, and their growth is summed over the phases that follow
    the first `transient_phases`: `exponents(run)` has the result, and so have runs, studies, their datasets, tables and
    files, as "exponent_1_end", "exponent_2_end", ... Phases should be short enough
    (docs/writing_a_model.md). The number is a shared integer of the model, so that a sweep may set it anew, by its
    name."""
    return WithTangents(model, vectors, transient_phases)


class WithTangents(Extended):
    """A model with tangent vectors. Component c of tangent i is the state `<c>_tangent_<i>`, its exponent the accessory
    `exponent_<i>`, counted from 1, and the sum that this follows from the accessory `growth_<i>`, which results have
    only if it is named."""

    not_interpreted = "it has tangents"

    def __init__(self, model: AnyModel, vectors: int, transient_phases: int = 0) -> None:
        n = len(model.states)
        if not is_whole(vectors, 1, n):
            raise Error(f"{vectors!r} tangent vectors{at(users_line())}: a model of {n} states has from 1 to {n}")
        if not is_whole(transient_phases, 0, (1 << 31) - 1):
            raise Error(f"transient_phases is {transient_phases!r}{at(users_line())}: give the number of phases that "
                        "do not count, 0 or more")
        refuse_derivatives(model, "tangents")
        delays.refuse_derivatives(model, "tangents")
        if model.delays and vectors != 1:
            raise Error(f"{vectors} tangent vectors{at(users_line())}: a model with delays has one, for the largest "
                        "exponent; several would have to be orthogonal with their past")
        if model.mass_matrix is not None:
            raise Error(f"the model has a mass matrix{at(users_line())}, with which tangents of algebraic states would "
                        "not be independent: solve its algebraic equations in the others")
        if model.triggers:
            by_events = with_events(model) if isinstance(model, RecordedModel) else None
            if by_events is None:
                raise Error(f"the model has triggers{at(users_line())}, which tangents do not take where they wait or "
                            "have several comparisons: give events actions of their own")
            model = by_events
        self.vectors = int(vectors)
        numbers = range(1, self.vectors + 1)
        tangents = [f"{state}_tangent_{i}" for i in numbers for state in model.states]
        growth, exponents = [f"growth_{i}" for i in numbers], [f"exponent_{i}" for i in numbers]
        # The same orthonormal vectors for all instances, columns of a reflection that no symmetry leaves invariant.
        # With the rounding of the C++ library's `initial_tangents`.
        golden = 0.6180339887498949 * np.arange(1, n + 1)
        mirror = 1 + golden - np.floor(golden)
        mirror /= np.sqrt(sum(mirror * mirror))
        start = np.eye(n) - 2 * mirror[:, None] * mirror
        defaults = {"transient_phases": int(transient_phases), **dict(zip(tangents, start[:, :self.vectors].T.ravel()))}
        accessories = [*growth, "time_summed", "phase_began", *exponents]
        super().__init__(model, {"state": tangents, "shared_integer": ["transient_phases"], "accessory": accessories},
                         defaults, "tangents")
        self.hidden |= {*growth, "phase_began"}

    def source(self) -> tuple[str, str]:
        """The text that kernels are compiled from, and the name of its struct."""
        text, struct = self.model.source()
        return (f"{text}\n#include <myriad/tangent.hpp>\n"
                f"using {struct}_tangents = myriad::with_tangents<{struct}, {self.vectors}>;\n"), f"{struct}_tangents"

    def __repr__(self) -> str:
        return f"<{self.vectors} tangents of {self.model!r}>"
