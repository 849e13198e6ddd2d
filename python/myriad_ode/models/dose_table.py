# SPDX-License-Identifier: MIT
"""Doses from a table with a row for each, as programs of pharmacometrics have them: other times and amounts for each
subject. The columns have the names and meanings that they have in NONMEM's data."""

from __future__ import annotations

import csv
import os
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.errors import Error, at, users_line
from ..symbolic import symbols as sym
from ..symbolic.expression import make
from ..symbolic.folding import add, constant, multiply
from ..symbolic.functions import minimum, where
from ..symbolic.table import Table
from .event import Stop

if TYPE_CHECKING:
    from ..symbolic.types import Array, Component, Path, Written

__all__ = ["dose_table"]

_Dose = tuple[float, float, float, float]
_columns = ("id", "time", "amt", "evid", "cmt", "rate", "dur", "ii", "addl", "ss", "dv", "mdv")


def _name_of(state: Any) -> str:
    return str(getattr(state, "value", (None, state))[1])


class TabledDoses:
    """What one state gets by a table. Its rows are time, amount, and rate of infusions from then on; those of one
    subject follow each other, and end with a row of zeros that is none."""

    def __init__(self, into: Any, of_subjects: list[Array], lag: Any, bioavailability: Any) -> None:
        self.into, self.lag, self.bioavailability, self.line = into, lag, bioavailability, users_line()
        name = _name_of(into)
        ends = np.cumsum([len(rows) for rows in of_subjects])
        rows = np.zeros((1 << int(ends[-1] - 1).bit_length(), 3))  # as generated code has the length, but not the rows
        rows[:ends[-1]] = np.concatenate(of_subjects)
        self.table = Table(sym.check_name(f"{name}_doses", "a table"), rows)
        self.first, self.last = (sym.parameter(f"{what}_{name}_dose") for what in ("first", "last"))
        self.sweep = {self.first: np.concatenate([[0.0], ends[:-1]]), self.last: ends - 1.0}
        self.rate, self.until = (sym.accessory(f"{name}_{what}") for what in ("infused", "infused_until"))
        self.is_infusion = bool((rows[:, 2] > 0).any())

    @property
    def values(self) -> list[Any]:
        """All expressions of it."""
        return [self.lag, self.bioavailability, self.first, self.last]

    def read(self, expression: Callable[[Any, str], Any]) -> TabledDoses:
        """With expressions in place of texts and numbers."""
        self.lag = expression(self.lag, f"the lag of doses{at(self.line)}")
        self.bioavailability = expression(self.bioavailability, f"the bioavailability of doses{at(self.line)}")
        return self

    def stops(self, target: Any, free_name: Callable[[str], str]) -> list[Stop]:
        """The stop at which the state gets what is given at once, and the rate of infusions changes."""
        row = minimum(self.first + sym.stop_number, self.last)
        time, amount, rate = (make("lookup", (row,), (self.table, column, 3, len(self.table))) for column in range(3))
        time = where(self.first + sym.stop_number < self.last, add(time, self.lag), np.inf)
        do = {target: target + multiply(self.bioavailability, amount)}
        if self.is_infusion:
            do[self.rate] = rate
        made = Stop([time], None, None, free_name(f"{target.value[1]}_dose"), do)
        made.by_number, made.line = True, self.line
        return [made]

    def inflow(self) -> Any:
        """What infusions add to the derivative of the state."""
        return self.rate if self.is_infusion else constant(0.0)

    def hooks(self) -> tuple[dict[Any, Any], dict[Any, Any]]:
        """What is assigned at the start and at the end of a phase: infusions go on where a phase goes on in time from
        the last one."""
        if not self.is_infusion:
            return {}, {}
        goes_on = (sym.phase > 0) & (self.until == sym.time)
        return {self.rate: where(goes_on, self.rate, 0.0)}, {self.until: sym.time}


class DoseTable:
    """Doses by subject. Made by `my.dose_table`; for `model.with_doses`."""

    #: the ids of the subjects, in the order of the instances
    ids: list[Any]
    #: values of the parameters that say which rows are those of an instance: a part of the sweep
    sweep: dict[Any, Array]
    #: first and last time of each subject, for `time=`
    time: tuple[Array, Array]
    #: by name, a value for each subject: what other columns have
    covariates: dict[str, Array]
    #: times and values of observations, a row for each subject, NaN where it has fewer than others
    observed_times: Array
    observed: Array

    def __init__(self, parts: list[TabledDoses]) -> None:
        self.parts = parts
        self.sweep = {name: values for part in parts for name, values in part.sweep.items()}

    def __repr__(self) -> str:
        states = " and ".join(_name_of(part.into) for part in self.parts)
        return f"doses into {states} of {len(self.ids)} subjects"


