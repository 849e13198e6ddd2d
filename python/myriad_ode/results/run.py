# SPDX-License-Identifier: MIT
"""The outcome of `solve`: arrays by name, statuses, the report, and the way to xarray and pandas."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal, NoReturn

import numpy as np

from .. import _core
from ..base import component_kinds as kinds
from ..base.core_words import in_words
from ..base.errors import Error
from ..base.statuses import first_failure, status_names
from ..models.components import name_of
from ..sweeps.gpu_inputs import DeviceInput
from ..sweeps.sweep import Sweep
from ..symbolic.evaluate import evaluate
from ..symbolic.expression import symbols_of
from ..symbolic.symbols import time
from .gpu_results import DeviceResults
from .run_plots import Plots, html
from .sensitivities import Sensitivities

if TYPE_CHECKING:
    import pandas
    import xarray

    from ..models.components import Components
    from ..symbolic.expression import Node
    from ..symbolic.types import Array, Component

# What datasets and tables call what they have besides components, whose names there get a _ behind.
_own_names = ("instance", "phase", "sample", "time", "t_last", "status")


class Interrupted(KeyboardInterrupt):
    """Ctrl-C ended a call. Of `solve` and of studies `run` has the instances that were done, and the others as
    not_started, or as interrupted if they were under way and took more than half a second longer. Of `fit` `fit` has
    the best values so far, and `run` is None."""

    def __init__(self, run: Any, fit: Any = None) -> None:
        super().__init__(f"{run.done} of {run.size} instances were done; .run has them" if fit is None else
                         f"the least loss so far is {fit.loss[fit.index]:.6g}; .fit has its values")
        self.run = run
        self.fit = fit


class Report:
    """How the instances ended, the work, where it was done, and where the kernel came from."""

    def __init__(self, report: Any, kernel: Any, seconds: float, notes: Sequence[str] = ()) -> None:
        self._report = report
        self.notes = [*map(in_words, report.notes), *notes]  #: what else to know
        #: "compiled by g++", "cache" (on disk), "memory" (of this process), or "interpreted" and why;
        #: with a note if the cache cannot be used
        self.kernel = kernel.origin
        self.compile_seconds = kernel.seconds  #: that it took to get the kernel, compiled or from the cache
        self.total_seconds = seconds  #: of the whole call

    def __getattr__(self, name: str) -> Any:
        if name == "_report":  # of one that was made without __init__, as by `copy`
            raise AttributeError(name)
        return getattr(self._report, name)

    def __reduce__(self) -> NoReturn:
        raise Error("a report cannot be pickled or copied: keep str(report), or the numbers that you need")

    @property
    def by_status(self) -> dict[str, int]:
        """Number of instances by the name of their status, those that occur."""
        return {name: count for name, count in zip(status_names, self._report.by_status) if count}

    def __str__(self) -> str:
        text = "\n".join([str(self._report).rstrip("\n"), *(f"note: {note}" for note in self.notes)])
        origin = f"from {self.kernel}" if self.kernel in ("cache", "memory") else self.kernel
        if not self.kernel.startswith("interpreted"):
            origin += f" in {self.compile_seconds:.3g} s"
        return f"{text}\nkernel {origin}; {self.total_seconds:.3g} s in all"

    __repr__ = __str__


class Run(Mapping):
    """The results of one call of `solve`, a mapping from names to arrays. `run["x"]` has one row per instance: for a
    sampled state one column per sample, for a recorded component one column per phase, and for others the value at the
    end, or the value of an input. Its length is the number of names; `size` is the number of instances.
    Arrays are views of the core's memory, not copies. Results of a GPU are copied to the host when they are
    first asked for."""

    def __init__(self, components: Components, ensemble: Any, report: Any, kernel: Any, sweep: Any,
                 inputs: dict[str, Any], recorded: dict[str, tuple[str, int]], sampled: dict[str, int], seconds: float,
                 from_phase: int, notes: Sequence[str] = ()) -> None:
        self._components, self._ensemble, self._records = components, ensemble, report
        self._recorded, self._sampled, self._inputs = recorded, sampled, inputs
        self.sweep = sweep if isinstance(sweep, Sweep) else None
        self.report = Report(report, kernel, seconds, notes)
        self.from_phase = from_phase  #: number of the first recorded phase
        self.units = components.units  #: of components and outputs, where the model knows them
        self.time_unit = components.time_unit  #: empty where it is not known

    @property
    def size(self) -> int:
        """The number of instances."""
        return self.report.instances

    @property
    def shape(self) -> tuple[int, ...]:
        """The lengths of the sweep's axes; a sweep without axes has its size alone."""
        return tuple(self.sweep.shape) if self.sweep is not None else (self.size,)

    @property
    def status(self) -> Array:
        """How each instance ended, as numbers into `my.status_names`."""
        return self._ensemble.array("status")

    @property
    def done(self) -> int:
        """The number of instances that were integrated: all, unless the call was interrupted."""
        by_status = self._records.by_status
        return self.size - by_status[status_names.index("not_started")] - by_status[status_names.index("interrupted")]

    @property
    def failed(self) -> Array:
        """True for each instance that ended with a failure."""
        return self.status >= first_failure

    @property
    def t(self) -> Array:
        """The time at which the last phase of each instance ended."""
        return self._ensemble.array("t")

    @property
    def phases_done(self) -> Array:
        """The number of phases that each instance has done."""
        return self._ensemble.array("phases_done")

    @property
    def stored_samples(self) -> Array:
        """The number of samples of each instance."""
        self._require_samples()
        return self._ensemble.stored_samples()

    @property
    def sample_times(self) -> Array:
        """The times of the samples, one row per instance; NaN beyond those stored."""
        self._require_samples()
        return self._ensemble.samples(-1)

    def _require_samples(self) -> None:
        if not self._sampled:
            raise Error("no samples were taken: give samples= to solve")

    def steps(self, kind: Literal["accepted", "rejected", "located", "evaluations"] = "accepted") -> Array:
        """Steps of each instance: "accepted", "rejected" or "located" (redone to locate events); or "evaluations" of
        the right-hand side."""
        names = {"accepted": "accepted_steps", "rejected": "rejected_steps", "located": "located_steps",
                 "evaluations": "rhs_evaluations"}
        if kind not in names:
            raise Error(f"there are no {kind!r} steps: choose one of {', '.join(names)}")
        return self._ensemble.array(names[kind])

    def _last_values(self, some_kinds: Iterable[str]) -> dict[str, Array]:
        """The components of some kinds by name."""
        return {name: self._ensemble.array(kind, c)
                for kind in some_kinds for c, name in enumerate(self._components.names[kind])
                if name not in self._components.hidden}

    @property
    def states(self) -> dict[str, Array]:
        """The states at the end by name."""
        return self._last_values(["state"])

    @property
    def accessories(self) -> dict[str, Array]:
        """The accessories at the end by name, integer ones too."""
        return self._last_values(kinds.accessories)

    @property
    def parameters(self) -> dict[str, Array]:
        """The parameters by name, one value per instance."""
        return self._last_values(["parameter"])

    @property
    def shared(self) -> dict[str, Any]:
        """The shared values by name, without the tables'."""
        return {name: value for kind in kinds.shared
                for name, value in zip(self._components.names[kind], self._ensemble.array(kind))
                if name not in self._components.tables}

    @property
    def start(self) -> dict[str, Any]:
        """The initial states by name, as they were given; arrays on a GPU as objects that are there."""
        return {name: self._inputs[name] if isinstance(self._inputs[name], DeviceInput) else
                np.asarray(self._inputs[name]) for name in self._components.states}

    @property
    def records(self) -> dict[str, Array]:
        """What was recorded at the end of each phase, by name: one row per instance, one column per phase; NaN (0 of
        integers) after an instance has ended."""
        return {name: self._records.records(kind, c) for name, (kind, c) in self._recorded.items()}

    @property
    def samples(self) -> dict[str, Array]:
        """The sampled states by name: one row per instance, one column per sample."""
        return {name: self._ensemble.samples(c) for name, c in self._sampled.items()}

    @property
    def sensitivity(self) -> Sensitivities:
        """Derivatives of the results, if `sensitivities=` was given: `run.sensitivity[x, k]` has the shape of
        `run[x]`, `run.sensitivity[x]` one more axis behind it, for all components that they are by."""
        if not self._components.derivatives_by:
            raise Error("the run has no sensitivities: give sensitivities= to solve, as in sensitivities=[k, x]")
        return Sensitivities(self, self._components.derivatives_by)

    @property
    def device(self) -> DeviceResults:
        """Results where a GPU has them, by name: `run.device["x"]` is an array as `run["x"]`, that torch, CuPy and JAX
        take without a copy."""
        return DeviceResults(self)

    def __getitem__(self, name: Component) -> Array:
        if name is time:
            return self._times()
        name = name_of(name)
        if name in self._sampled:
            return self._ensemble.samples(self._sampled[name])
        if name in self._recorded:
            return self._records.records(*self._recorded[name])
        place = self._components.place.get(name, (None,))
        if place[0] in kinds.of_instances:  # and of a GPU's results no others
            return self._ensemble.array(*place)
        if name in self.shared:
            return self.shared[name]
        if name in self._components.aliases:
            return self[self._components.aliases[name]]
        if name in self._components.outputs:
            return self._output(self._components.outputs[name])
        raise KeyError(f"there is no {name!r}: the model has {', '.join(self._names())}")

    def _times(self) -> Array:
        """The recorded times, or the times of the samples."""
        for place in self._recorded.values():
            if place == ("time", 0):
                return self._records.records(*place)
        if self._sampled:
            return self.sample_times
        raise KeyError("the times were not recorded: give record=dict(..., time=True) or samples= to solve")

    def _place_of(self, expression: Node) -> str | None:
        """Where the values of an expression are known: along "sample" or "phase", or None for the end alone."""
        symbols = symbols_of([expression])
        states = [s.value[1] for s in symbols if s.value[0] == "state"]
        of_time = any(s is time for s in symbols)
        if not states and not of_time:
            return None
        if self._sampled and all(n in self._sampled for n in states):
            return "sample"
        has_times = any(kind == "time" for kind, _ in self._recorded.values())
        if self._recorded and all(n in self._recorded for n in states) and (has_times or not of_time):
            return "phase"
        return None

    def _output(self, expression: Node) -> Array:
        """The values of an expression: at the samples, or where records are, or at the end."""
        return self._output_at(self._place_of(expression), expression)

    def _output_at(self, place: str | None, expression: Node) -> Array:
        """The values of an expression at a place that `_place_of` has told."""
        times: Any
        if place == "sample":
            times, states = self.sample_times, self.samples
            shape = times.shape
        elif place == "phase":
            times = next((self._records.records(*p) for p in self._recorded.values() if p == ("time", 0)), None)
            states = self.records
            shape = next(iter(states.values())).shape
        else:
            times, states, shape = self.t, self.states, (self.size,)
        known: dict[Any, Any] = {}
        for symbol in symbols_of([expression]):
            kind, name = symbol.value
            if symbol in self._components.constants:
                known[symbol] = self._components.constants[symbol]
            elif symbol is time:
                known[symbol] = times
            elif kind == "state":
                known[symbol] = states[name]
            elif kind == "parameter":
                known[symbol] = self.parameters[name][:, None] if place else self.parameters[name]
            else:
                known[symbol] = self.shared[name]
        result, = evaluate([expression], known)
        return np.array(np.broadcast_to(result, shape))

    def _names(self) -> list[str]:
        """The names of all components that have results, and of recorded times."""
        without = {*self._components.tables, *self._components.hidden}
        return list(dict.fromkeys([*(n for n in self._components.place if n not in without), *self._recorded,
                                   *self._components.outputs]))

    def __iter__(self) -> Iterator[str]:
        return iter(self._names())

    def __len__(self) -> int:
        return len(self._names())

    def __contains__(self, name: object) -> bool:
        try:
            self[name]
        except (KeyError, Error):
            return False
        return True

    def _ipython_key_completions_(self) -> list[str]:
        return self._names()

    # two runs are equal if they are the same, as their arrays have no single truth value
    __eq__, __hash__ = object.__eq__, object.__hash__

    def __reduce__(self) -> NoReturn:
        raise Error("the results of a run cannot be pickled or copied: pickle run.to_xarray(), or the arrays that you "
                    "need")

    @staticmethod
    def _free(name: str, taken: Container[str]) -> str:
        while name in taken:
            name += "_"
        return name

    def _column(self, name: str) -> str:
        """The name of a component's result in a dataset or table, which have names of their own."""
        return self._free(f"{name}_", self._components.place) if name in _own_names else name

    def _in_dataset(self, name: str) -> str:
        """The name of an input in a dataset, where a state's own name stands for its result."""
        if name in self._components.states:
            return self._free(f"{name}_start", self._components.place)
        return self._column(name) if name in self._components.place else name

    def _axes(self) -> tuple[list[str], tuple[int, ...]]:
        """The dimensions of the instances and their lengths."""
        if self.sweep is None or not self.sweep.axes:
            return ["instance"], (self.size,)
        return [self._in_dataset(name) for name, _ in self.sweep.axes], tuple(self.sweep.shape)

    def to_xarray(self) -> xarray.Dataset:
        """The results as an `xarray.Dataset`: records along `phase`, samples along `sample`, and along `instance`, or
        the axes of a grid, whose values are coordinates, as are parameters. A component with a name that the dataset
        has for something else, such as `phase`, has a _ behind it."""
        try:
            import xarray
        except ImportError:
            raise Error("to_xarray needs the package xarray: `pip install xarray`") from None
        dims, lengths = self._axes()

        units = self._components.units

        def unstacked(array: Array, *more: str, of: str | None = None
                      ) -> tuple[tuple[str, ...], Array, dict[str, str]]:
            return (*dims, *more), array.reshape(*lengths, *array.shape[1:]), (
                {"units": units[of]} if of is not None and of in units else {})

        variables: dict[str, Any] = {}
        coordinates: dict[str, Any] = {}
        for name, array in self.records.items():
            variables[self._column(name)] = unstacked(array, "phase", of=name)
        for name, array in self.samples.items():
            other = self._free(f"{name}_samples", self._components.place)
            variables[other if name in self._recorded else self._column(name)] = unstacked(array, "sample", of=name)
        if self._sampled:
            dimensions, times = unstacked(self.sample_times, "sample")[:2]
            coordinates["time"] = dimensions, times, (
                {"units": self._components.time_unit} if self._components.time_unit else {})
        for name, array in {**self.states, **self.accessories}.items():
            variables.setdefault(self._column(name), unstacked(array, of=name))
        for name, expression in self._components.outputs.items():
            place = self._place_of(expression)
            variables.setdefault(self._column(name), unstacked(self[name], *([place] if place else []), of=name))
        variables["t_last"] = (*unstacked(self.t)[:2], {"long_name": "time at which the last phase ended"})
        variables["status"] = (*unstacked(self.status)[:2], {
            "flag_values": np.arange(len(status_names), dtype=np.uint8), "flag_meanings": " ".join(status_names)})
        if self._recorded:
            phases = next(iter(self.records.values())).shape[1]
            coordinates["phase"] = np.arange(self.from_phase, self.from_phase + phases)
        along = {} if self.sweep is None else self.sweep.coordinates
        for name, (axis, values) in along.items():
            coordinates[self._in_dataset(name)] = (self._in_dataset(axis), np.asarray(values),
                                                   {"units": units[name]} if name in units else {})
        for name, array in self.parameters.items():
            if name not in along:
                coordinates[self._column(name)] = unstacked(array, of=name)
        coordinates.update((self._column(name), value) for name, value in self.shared.items())
        for name, value in self.start.items():
            if name not in along and not isinstance(value, DeviceInput) and np.ndim(value) == 1:
                coordinates[self._in_dataset(name)] = unstacked(value, of=name)
        return xarray.Dataset(variables, coordinates, {"myriad_version": _core.version})

    def to_pandas(self) -> pandas.DataFrame:
        """The results as a `pandas.DataFrame`: one row for each instance and recorded phase, or each instance and
        sample, or each instance, with the parameters as columns. A component with the name of another
        column, such as `phase`, has a _ behind it."""
        try:
            import pandas
        except ImportError:
            raise Error("to_pandas needs the package pandas: `pip install pandas`") from None
        if self._recorded and self._sampled:
            raise Error("records by phase and samples do not fit into one table: use to_xarray()")
        long = dict(self.records) or dict(self.samples)
        columns = next(iter(long.values())).shape[1] if long else 1
        table = {"instance": np.repeat(np.arange(self.size), columns)}
        if self._recorded:
            table["phase"] = np.tile(np.arange(self.from_phase, self.from_phase + columns), self.size)
        if self._sampled:
            table["time"] = self.sample_times.ravel()
        for name, array in self.parameters.items():
            table[self._column(name)] = np.repeat(array, columns)
        table.update((self._column(name), array.ravel()) for name, array in long.items())
        for name, array in {**self.states, **self.accessories}.items():
            if not long:
                table[self._column(name)] = array
        for name in self._components.outputs:
            array = self[name]
            if array.ndim == 2 or not long:
                table[self._column(name)] = array.ravel()
        names = pandas.Categorical.from_codes(self.status, status_names)
        table["status"] = names.repeat(columns)
        frame = pandas.DataFrame(table)
        return frame.dropna(subset=["time"]).reset_index(drop=True) if self._sampled else frame

    @property
    def plot(self) -> Plots:
        """Pictures by matplotlib: `bifurcation`, `map`, `time_series`, `phase_portrait` and `statuses`."""
        return Plots(self)

    def _repr_html_(self) -> str:
        return html(self)

    def __repr__(self) -> str:
        counts = ", ".join(f"{count} {name}" for name, count in self.report.by_status.items())
        return f"<myriad_ode.Run of {self.size} instances: {counts}>"
