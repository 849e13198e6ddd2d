# SPDX-License-Identifier: MIT
"""Pictures of the results of a run, and what a notebook shows of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base import plots
from ..base.errors import Error
from ..base.html import row
from ..base.plot_parts import checked_quantiles
from ..base.statuses import status_names
from ..models.components import listed, name_of
from ..sweeps.inputs import whole

if TYPE_CHECKING:
    import numpy.typing as npt
    from matplotlib.axes import Axes

    from ..symbolic.types import Array, Component, SomeComponents
    from .protocol import Results


class Plots:
    """`run.plot`: pictures of the results of a run, whose components are given by name or symbol."""

    def __init__(self, run: Any) -> None:
        self._run = run

    def _label(self, name: str, when: str = "") -> str:
        units = self._run.units
        return " ".join([name, *([when] if when else []), *([f"({units[name]})"] if name in units else [])])

    def _varied(self, name: str) -> str:
        """The label of what the sweep varies: of a state that is its value at the start."""
        return self._label(name, "at the start" if name in self._run.states else "")

    def _in_sweep(self, name: str) -> bool:
        return self._run.sweep is not None and name in self._run.sweep.names

    def _samples_of(self, name: str) -> Array:
        if (values := self._run._along("sample", name)) is None:
            raise Error(f"there are no samples of {name}: give samples=, as in samples=200, to solve")
        return values

    def _per_instance(self, name: str) -> Array:
        """A value for each instance: of the sweep, so that initial states are those given, else of the results."""
        run = self._run
        if self._in_sweep(name):
            return run.sweep.values(name)
        values = np.asarray(run[name])
        if values.shape != (run.size,):
            raise Error(f"{name} has values of shape {values.shape}: this axis needs one number per instance")
        return values

    def _starts_beside(self, x: str) -> list[str]:
        """The states whose initial values a grid varies along other axes than that of x."""
        coordinates = {} if self._run.sweep is None else self._run.sweep.coordinates
        along = coordinates.get(x, ("",))[0]
        return [name for name, (axis, values) in coordinates.items()
                if name in self._run.states and axis != along and len(np.unique(values)) > 1]

    def _told_apart(self, names: Sequence[str]) -> tuple[Any, str]:
        """What tells instances apart by some components: numbers of one, words of several; and what it is."""
        label = ", ".join(map(self._varied, names))
        columns = [self._per_instance(name) for name in names]
        if len(names) < 2:
            return (columns[0] if names else None), label
        sets, which = np.unique(np.stack(columns, axis=1), axis=0, return_inverse=True)
        return np.array([", ".join(f"{value:.4g}" for value in one) for one in sets])[which.ravel()], label

    def bifurcation(self, x: Component, y: Component, *, by: SomeComponents | None = None, axes: Axes | None = None,
                    **style: Any) -> Any:
        """The recorded component or output y of every phase over the parameter x. Colours tell apart what comes from
        different values of the components `by`: without, of the initial states that a grid varies; `by=()` has one
        colour."""
        x, y = name_of(x), name_of(y)
        if (recorded := self._run._along("phase", y)) is None:
            raise Error(f"{y} was not recorded: give record=dict(from_phase=..., states=[{y}]) to solve")
        names = self._starts_beside(x) if by is None else [name_of(one) for one in listed(by)]
        told, bylabel = self._told_apart(names)
        return plots.bifurcation(self._per_instance(x), recorded, by=told, bylabel=bylabel,
                                 xlabel=self._varied(x) if self._in_sweep(x) else self._label(x),
                                 ylabel=self._label(y), axes=axes, **style)

    def _at_the_end(self, z: str, phase: int) -> tuple[Any, str]:
        """Values of a component at the end, or in a recorded phase, and their label."""
        run = self._run
        if z == "status":
            return run.status_codes, z
        if (recorded := self._run._along("phase", z)) is not None:
            count = recorded.shape[1]
            if not -count <= whole(phase, "phase") < count:
                raise Error(f"phase is {phase}: {count} phases were recorded, so give a number from 0 to {count - 1}, "
                            "or -1 for the last one")
            number = phase % count
            last = number == recorded.shape[1] - 1
            return recorded[:, number], self._label(z, "at the end" + ("" if last else
                                                                     f" of phase {run.from_phase + number}"))
        kept = {**run.states, **run.accessories}
        values = np.asarray(kept[z] if z in kept else run[z])
        return (values[:, -1] if values.ndim == 2 else values), self._label(z, "at the end" if z in run.states else "")

    def map(self, x: Component, y: Component, z: Component, *, phase: int = -1,
            names: Sequence[str] | Mapping[int, str] | None = None, axes: Axes | None = None, **style: Any) -> Any:
        """The component or output z over two axes of a grid, x and y: its value at the end, or in one recorded phase;
        failed instances are left grey. z may be "status". `names` says what whole numbers stand for."""
        run, (x, y, z) = self._run, map(name_of, (x, y, z))
        if x == y:
            raise Error(f"{x} is named twice: name two axes of the grid")
        along = [] if run.sweep is None else [name for name, _ in run.sweep.axes]
        if sorted((x, y)) != sorted(name for name, values in (run.sweep.axes if along else ()) if len(values) > 1):
            raise Error(f"the sweep is no grid over {x} and {y} alone (its axes: {', '.join(along) or 'none'}): make "
                        f"it by my.grid({x}=..., {y}=...)")
        values, zlabel = self._at_the_end(z, phase)
        grid, failed = (np.moveaxis(run.sweep.unstack(one), (along.index(x), along.index(y)), (0, 1))
                        for one in (values, run.failed))
        if z != "status":
            grid = np.ma.masked_where(failed, grid)
        values_of = dict(run.sweep.axes)
        return plots.parameter_map(values_of[x], values_of[y], grid.reshape(grid.shape[:2]), xlabel=self._varied(x),
                                   ylabel=self._varied(y), zlabel=zlabel,
                                   names=status_names if z == "status" else names, axes=axes, **style)

    def _instances(self, instances: npt.ArrayLike | None) -> tuple[Array, list[str]]:
        """Numbers of instances and what tells them apart."""
        run = self._run
        if not run.size:
            raise Error("the run has no instances: there is nothing to draw")
        chosen = np.atleast_1d(np.arange(min(run.size, 5)) if instances is None else np.asarray(instances))
        if (chosen.ndim != 1 or not chosen.size or chosen.dtype.kind not in "iu"
                or not ((-run.size <= chosen) & (chosen < run.size)).all()):
            raise Error(f"instances {instances!r}: give numbers from 0 to {run.size - 1}")
        chosen = chosen % run.size
        given = ({name: run.sweep.values(name) for name in run.sweep.coordinates} if run.sweep is not None else
                 {**run.parameters, **{name: values for name, values in run.start.items()
                                       if isinstance(values, np.ndarray) and values.ndim}})
        varying = [name for name, values in given.items() if len(np.unique(np.asarray(values)[chosen])) > 1][:2]
        values = {self._varied(name): np.asarray(given[name])[chosen] for name in varying}
        return chosen, [", ".join(f"{n} = {v[i]:.4g}" for n, v in values.items()) or f"instance {chosen[i]}"
                        for i in range(len(chosen))]

    def time_series(self, y: Component, *, instances: npt.ArrayLike | None = None, axes: Axes | None = None,
                    **style: Any) -> Any:
        """The samples of a state or an output over time, for the first five instances or the given ones."""
        run, y = self._run, name_of(y)
        chosen, labels = self._instances(instances)
        sampled = self._samples_of(y)
        xlabel = f"t ({run.time_unit})" if run.time_unit else None
        return plots.time_series(run.t_sample[chosen], sampled[chosen], labels=labels, xlabel=xlabel,
                                 ylabel=self._label(y), axes=axes, **style)

    def bands(self, y: Component, *, quantiles: Sequence[float] = (0.05, 0.25, 0.5, 0.75, 0.95),
              axes: Axes | None = None, **style: Any) -> Any:
        """Quantiles of a sampled state or output over time, of all instances that did not fail: bands between two that
        belong together, and the median."""
        run, y = self._run, name_of(y)
        sampled, of = self._samples_of(y), checked_quantiles(quantiles)
        unfailed = ~run.failed
        times = run.t_sample[unfailed]
        if not len(times) or not (times == times[0]).all():
            raise Error("instances were not sampled at the same times, or none has succeeded: give samples= as times, "
                        "or the same time domain to all")
        xlabel = f"t ({run.time_unit})" if run.time_unit else None
        return plots.bands(times[0], np.quantile(sampled[unfailed], of, axis=0), quantiles, xlabel=xlabel,
                           ylabel=self._label(y), axes=axes, **style)

    def phase_portrait(self, x: Component, y: Component, *, instances: npt.ArrayLike | None = None,
                       axes: Axes | None = None, **style: Any) -> Any:
        """The samples of one state or output over another; without samples the points recorded at the ends of phases.
        For the first five instances or the given ones."""
        x, y = name_of(x), name_of(y)
        chosen, labels = self._instances(instances)
        of_x, of_y = self._run._along("sample", x), self._run._along("sample", y)
        points = of_x is None or of_y is None
        if points:
            of_x, of_y = self._run._along("phase", x), self._run._along("phase", y)
        if of_x is None or of_y is None:
            raise Error(f"there are no samples of {x} and {y}, nor records of both: give samples= or record= to solve")
        return plots.phase_portrait(of_x[chosen], of_y[chosen], labels=labels, xlabel=self._label(x),
                                    ylabel=self._label(y), points=points, axes=axes, **style)

    def statuses(self, *, axes: Axes | None = None, **style: Any) -> Any:
        """How many instances ended in which way."""
        return plots.statuses(self._run.status_codes, status_names, axes=axes, **style)


def html(run: Results) -> str:
    """What a notebook shows of a run: its sweep, statuses, results by name and report."""
    from html import escape

    kinds = (("recorded by phase", run.records), ("samples", run.samples), ("at the end", {**run.states,
                                                                                          **run.accessories}))
    rows = [row("instances", f"{run.size}" + (f": {escape(repr(run.sweep)[1:-1])}" if run.sweep is not None else ""))]
    rows.append(row("ended as", ", ".join(f"{count} {escape(name.replace('_', ' '))}"
                                          for name, count in run.report.by_status.items())))
    for kind, arrays in kinds:
        if arrays:
            named = ", ".join(f"<code>{escape(n)}</code> {escape(str(np.shape(a)))}" for n, a in arrays.items())
            rows.append(row(kind, named))
    return (f"<table>{''.join(rows)}</table><details><summary>Report</summary><pre>{escape(str(run.report))}</pre>"
            "</details>")
