# SPDX-License-Identifier: MIT
"""Pictures of the results of a run, and what a notebook shows of it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..base import plots
from ..base.errors import Error
from ..base.html import row
from ..base.statuses import status_names
from ..models.components import name_of

if TYPE_CHECKING:
    import numpy.typing as npt
    from matplotlib.axes import Axes

    from ..symbolic.types import Array, Component
    from .protocol import Results


class Plots:
    """`run.plot`: pictures of the results of a run, whose components are given by name or symbol."""

    def __init__(self, run: Any) -> None:
        self._run = run

    def _label(self, name: str) -> str:
        units = self._run.units
        return f"{name} ({units[name]})" if name in units else name

    def _per_instance(self, name: str) -> Array:
        """A value for each instance: of the sweep, so that initial states are those given, else of the results."""
        run = self._run
        if run.sweep is not None and name in run.sweep.names:
            return run.sweep.values(name)
        values = np.asarray(run[name])
        if values.shape != (run.size,):
            raise Error(f"{name} has values of shape {values.shape}: this axis needs one number per instance")
        return values

    def bifurcation(self, x: Component, y: Component, *, axes: Axes | None = None, **style: Any) -> Any:
        """The recorded component y of every phase over the parameter x."""
        x, y = name_of(x), name_of(y)
        if y not in self._run.records:
            raise Error(f"{y} was not recorded: give record=dict(from_phase=..., states=[{y}]) to solve")
        return plots.bifurcation(self._per_instance(x), self._run.records[y], xlabel=self._label(x),
                                 ylabel=self._label(y), axes=axes, **style)

    def map(self, x: Component, y: Component, z: Component, *, phase: int = -1, axes: Axes | None = None,
            **style: Any) -> Any:
        """The component z over two axes of a grid, x and y: its value at the end, or in one recorded phase; failed
        instances are left grey. z may be "status"."""
        run, (x, y, z) = self._run, map(name_of, (x, y, z))
        along = [] if run.sweep is None else [name for name, _ in run.sweep.axes]
        if sorted((x, y)) != sorted(name for name, values in (run.sweep.axes if along else ()) if len(values) > 1):
            raise Error(f"the sweep is no grid over {x} and {y} alone (its axes: {', '.join(along) or 'none'}): make "
                        f"it by my.grid({x}=..., {y}=...)")
        values = np.asarray(run.status_codes if z == "status" else
                            run.records[z][:, phase] if z in run.records else run[z])
        if values.ndim == 2:
            values = values[:, -1]
        if z != "status":
            values = np.where(run.failed, np.nan, values)
        grid = np.moveaxis(run.sweep.unstack(values), (along.index(x), along.index(y)), (0, 1))
        values_of = dict(run.sweep.axes)
        return plots.parameter_map(values_of[x], values_of[y], grid.reshape(grid.shape[:2]), xlabel=self._label(x),
                                   ylabel=self._label(y), zlabel=self._label(z),
                                   names=status_names if z == "status" else None, axes=axes, **style)

    def _instances(self, instances: npt.ArrayLike | None) -> tuple[Array, list[str]]:
        """Numbers of instances and what tells them apart."""
        run = self._run
        chosen = np.arange(min(run.size, 5)) if instances is None else np.atleast_1d(np.asarray(instances, int))
        if chosen.ndim != 1 or not ((-run.size <= chosen) & (chosen < run.size)).all():
            raise Error(f"instances {instances!r}: give numbers from 0 to {run.size - 1}")
        chosen = chosen % run.size
        varying = [] if run.sweep is None else list(run.sweep.coordinates)[:2]
        values = {name: run.sweep.values(name)[chosen] for name in varying}
        return chosen, [", ".join(f"{n} = {v[i]:.4g}" for n, v in values.items()) or f"instance {chosen[i]}"
                        for i in range(len(chosen))]

    def time_series(self, y: Component, *, instances: npt.ArrayLike | None = None, axes: Axes | None = None,
                    **style: Any) -> Any:
        """The samples of a state over time, for the first five instances or the given ones."""
        run, y = self._run, name_of(y)
        chosen, labels = self._instances(instances)
        if y not in run.samples:
            raise Error(f"there are no samples of {y}: give samples=, as in samples=200, to solve")
        xlabel = f"t ({run.time_unit})" if run.time_unit else None
        return plots.time_series(run.t_sample[chosen], run.samples[y][chosen], labels=labels, xlabel=xlabel,
                                 ylabel=self._label(y), axes=axes, **style)

    def phase_portrait(self, x: Component, y: Component, *, instances: npt.ArrayLike | None = None,
                       axes: Axes | None = None, **style: Any) -> Any:
        """The samples of one state over another; without samples the points recorded at the ends of phases.
        For the first five instances or the given ones."""
        run, x, y = self._run, name_of(x), name_of(y)
        chosen, labels = self._instances(instances)
        points = not (x in run.samples and y in run.samples)
        kept = run.records if points else run.samples
        if x not in kept or y not in kept:
            raise Error(f"there are no samples of {x} and {y}, nor records of both: give samples= or record= to solve")
        return plots.phase_portrait(kept[x][chosen], kept[y][chosen], labels=labels, xlabel=self._label(x),
                                    ylabel=self._label(y), points=points, axes=axes, **style)

    def statuses(self, *, axes: Axes | None = None) -> Any:
        """How many instances ended in which way."""
        return plots.statuses(self._run.status_codes, status_names, axes=axes)


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