def dose_table(data: Mapping[str, Any] | Path, into: Component | Mapping[Any, Component], *, lag: Written = 0.0,
               bioavailability: Written = 1.0) -> DoseTable:
    """Doses for `model.with_doses` from a table: of pandas or polars, a dict of columns, or the path of a CSV file.

    A row is a dose, or an observation, of a subject. The columns, in any order and case, with NONMEM's meanings:

    id          the subject; each is an instance, in the order in which they come; without it there is one
    time        in the model's unit; does not decrease within a subject
    amt         the amount, in the unit of the state
    evid        1 for a dose, 0 for an observation, 2 for neither; by default a row with an amount is a dose
    cmt         which state gets it: a key of `into`; not needed where `into` is one state
    rate, dur   of an infusion: amount by time, or how long it takes; 0 for a dose at once
    addl, ii    so many more doses, at intervals of ii
    dv, mdv     what was observed, unless mdv is 1

    Other columns are covariates, numbers that do not change within a subject. A missing value is empty, "." or NaN.
    `lag` and `bioavailability` are as in `my.doses`; they hold for all rows.

    The result has what `solve` needs: `my.solve(model.with_doses(records), {**records.sweep, ...}, time=records.time)`.
    Doses before the begin of the time domain are not given. Raises `my.Error`, with the number of the row, where a
    value cannot be read or stands for what is not supported: a steady state (ss), a reset (evid 3 and 4), and rates
    that parameters decide (below zero).
    """
    line, columns = users_line(), _read(data)
    for name in ("time", "amt"):
        if name not in columns:
            raise Error(f"the table of doses has no column '{name}'{at(line)}: it has {', '.join(columns) or 'none'}")
    if not columns["time"]:
        raise Error(f"the table of doses has no rows{at(line)}: give one for each dose or observation")
    values = {name: _numbers(name, columns[name], line) for name in _columns[1:] if name in columns and name != "cmt"}
    ids = columns.get("id", ["1"] * len(columns["time"]))
    rows = _Rows(ids, dict(into) if isinstance(into, Mapping) else {None: into})
    for i, subject in enumerate(ids):
        row = {name: float(values[name][i]) if name in values else np.nan for name in _columns[1:]}
        rows.add(subject, row, columns["cmt"][i] if "cmt" in columns else None,
                 f"row {i + 1} of the table of doses{at(line)}")
    made = DoseTable([TabledDoses(rows.states[key], [_rows_of(several) for several in of_subjects.values()], lag,
                                  bioavailability)
                      for key, of_subjects in rows.given.items() if any(of_subjects.values())])
    if any(part.is_infusion for part in made.parts) and not (isinstance(bioavailability, (int, float))
                                                             and bioavailability == 1):
        raise Error(f"a table with infusions has the bioavailability {bioavailability!r}{at(line)}, which would change "
                    "how long they take: write my.doses for each")
    made.ids, made.time = list(rows.begin), (np.array([*rows.begin.values()]), np.array([*rows.end.values()]))
    made.covariates = {name: _constant(name, of_column, ids, line) for name, of_column in columns.items()
                       if name not in _columns}
    made.observed_times, made.observed = rows.observed()
    return made


class _Rows:
    """What the rows of a table say of each subject, in the order in which subjects come."""

    def __init__(self, ids: list[Any], states: dict[Any, Any]) -> None:
        order = dict.fromkeys(ids)
        self.states = states  #: by key
        #: begin, end, amount at once and rate of the doses, by key of the state and subject
        self.given: dict[Any, dict[Any, list[_Dose]]] = {key: {one: [] for one in order} for key in states}
        self.seen: dict[Any, list[tuple[float, float]]] = {one: [] for one in order}
        self.begin: dict[Any, float] = dict.fromkeys(order, np.inf)
        self.end: dict[Any, float] = dict.fromkeys(order, -np.inf)

    def add(self, subject: Any, row: Mapping[str, float], compartment: Any, where_it_is: str) -> None:
        """Takes a row, or refuses it."""
        time, last = row["time"], self.end[subject]
        if not np.isfinite(time) or time < last:
            raise Error(f"{where_it_is} has the time {time}{'' if np.isnan(time) else f' after {last}'}: sort the rows "
                        "of each subject by time")
        self.begin[subject], self.end[subject] = min(self.begin[subject], time), time
        if _is_dose(row, where_it_is):
            self.given[_key(compartment, self.states, where_it_is)][subject] += _doses_of(row, where_it_is)
        elif row["evid"] != 2 and row["mdv"] != 1 and not np.isnan(row["dv"]):
            self.seen[subject].append((time, row["dv"]))

    def observed(self) -> tuple[Array, Array]:
        """Times and values of the observations, a row for each subject."""
        most = max(map(len, self.seen.values()))
        padded = np.array([[*several, *[(np.nan, np.nan)] * (most - len(several))] for several in self.seen.values()]
                          ).reshape(len(self.seen), most, 2)
        return padded[..., 0], padded[..., 1]


