# SPDX-License-Identifier: MIT
"""Experiments: data sets with the conditions under which they were measured, given one by one or as a long table."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.data_table import DataTable, is_missing, name_in
from ..base.errors import Error
from ..models.components import by_component, name_of
from ..models.dose_table import DoseTable
from ..sweeps.inputs import by_name, real
from ..symbolic.node import Node

if TYPE_CHECKING:
    from ..symbolic.types import Array, ByComponent, Component

__all__ = ["Experiment", "experiment", "experiments_from_table"]


class Experiment:
    """Data and the conditions under which they were measured, as `my.experiment` makes it for `my.fit`."""

    def __init__(self, data: Any, name: Any, sweep: ByComponent | None, start: ByComponent | None, begin: float | None,
                 sigma: Any, limits: Any) -> None:
        self.data = data  #: times and values
        self.name = None if name is None else str(name)  #: None until the fit numbers it
        self.sweep = _conditions(sweep, "sweep")  #: values of parameters, or the names of free components
        self.start = _conditions(start, "start")  #: the same of initial states
        self.begin = None if begin is None else real(begin, "begin")  #: the time of the initial values
        self.sigma, self.limits = sigma, limits  #: of the data, if they are not those of the fit

    def __repr__(self) -> str:
        conditions = ", ".join(f"{name}={value}" for name, value in {**self.sweep, **self.start}.items())
        called = "" if self.name is None else f" '{self.name}'"
        return f"<myriad_ode.Experiment{called}{': ' if conditions else ''}{conditions}>"


def _conditions(given: ByComponent | None, argument: str) -> dict[str, Any]:
    """Values by name: numbers, or the names of free components."""
    values = by_component(by_name(given, argument, f"{argument}={{dose: 50}}"), f"{argument}=")
    found: dict[str, Any] = {}
    for name, value in values.items():
        if isinstance(value, (str, Node)):
            found[name] = name_of(value)
        elif np.ndim(value) != 0:
            raise Error(f"'{name}' has several values in {argument}= of an experiment: give one, and an experiment for "
                        "each")
        else:
            found[name] = real(value, f"{argument}= of '{name}'")
            if not np.isfinite(found[name]):
                raise Error(f"{argument}= of '{name}' is {found[name]}: give a number")
    return found


def experiment(data: Any, *, name: Any = None, sweep: ByComponent | None = None, start: ByComponent | None = None,
               begin: float | None = None, sigma: Any = None, limits: Any = None) -> Experiment:
    """An experiment for `my.fit`: data, and what differs from other experiments.

    data     a dict, or a data frame, with times "t" and values of states or outputs by name; NaN: no value. The
             experiment ends with the last time
    name     what it is called in results and pictures; without, its number, from 1
    sweep    values of parameters: numbers, or the name of a component in `free=` of the fit, as `{k: "k of mutants"}`
    start    initial values of states, the same way
    begin    the time of the initial values
    sigma    of the data, as in `my.fit`, an array of one for each time too
    limits   of quantification, as in `my.fit`

    What is not given is as in the fit. A component that `free=` has and an experiment gives has its value there."""
    return Experiment(data, name, sweep, start, begin, sigma, limits)


def experiments_from_table(table: Any, *, id: str = "id", t: str = "t", value: str = "value",
                           quantity: str = "quantity", of: Component | None = None,
                           sweep: Mapping[Any, str] | None = None, start: Mapping[Any, str] | None = None,
                           sigma: str | None = None, begin: float | None = None,
                           limits: Any = None) -> list[Experiment]:
    """Experiments for `my.fit` from a long table, a row for each value: a data frame of pandas or polars, a dict of
    columns, or the path of a CSV file. Or from a table of doses, `my.dose_table(...)`, of whose observations `of` says
    what they are: each subject is an experiment with its own doses, that of a model with these doses; of the other
    arguments it has `limits`.

    id           the column that tells experiments apart, whose cells are their names
    t, value     the columns of times, in any order, and of values; rows without a value are left out
    quantity     the column of the names of states or outputs that were measured
    of           in its place, the one state or output that all values are of
    sweep        columns of parameters, `{weight: "WT"}`, with one value in an experiment, in any of its rows
    start        columns of initial states, the same way
    sigma        the column of standard deviations of the values
    begin, limits  of all experiments, as in `my.experiment`

    Raises `Error` with the column, and the row or experiment, of what is wrong."""
    if isinstance(table, DoseTable):
        return _of_subjects(table, of, limits)
    columns = DataTable(table, "the table")
    ids = columns.cells(id, "id=")
    times, values = columns.numbers(t, "t="), columns.numbers(value, "value=")
    deviations = None if sigma is None else columns.numbers(sigma, "sigma=")
    if of is None:
        quantities = columns.cells(quantity, "quantity=", ", or give of=x if all values are of x")
    else:
        quantities = [name_of(of)] * len(ids)
    conditions = {argument: {name_of(key): columns.numbers(column, f"{argument}= of '{name_of(key)}'")
                             for key, column in (given or {}).items()}
                  for argument, given in (("sweep", sweep), ("start", start))}
    of_experiments: dict[str, list[int]] = {}
    for row, one in enumerate(ids):
        if is_missing(one):
            raise Error(f"{columns.row(row)} has nothing in the column '{id}': every row needs an experiment")
        of_experiments.setdefault(name_in(one), []).append(row)
    found = []
    for name, rows in of_experiments.items():
        measured = [row for row in rows if not np.isnan(values[row])]
        if not measured:
            raise Error(f"experiment '{name}' has no values in column '{value}': leave its rows out")
        for row in measured:
            if is_missing(quantities[row]):
                raise Error(f"{columns.row(row)} has nothing in the column '{quantity}': name what was measured")
        names = list(dict.fromkeys(name_in(quantities[row]) for row in measured))
        data: dict[str, Array] = {"t": times[measured]}
        spread: dict[str, Array] = {}
        for one in names:
            there = np.array([name_in(quantities[row]) == one for row in measured])
            data[one] = np.where(there, values[measured], np.nan)
            if deviations is not None:
                spread[one] = np.where(there, deviations[measured], 1.0)
        own = {argument: {key: _one_value(cells[rows], name, argument, key) for key, cells in given.items()}
               for argument, given in conditions.items()}
        found.append(Experiment(data, name, own["sweep"], own["start"], begin, spread or None, limits))
    return found


def _of_subjects(records: DoseTable, of: Component | None, limits: Any) -> list[Experiment]:
    """The observations of a table of doses, by subject."""
    if of is None:
        raise Error("the observations of a table of doses have no name: give of=x if they are values of x")
    found = []
    for i, name in enumerate(records.names):
        there = ~np.isnan(records.observed[i])
        if there.any():
            data = {"t": records.observed_times[i][there], name_of(of): records.observed[i][there]}
            own = {key: float(values[i]) for key, values in records.sweep.items()}
            found.append(Experiment(data, name_in(name), own, None, float(records.time[0][i]), None, limits))
    if not found:
        raise Error("the table of doses has no observations: give them in a column dv")
    return found


def _one_value(cells: Array, experiment: str, argument: str, component: str) -> float:
    """The one number that an experiment has in a column."""
    there = np.unique(cells[~np.isnan(cells)])
    if there.size != 1:
        has = f"the values {', '.join(f'{v:g}' for v in there)}" if there.size else "no value"
        raise Error(f"experiment '{experiment}' has {has} in the column for {argument}= of '{component}': give one in "
                    "an experiment")
    return float(there[0])
