# SPDX-License-Identifier: MIT
"""Doses from a table with a row for each, as programs of pharmacometrics have them: other times and amounts for each
subject. The columns have the names and meanings that they have in NONMEM's data."""

from __future__ import annotations

import copy
import csv
import os
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.errors import Error, at, users_line
from ..symbolic import symbols as sym
from ..symbolic.expression import make, to_real
from ..symbolic.folding import add, constant, multiply
from ..symbolic.functions import where
from ..symbolic.table import Table
from .components import name_of
from .event import Stop

if TYPE_CHECKING:
    from ..symbolic.types import Array, Component, Path, Written

__all__ = ["dose_table"]

#: The number of an instance's subject, in all tables of a model.
subject = sym.parameter("subject")
_Dose = tuple[float, float, float, float]
_columns = ("id", "time", "amt", "evid", "cmt", "rate", "dur", "ii", "addl", "ss", "dv", "mdv")


class TabledDoses:
    """What one state gets by a table. Its rows are time, amount, and rate of infusions from then on; those of one
    subject follow each other."""

    def __init__(self, name: str, of_subjects: list[Array], lag: Any, bioavailability: Any) -> None:
        self.into, self.lag, self.bioavailability, self.line = name, lag, bioavailability, users_line()
        lengths = [len(rows) for rows in of_subjects]
        rows = _padded(np.concatenate(of_subjects), 0.0)
        self.table = Table(sym.check_name(f"{name}_doses", "a table"), rows)
        firsts = np.cumsum([0, *lengths])  # the row of each subject's first, and behind it the next one's
        self.firsts = Table(f"{name}_doses_of", _padded(firsts, firsts[-1]))
        self.halvings = max(lengths).bit_length()
        self.rate = sym.accessory(f"{name}_infused")
        self.is_infusion = bool((rows[:, 2] > 0).any())

    @property
    def values(self) -> list[Any]:
        """All expressions of it."""
        return [self.lag, self.bioavailability, subject]

    def read(self, expression: Callable[[Any, str], Any]) -> TabledDoses:
        """The same with expressions in place of texts and numbers."""
        made = copy.copy(self)
        made.lag = expression(self.lag, "the lag of doses")
        made.bioavailability = expression(self.bioavailability, "the bioavailability of doses")
        return made

    def stops(self, target: Any, free_name: Callable[[str], str]) -> list[Stop]:
        """The stop at which the state gets what is given at once, and the rate of infusions changes."""
        first, end = self._range
        row = first + sym.stop_number
        do = {target: target + multiply(self.bioavailability, self._entry(row, 1))}
        if self.is_infusion:
            do[self.rate] = self._entry(row, 2)
        made = Stop([where(row < end, self._time(row), np.inf)], None, None, free_name(f"{target.value[1]}_dose"), do)
        made.line = self.line
        return [made]

    def inflow(self) -> Any:
        """What infusions add to the derivative of the state."""
        return self.rate if self.is_infusion else constant(0.0)

    def at_start(self) -> dict[Any, Any]:
        """What is assigned at the start of a phase: the rate of the infusions that are under way, which the last row
        until then has. It is found by bisection."""
        if not self.is_infusion:
            return {}
        first, end = self._range
        row = first - 1.0
        for step in (2.0 ** k for k in reversed(range(self.halvings))):
            row = row + where((row + step < end) & (self._time(row + step) <= sym.time), step, 0.0)
        return {self.rate: where(row < first, 0.0, self._entry(row, 2))}

    @property
    def _range(self) -> tuple[Any, Any]:
        """The first row of the subject, and the one behind its last."""
        return tuple(make("lookup", (to_real(one),), (self.firsts, 0, 1, len(self.firsts)))
                     for one in (subject, subject + 1.0))

    def _entry(self, row: Any, column: int) -> Any:
        return make("lookup", (row,), (self.table, column, 3, len(self.table)))

    def _time(self, row: Any) -> Any:
        return add(self._entry(row, 0), self.lag)


def _padded(rows: Array, value: float) -> Array:
    """As many rows as the next power of two: generated code has the length of a table, but not its values."""
    missing = (1 << (len(rows) - 1).bit_length()) - len(rows) if len(rows) else 1
    return np.pad(np.asarray(rows, float), [(0, missing), *[(0, 0)] * (rows.ndim - 1)], constant_values=value)


