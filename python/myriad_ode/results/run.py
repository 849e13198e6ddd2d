# SPDX-License-Identifier: MIT
"""The outcome of `solve`: arrays by name, statuses, and the ways to other packages and to files."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np

from ..base import component_kinds as kinds
from ..base.errors import Error, renamed
from ..base.statuses import first_failure, status_names
from ..models.components import name_of
from ..sweeps.gpu_inputs import DeviceInput
from ..sweeps.inputs import path_text
from ..sweeps.sweep import Sweep
from ..symbolic.delays import pasts_of
from ..symbolic.evaluate import evaluate
from ..symbolic.node import Node, symbols_of
from ..symbolic.symbols import time
from . import conversions, saved_file
from .gpu_results import DeviceResults
from .past_states import PastStates
from .protocol import Quantity
from .quantities import called, listed, names_of_symbol, of_component, quantities_of, times, unknown_quantity
from .report import Report
from .run_plots import Plots, html
from .saved import parts_of, saved
from .sensitivities import Sensitivities

if TYPE_CHECKING:
    import pandas
    import xarray

    from ..models.components import Components
    from ..symbolic.types import Array, Component, Path

# What was called otherwise before, and what it is called now.
_renamed = {"t": "t_last", "sample_times": "t_sample", "steps": "accepted_steps, rejected_steps, located_steps or "
            "rhs_evaluations, which are arrays"}


class Run(Mapping):
    """The results of one call of `solve`, a mapping from names to arrays, with the names that studies, datasets, tables
    and files have. Of a component x, `run["x"]` are the values at recorded phases, one row per instance and one column
    per phase, `run["x_sample"]` samples, one column per sample, `run["x_end"]` the value at the end, and
    `run["x_start"]` the initial value; parameters and shared values are as they were given. The times are "t",
    "t_sample" and "t_last", the time at which the last phase ended. "status" says in words how instances ended.

    A component alone, as `run[x]`, is what was recorded of it, else its samples, else its value at the end;
    `run[my.time]` are the times of these. A component whose name means something else here has its kind in front, as
    "state_t". The length of a run is the number of names; `size` is the number of instances. Arrays are views of the
    core's memory, not copies. Results of a GPU are copied to the host when they are first asked for."""

    def __init__(self, components: Components, ensemble: Any, report: Any, kernel: Any, sweep: Any,
                 inputs: dict[str, Any], domain: tuple[Any, Any], recorded: dict[str, tuple[str, int]],
                 sampled: dict[str, int], seconds: float, record: Any, notes: Sequence[str] = (),
                 describe: Callable[[], dict[str, Any]] = dict, past: PastStates | None = None) -> None:
        self._components, self._ensemble, self._records = components, ensemble, report
        self._recorded, self._sampled, self._inputs, self._domain = recorded, sampled, inputs, domain
        self._records_time, self._describe, self._past = record.time, describe, past
        self.sweep = sweep if isinstance(sweep, Sweep) else None
        self.report = Report(report, kernel, seconds, notes)
        self.from_phase = record.from_phase  #: number of the first recorded phase
        self.units = components.units  #: of components and outputs, where the model knows them
        self.time_unit = components.time_unit  #: empty where it is not known

    if not TYPE_CHECKING:
        def __getattr__(self, name: str) -> NoReturn:
            raise AttributeError(renamed("run", name, _renamed), name=name, obj=self)

    @property
    def size(self) -> int:
        """The number of instances."""
        return self.report.instances

    @property
    def shape(self) -> tuple[int, ...]:
        """The lengths of the sweep's axes; a sweep without axes has its size alone."""
        return tuple(self.sweep.shape) if self.sweep is not None else (self.size,)

    @property
    def description(self) -> dict[str, Any]:
        """What was solved, as a dict: the model's name and its text in C++, method, control, precision, and the options
        that are not the defaults, as text."""
        return self._describe()

    @property
    def status(self) -> Array:
        """How each instance ended, in words: "success", "max_steps" and others."""
        return self["status"]

    @property
    def status_codes(self) -> Array:
        """The same as numbers into `my.status_names`, in a byte of memory each."""
        return self._ensemble.array("status")

    @property
    def done(self) -> int:
        """The number of instances that were integrated: all, unless the call was interrupted."""
        by_status = self._records.by_status
        return self.size - by_status[status_names.index("not_started")] - by_status[status_names.index("interrupted")]

    @property
    def failed(self) -> Array:
        """True for each instance that ended with a failure."""
        return self.status_codes >= first_failure

    @property
    def t_last(self) -> Array:
        """The time at which the last phase of each instance ended."""
        return self._ensemble.array("t")

    @property
    def phases_done(self) -> Array:
        """The number of phases that each instance has done."""
        return self._ensemble.array("phases_done")

    @property
    def accepted_steps(self) -> Array:
        """The number of accepted steps of each instance."""
        return self._ensemble.array("accepted_steps")

    @property
    def rejected_steps(self) -> Array:
        """The number of rejected steps of each instance."""
        return self._ensemble.array("rejected_steps")

    @property
    def located_steps(self) -> Array:
        """The number of steps of each instance that were redone to locate events."""
        return self._ensemble.array("located_steps")

    @property
    def rhs_evaluations(self) -> Array:
        """How often the right-hand side of each instance was evaluated."""
        return self._ensemble.array("rhs_evaluations")

    @property
    def stored_samples(self) -> Array:
        """The number of samples of each instance."""
        self._require_samples()
        return self._ensemble.stored_samples()

    @property
    def t_sample(self) -> Array:
        """The times of the samples, one row per instance; NaN beyond those stored."""
        self._require_samples()
        return self._ensemble.samples(-1)

    def _require_samples(self) -> None:
        if not self._sampled:
            raise Error("no samples were taken: give samples= to solve")

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
                np.asarray(self._inputs[name]) for name in self._components.states if name in self._inputs}

    @property
    def records(self) -> dict[str, Array]:
        """What was recorded of components at the end of each phase, by name: one row per instance, one column per
        phase; NaN (0 of integers) after an instance has ended."""
        return {name: self._records.records(kind, c) for name, (kind, c) in self._recorded.items()}

    @property
    def samples(self) -> dict[str, Array]:
        """The sampled states by name: one row per instance, one column per sample."""
        return {name: self._ensemble.samples(c) for name, c in self._sampled.items()}

    @property
    def sensitivity(self) -> Sensitivities:
        """Derivatives of the results, if `free=` was given: `run.sensitivity[x, k]` has the shape of
        `run[x]`, `run.sensitivity[x]` one more axis behind it, for all components that they are by."""
        if not self._components.derivatives_by:
            raise Error("the run has no sensitivities: give free= to solve, as in free=[k, x]")
        return Sensitivities(self, self._components.derivatives_by)

    @property
    def device(self) -> DeviceResults:
        """Results where a GPU has them, by name: `run.device["x"]` is an array as `run["x"]`, that torch, CuPy and JAX
        take without a copy."""
        return DeviceResults(self)

    @property
    def _outputs(self) -> Mapping[str, Node]:
        """The outputs of the model, as expressions, with those that read the past where that is known."""
        components = self._components
        return {**components.outputs, **components.past_outputs} if self._past is not None else components.outputs

    @functools.cached_property
    def _called(self) -> dict[str, str]:
        """What results call components and outputs."""
        components = self._components
        return called({kind: [name for name in names if name not in components.tables]
                       for kind, names in components.names.items()}, self._outputs)

    @functools.cached_property
    def _quantities(self) -> dict[str, Quantity]:
        return quantities_of(self)

    def _of_component(self, name: str) -> str | None:
        """The name of what a component or output stands for by itself."""
        name = self._components.aliases.get(name, name)
        return of_component([self._called[name]], self._quantities) if name in self._called else None

    def _find(self, key: Component) -> str:
        """The name of the quantity that a name, a symbol or `my.time` stands for."""
        if isinstance(key, str) and key in self._quantities:
            return key
        found = None
        if key is not time:
            found = self._of_component(name_of(key))
            if found is None and isinstance(key, Node):
                found = of_component(names_of_symbol(key), self._quantities)
        if key is time or found is None and isinstance(key, str) and key == "t":
            found = next(name for name in times if name in self._quantities)
        if found is None:
            raise unknown_quantity(name_of(key), list(self))
        return found

    def __getitem__(self, key: Component) -> Array:
        return self._quantities[self._find(key)].read()

    def _along(self, dimension: str, name: str) -> Array | None:
        """The values of a component or output along "phase" or "sample"; None if there are none."""
        called = self._called.get(self._components.aliases.get(name, name), "")
        quantity = self._quantities.get(called + {"phase": "", "sample": "_sample"}[dimension])
        return quantity.read() if quantity is not None and quantity.along == dimension else None

    def _values_of(self, component: str) -> Array:
        """The values of a component or output, whatever else has its name. Those of states and accessories are found
        without what all quantities take to be listed, as functions of arrays ask for them in many short calls."""
        if component in self._recorded:
            return self._records.records(*self._recorded[component])
        if component in self._sampled:
            return self._ensemble.samples(self._sampled[component])
        kind, number = self._components.place.get(component, ("", 0))
        if kind in kinds.recorded:
            return self._ensemble.array(kind, number)
        return self._quantities[self._of_component(component) or component].read()

    def _places_of(self, expression: Node) -> list[str | None]:
        """Where the values of an expression are known: along "phase" or "sample", and None for the end."""
        symbols = symbols_of([expression, *(one.value[1].lag for one in pasts_of([expression]))])
        changing = [s.value[1] for s in symbols if s.value[0] in kinds.recorded]
        of_time = any(s is time or s.value[0] == "delayed" for s in symbols)
        places: list[str | None] = [None]
        if self._sampled and (changing or of_time) and all(n in self._sampled for n in changing):
            places.insert(0, "sample")
        if (changing or of_time) and all(n in self._recorded for n in changing) and (self._records_time or not of_time):
            places.insert(0, "phase")
        return places

    def _output_at(self, place: str | None, expression: Node) -> Array:
        """The values of an expression at a place that `_places_of` has told."""
        at: Any
        if place == "sample":
            at, changing = self["t_sample"], self.samples
            shape = at.shape
        elif place == "phase":
            at, changing = self["t"] if self._records_time else None, self.records
            shape = (at if at is not None else next(iter(changing.values()))).shape
        else:
            at, changing, shape = self["t_last"], self._last_values(kinds.recorded), (self.size,)
        known: dict[Any, Any] = {}
        pasts = pasts_of([expression])
        for symbol in symbols_of([expression, *(one.value[1].lag for one in pasts)]):
            kind, name = symbol.value
            if kind == "delayed":
                continue
            if symbol in self._components.constants:
                known[symbol] = self._components.constants[symbol]
            elif symbol is time:
                known[symbol] = at
            elif kind in kinds.recorded:
                known[symbol] = changing[name]
            elif kind == "parameter":
                known[symbol] = self.parameters[name][:, None] if place else self.parameters[name]
            else:
                known[symbol] = self.shared[name]
        for one in pasts:
            assert self._past is not None  # as these are no outputs otherwise
            lag, = evaluate([one.value[1].lag], known)
            known[one] = self._past(self, one.value[1].state.value[1], np.broadcast_to(at - lag, shape))
        result, = evaluate([expression], known)
        return np.array(np.broadcast_to(result, shape))

    def __iter__(self) -> Iterator[str]:
        return iter(listed(self._quantities))

    def __len__(self) -> int:
        return len(listed(self._quantities))

    def __contains__(self, name: object) -> bool:
        try:
            self[name]
        except Error:
            return False
        return True

    def _ipython_key_completions_(self) -> list[str]:
        return list(self)

    # two runs are equal if they are the same, as their arrays have no single truth value
    __eq__, __hash__ = object.__eq__, object.__hash__

    @classmethod
    def _restored(cls, header: Mapping[str, Any], arrays: Mapping[str, Array]) -> Run:
        """The run of which so much has lasted."""
        return cls(**parts_of(header, arrays))

    def __reduce__(self) -> tuple[Any, ...]:
        return Run._restored, tuple(saved(self))

    def save(self, path: Path) -> None:
        """Writes all results into one file, which `my.load(path)` reads as an equal run: values by name, statuses,
        records, samples, derivatives, counts, the sweep, the report, and the model's text in `description`. What is on
        a GPU is copied; the kernel and initial states that were given on a GPU are left out. The file is NumPy's .npz
        with a header in JSON, whatever its name, and replaces one of that name when it is whole."""
        saved_file.write(path_text(path), saved(self))

    def to_xarray(self) -> xarray.Dataset:
        """The results as an `xarray.Dataset` with the names of the run: along `instance`, or the axes of a grid, and
        then along `phase` or `sample`. What instances were given are coordinates."""
        return conversions.to_xarray(self)

    def to_pandas(self) -> pandas.DataFrame:
        """The results as a `pandas.DataFrame` with the names of the run: one row for each instance and recorded phase,
        or each instance and sample, or each instance, with the parameters as columns."""
        return conversions.to_pandas(self)

    def to_netcdf(self, path: Path) -> None:
        """Writes what `to_xarray` has as netCDF-4, which xarray, MATLAB, Julia and R read, by the package netCDF4 or
        h5netcdf. Statuses are numbers there, with the flags of the CF conventions. The file replaces one of that name
        when it is whole, as those of the other formats do."""
        conversions.write_netcdf(self, path_text(path))

    def to_csv(self, path: Path) -> None:
        """Writes the table of `to_pandas` as text with commas, by pandas or polars."""
        conversions.write_csv(self, path_text(path))

    def to_parquet(self, path: Path) -> None:
        """Writes the table of `to_pandas` as a Parquet file, by pandas and pyarrow, or by polars."""
        conversions.write_parquet(self, path_text(path))

    def to_mat(self, path: Path) -> None:
        """Writes the results by their names as a MAT file of MATLAB's, version 5, by SciPy: a row for each instance,
        and a column for each phase or sample. `status_names(status_codes + 1)` are the statuses there."""
        conversions.write_mat(self, path_text(path))

    @property
    def plot(self) -> Plots:
        """Pictures by matplotlib: `bifurcation`, `map`, `time_series`, `bands`, `phase_portrait` and `statuses`."""
        return Plots(self)

    def _repr_html_(self) -> str:
        return html(self)

    def __repr__(self) -> str:
        counts = ", ".join(f"{count} {name}" for name, count in self.report.by_status.items())
        return f"<myriad_ode.Run of {self.size} instances: {counts}>"
