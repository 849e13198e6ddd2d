# SPDX-License-Identifier: MIT
"""Models of Python's: recorded, and written as C++."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from ..models.event import Event, Stop
from ..models.methods import stiff
from ..models.recorded import RecordedModel
from ..models.trigger import Trigger
from ..symbolic import symbols as sym
from .cpp_writer import Writer
from .unit_writer import unit_form

if TYPE_CHECKING:
    import numpy.typing as npt

    from ..symbolic.types import ByComponent, Names

__all__ = ["model", "Model"]

# As most_states_of_one_thread in the C++ library.
_of_one_thread = {"double": 16, "float": 24}


def model(equations: ByComponent | Callable[..., Any] | str, *, events: Event | Sequence[Event] = (),
          stops: Stop | Sequence[Stop] = (), triggers: Trigger | Sequence[Trigger] = (),
          accessories: ByComponent | None = None, initialise: ByComponent | None = None,
          after_step: ByComponent | None = None, finalise: ByComponent | None = None,
          generate: ByComponent | None = None, states: Names | None = None, parameters: Names = (),
          shared: Names = (), mass_matrix: npt.ArrayLike | ByComponent | None = None,
          noise: ByComponent | None = None, history: ByComponent | None = None, tie_seed: int | None = None,
          name: str | None = None, exact_float: bool = False) -> Model:
    """Records a model.

    `equations` is a dictionary {state: its derivative}; or a function f(t, y, ...) that returns the derivatives, as for
    SciPy, with the names of its states in `states`, and the names of further arguments that all instances share in
    `shared`; or a string "x' = v; v' = -x" with all names in `parameters` and `shared`. In a dictionary keys and values
    may be strings or SymPy's symbols and expressions, named in the same way.

    `accessories` {a: value} are set to the value at the start of every phase, or get a summary over the phase, as in
    {peak: my.phase_maximum(x)}. `initialise`, `after_step` and `finalise` are assignments {target: value} at the
    start of a phase, after every step and at the end of a phase. Assignments of one hook, event, stop or trigger take
    effect together: every value is computed from what was there before.

    `generate` {target: value} sets states, parameters and accessories of the instances of a study, where they are
    integrated, after its axes: from the instance's number `my.instance`, from what axes and the study have set, and
    from random numbers, `my.uniform(low, high)` and `my.normal(mean, deviation)`, which depend on the study's
    seed and the instance's number alone. `solve` has no use for it.

    `mass_matrix` is the constant matrix M of M y' = f(t, y), of which the equations then are f: numbers by rows and
    columns in the order of the states, the numbers of a diagonal, or {state: factor of its derivative}, 1 if it is not
    named. It may be singular, so that equations are algebraic, if these determine their states (index one):
    `mass_matrix={c: 0}` makes 0 = f of the equation of c. For the method "rodas_5p" alone.

    `noise` makes the equations stochastic, dx = f dt + g dW: {state: g} gives each of these states a Wiener process of
    its own, {state: {W1: g1, W2: g2}} processes that states share, as from `my.wiener("W1 W2")` or by their names. The
    factors are expressions, as the equations are. For methods of their own with fixed steps, by default
    "euler_maruyama".

    `history` {state: expression of `my.time`, parameters and shared values} is what states were before the begin, where
    `my.delayed(x, lag)` reads them; a state that is not named had its initial value. It also is the initial value where
    no other is given.

    `tie_seed`, a whole number, puts actions of triggers that are due at one instant with the same priority into an
    order that is random from instance to instance, and follows from it: the same in every run and on every device.

    `exact_float` makes a GPU take CUDA's own functions and quotients in single precision, within an ulp or two, and not
    the faster ones, within 1e-6 (of sine and cosine absolutely); elsewhere it changes nothing.
    """
    return Model(equations, events, accessories, initialise, after_step, finalise, generate, states, parameters, shared,
                 name, stops, mass_matrix, triggers, tie_seed, exact_float, noise, history)


class Model(RecordedModel):
    """A recorded model. Names of components are in the order in which results and C++ enumerate them, elements of
    tables behind the other shared values; `shared_values` has what they are. `cpp()` is its header, `hash` identifies
    it."""

    def cpp(self, name: str | None = None) -> str:
        """The model as the text of a C++ header, `model.hpp`, which compiles as it is: `struct NAME { ... };`."""
        return Writer(self).header(self.name if name is None else sym.check_name(name, "a model"))

    def source(self) -> tuple[str, str]:
        """The text that kernels are compiled from, the same for equal models, and the name of its struct."""
        name = "traced_model"
        while name in self.component_names:
            name += "_"
        if "source" not in self._made:
            self._made["source"] = self.cpp(name)
        return self._made["source"], name

    def device_source(self, method: str, precision: str) -> tuple[str, str]:
        """The same for a GPU. Coupled units that are alike, with more states than the registers of a thread hold, are
        written as such there, for teams of threads."""
        text, name = self.source()
        threads = None if self.units_of_states is None else self.units_of_states.threads_per_instance
        if method in stiff or threads == 1 or threads is None and len(self.states) <= _of_one_thread[precision]:
            return text, name
        form = unit_form(self)
        return (text if form is None else "#define MYRIAD_EXACT_FLOAT\n" * self.exact_float + form.source(name)), name

    @property
    def hash(self) -> str:
        """A text that is equal for models with the same C++ code, whatever their names and their events' options."""
        return hashlib.sha256(self.cpp("model").encode()).hexdigest()