class DoseTable:
    """Doses by subject. Made by `my.dose_table`; for `model.with_doses`."""

    #: the ids of the subjects, in the order of the instances
    ids: list[Any]
    #: a part of the sweep: values of the parameter `subject`, the number of an instance's subject, counted from 0
    sweep: dict[Any, Array]
    #: first and last time of each subject, for `time=`
    time: tuple[Array, Array]
    #: by name in small letters, a value for each subject: what other columns have
    covariates: dict[str, Array]
    #: times and values of observations, a row for each subject, NaN where it has fewer than others
    observed_times: Array
    observed: Array

    def __init__(self, parts: list[TabledDoses], ids: list[Any]) -> None:
        self.parts, self.ids = parts, ids
        self.sweep = {subject: np.arange(len(ids), dtype=float)} if parts else {}

    def __repr__(self) -> str:
        states = " and ".join(part.into for part in self.parts) or "no state"
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
    The sweep has one parameter, `subject`, which may also be an axis of `my.grid`. Doses before the begin of the time
    domain are not given, and infusions that are under way there go on. Raises `my.Error`, with the number of the row,
    where a value cannot be read or stands for what is not supported: a steady state (ss), a reset (evid 3 and 4), and
    rates that parameters decide (below zero).
    """
    line, states = users_line(), _states(into)
    columns = _read(data, line)
    values = {name: _numbers(name, columns[name], line, "give a number").tolist() for name in _columns
              if name in columns and name not in ("id", "cmt")}
    ids = columns.get("id", ["1"] * len(columns["time"]))
    rows = _Rows(ids, states)
    for i, subject in enumerate(ids):
        row = {name: values[name][i] if name in values else np.nan for name in _columns}
        rows.add(subject, row, columns["cmt"][i] if "cmt" in columns else None,
                 f"row {i + 1} of the table of doses{at(line)}")
    parts = [TabledDoses(state, [_rows_of(several) for several in rows.given[state].values()], lag, bioavailability)
             for state in rows.given if any(rows.given[state].values())]
    if any(part.is_infusion for part in parts) and not (isinstance(bioavailability, (int, float))
                                                        and bioavailability == 1):
        raise Error(f"a table with infusions has the bioavailability {bioavailability!r}{at(line)}, which would change "
                    "how long they take: write my.doses for each")
    made = DoseTable(parts, list(rows.begin))
    made.time = np.array([*rows.begin.values()]), np.array([*rows.end.values()])
    made.covariates = {name: _constant(name, of_column, ids, line) for name, of_column in columns.items()
                       if name not in _columns}
    made.observed_times, made.observed = rows.observed()
    return made


class _Rows:
    """What the rows of a table say of each subject, in the order in which subjects come."""

    def __init__(self, ids: list[Any], states: Mapping[Any, str]) -> None:
        order = dict.fromkeys(ids)
        self.states = states  #: by key
        #: begin, end, amount at once and rate of the doses, by state and subject
        self.given: dict[str, dict[Any, list[_Dose]]] = {state: {one: [] for one in order} for state in states.values()}
        self.seen: dict[Any, list[tuple[float, float]]] = {one: [] for one in order}
        self.begin: dict[Any, float] = dict.fromkeys(order, np.inf)
        self.end: dict[Any, float] = dict.fromkeys(order, -np.inf)

    def add(self, subject: Any, row: Mapping[str, float], compartment: Any, where_it_is: str) -> None:
        """Takes a row, or refuses it."""
        time, last = row["time"], self.end[subject]
        if _is_missing(subject):
            raise Error(f"{where_it_is} has no id: give the subject")
        if not np.isfinite(time):
            raise Error(f"{where_it_is} has the time {time}: give a finite number")
        if time < last:
            raise Error(f"{where_it_is} has the time {time} after {last}: sort the rows of each subject by time")
        self.begin[subject], self.end[subject] = min(self.begin[subject], time), time
        if _is_dose(row, where_it_is):
            self.given[_state_of(compartment, self.states, where_it_is)][subject] += _doses_of(row, where_it_is)
        elif row["evid"] != 2 and row["mdv"] != 1 and not np.isnan(row["dv"]):
            self.seen[subject].append((time, row["dv"]))

    def observed(self) -> tuple[Array, Array]:
        """Times and values of the observations, a row for each subject."""
        most = max(map(len, self.seen.values()))
        padded = np.array([[*several, *[(np.nan, np.nan)] * (most - len(several))] for several in self.seen.values()]
                          ).reshape(len(self.seen), most, 2)
        return padded[..., 0], padded[..., 1]


def _states(into: Any) -> dict[Any, str]:
    """The names of the states by what a table calls them, or one for all rows, by None."""
    if not isinstance(into, Mapping):
        into = {None: into}
    if not into or any(isinstance(state, (list, tuple)) for state in into.values()):
        raise Error(f"the states of a table of doses are {next(iter(into.values()), into)!r}{at(users_line())}: give "
                    "one state, or a dict {cmt: state}")
    return {_key(given): name_of(state) for given, state in into.items()}


def _key(given: Any) -> Any:
    """What is in the column cmt, or a key of `into`: as a number where it is one, also as a text."""
    try:
        return float(given)
    except (TypeError, ValueError):
        return None if given is None else str(given).strip()


def _read(data: Any, line: tuple[str, int] | None) -> dict[str, list[Any]]:
    """The columns of a table, by name in small letters."""
    if isinstance(data, (str, os.PathLike)):
        try:
            with open(data, encoding="utf-8-sig", newline="") as file:
                read = csv.DictReader(file, skipinitialspace=True)
                rows = list(read)
        except OSError as why:
            raise Error(f"{os.fspath(data)!r} cannot be read{at(line)}: {why.strerror or why}") from None
        data = {name: [row[name] for row in rows] for name in read.fieldnames or ()}
    if hasattr(data, "notna"):  # pandas, which has several kinds of missing values
        data = data.astype(object).where(data.notna(), None)
    try:
        columns = [(str(name).strip().lower(), list(data[name])) for name in getattr(data, "columns", data)]
    except TypeError:
        raise Error(f"the table of doses is no table{at(line)}: give a data frame, a dict with a list for each column, "
                    "or the path of a CSV file") from None
    made, lengths = dict(columns), {len(of_column) for _, of_column in columns}
    names = ", ".join(name for name, _ in columns) or "none"
    for name in ("time", "amt"):
        if name not in made:
            raise Error(f"the table of doses has no column '{name}'{at(line)}: it has {names}")
    if len(made) < len(columns):
        raise Error(f"the table of doses has two columns of one name{at(line)}, {names}, where case does not count: "
                    "rename one of them")
    if len(lengths) > 1 or not max(lengths):
        raise Error(f"the columns of the table of doses have {' or '.join(map(str, sorted(lengths)))} rows{at(line)}: "
                    "give as many for each, and one or more")
    return made


def _is_missing(given: Any) -> bool:
    if isinstance(given, str):
        return given.strip().lower() in ("", ".", "na", "nan")
    return given is None or isinstance(given, (float, np.floating)) and bool(np.isnan(given))


def _numbers(name: str, given: list[Any], line: tuple[str, int] | None, cure: str) -> Array:
    made = np.empty(len(given))
    for row, one in enumerate(given):
        try:
            made[row] = np.nan if _is_missing(one) else float(one)
        except (TypeError, ValueError):
            raise Error(f"row {row + 1} of the table of doses{at(line)} has {one!r} in the column '{name}': {cure}"
                        ) from None
    return made


def _is_dose(row: Mapping[str, float], where_it_is: str) -> bool:
    has_amount = not np.isnan(row["amt"]) and row["amt"] != 0
    evid = row["evid"] if not np.isnan(row["evid"]) else float(has_amount)
    if evid not in (0, 1, 2):
        what = ", a reset: give what follows another id" if evid in (3, 4) else ": 0, 1 and 2 are known"
        raise Error(f"{where_it_is} has evid {evid:g}{what}")
    if evid == 1 and not 0 < row["amt"] < np.inf:
        raise Error(f"{where_it_is} is a dose of {row['amt']:g}: give an amount above zero, or evid 0")
    return evid == 1


def _state_of(given: Any, states: Mapping[Any, str], where_it_is: str) -> str:
    """Which of the states gets a dose."""
    key = None if None in states else _key(given)
    if key not in states:
        known = ", ".join(f"{one:g}" if isinstance(one, float) else repr(one) for one in states)
        raise Error(f"{where_it_is} has cmt {given!r}: `into` has {known}")
    return states[key]


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
    if np.inf in (rate, duration, interval):
        raise Error(f"{where_it_is} has an infinite rate, dur or ii: give finite numbers, 0 for a dose at once")
    if more < 0 or not more.is_integer():
        raise Error(f"{where_it_is} has addl {more:g}: give the number of further doses, 0 or more")
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
    infusions = [(begin, end, rate) for begin, end, _, rate in several if rate > 0]
    happening = sorted([(begin, amount) for begin, _, amount, _ in several] + [(end, 0.0) for _, end, _ in infusions],
                       key=lambda one: one[0])
    return np.array([(time, amount, sum(rate for begin, end, rate in infusions if begin <= time < end))
                     for time, amount in happening]).reshape(-1, 3)


def _constant(name: str, given: list[Any], ids: list[Any], line: tuple[str, int] | None) -> Array:
    """A covariate of each subject."""
    made: dict[Any, float] = dict.fromkeys(ids, np.nan)
    for subject, number in zip(ids, _numbers(name, given, line, "give a number, or leave the column out")):
        if np.isnan(made[subject]):
            made[subject] = float(number)
        elif number != made[subject] and not np.isnan(number):
            raise Error(f"the column '{name}' of the table of doses{at(line)} changes within the subject {subject!r}, "
                        f"from {made[subject]:g} to {number:g}: leave it out, and interpolate it in the model by "
                        "my.interpolate")
    return np.array([*made.values()])