def _read(data: Any) -> dict[str, list[Any]]:
    """The columns of a table, by name in small letters."""
    if isinstance(data, (str, os.PathLike)):
        with open(data, encoding="utf-8-sig", newline="") as file:
            read = csv.DictReader(file)
            rows = list(read)
        data = {name: [row[name] for row in rows] for name in read.fieldnames or ()}
    names = list(data) if isinstance(data, Mapping) else list(data.columns)
    return {str(name).strip().lower(): list(data[name]) for name in names}


def _number(given: Any) -> float:
    if given is None or isinstance(given, str) and given.strip().lower() in ("", ".", "na", "nan"):
        return float("nan")
    return float(given)


def _numbers(name: str, given: list[Any], line: tuple[str, int] | None) -> Array:
    made = np.empty(len(given))
    for row, one in enumerate(given):
        try:
            made[row] = _number(one)
        except (TypeError, ValueError):
            raise Error(f"row {row + 1} of the table of doses{at(line)} has {one!r} in the column '{name}': give a "
                        "number") from None
    return made


def _is_dose(row: Mapping[str, float], where_it_is: str) -> bool:
    evid = row["evid"] if not np.isnan(row["evid"]) else float(row["amt"] > 0)
    if evid not in (0, 1, 2):
        what = ", a reset: give what follows another id" if evid in (3, 4) else ": 0, 1 and 2 are known"
        raise Error(f"{where_it_is} has evid {evid:g}{what}")
    if evid == 1 and not row["amt"] > 0:
        raise Error(f"{where_it_is} is a dose of {row['amt']:g}: give an amount above zero, or evid 0")
    return evid == 1


def _key(given: Any, states: Mapping[Any, Any], where_it_is: str) -> Any:
    """Which of the states gets a dose."""
    if list(states) == [None]:
        return None
    for key in states:
        if str(key) == str(given) or not isinstance(key, str) and str(_number(given)) == str(float(key)):
            return key
    raise Error(f"{where_it_is} has cmt {given!r}: `into` has {', '.join(map(repr, states))}")


def _doses_of(row: Mapping[str, float], where_it_is: str) -> list[_Dose]:
    """Begin, end, amount at once and rate of the doses of a row."""
    rate, duration, more, interval = (0.0 if np.isnan(row[name]) else row[name]
                                      for name in ("rate", "dur", "addl", "ii"))
    if row["ss"] > 0:
        raise Error(f"{where_it_is} has ss {row['ss']:g}, a steady state: give the doses before it, as many as it "
                    "takes")
    if rate < 0 or duration < 0:
        raise Error(f"{where_it_is} has a rate or duration below zero, which a parameter would decide: write it as "
                    "my.doses(..., rate=) or duration=")
    if more > 0 and not interval > 0:
        raise Error(f"{where_it_is} has addl {more:g} and ii {interval:g}: give the interval of further doses in ii")
    if rate > 0 and duration > 0:
        raise Error(f"{where_it_is} has both rate and dur: give one of them")
    length = row["amt"] / rate if rate > 0 else duration
    rate = row["amt"] / length if length > 0 else 0.0
    begins = [row["time"] + k * interval for k in range(int(more) + 1)]
    return [(begin, begin + length, 0.0 if length > 0 else row["amt"], rate) for begin in begins]


def _rows_of(several: list[_Dose]) -> Array:
    """The rows of a subject: times, amounts, and rates from then on."""
    happening = sorted([(begin, amount) for begin, _, amount, _ in several]
                       + [(end, 0.0) for _, end, _, rate in several if rate > 0], key=lambda one: one[0])
    return np.array([*((time, amount, sum(rate for begin, end, _, rate in several if begin <= time < end))
                       for time, amount in happening), (0.0, 0.0, 0.0)])


def _constant(name: str, given: list[Any], ids: list[Any], line: tuple[str, int] | None) -> Array:
    """A covariate of each subject."""
    made: dict[Any, float] = dict.fromkeys(ids, np.nan)
    for subject, number in zip(ids, _numbers(name, given, line)):
        if np.isnan(made[subject]):
            made[subject] = float(number)
        elif number != made[subject] and not np.isnan(number):
            raise Error(f"the column '{name}' of the table of doses{at(line)} changes within the subject {subject!r}, "
                        f"from {made[subject]:g} to {number:g}: leave it out, and interpolate it in the model by "
                        "my.interpolate")
    return np.array([*made.values()])
