# SPDX-License-Identifier: MIT
"""Doses from a table with a row for each, as programs of pharmacometrics have them: other times and amounts for each
subject. The columns have the names and meanings that they have in NONMEM's data."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from ..base.data_table import DataTable, is_missing
from ..base.errors import Error, at, users_line
from ..symbolic import symbols as sym
from ..symbolic.node import Node
from ..symbolic.numbers import is_whole
from .components import name_of
from .tabled_doses import Dose, TabledCovariates, TabledDoses, first_of_all, halfway, in_steady_state, subject

if TYPE_CHECKING:
    from ..symbolic.types import Array, Component, Path, Written

__all__ = ["dose_table"]

#: How much later than its row an observation is that stands below a dose at its time, relative to the record.
just_after = 1e-12
_columns = ("id", "time", "amt", "evid", "cmt", "rate", "dur", "ii", "addl", "ss", "dv", "mdv")


class DoseTable:
    """Doses by record: the rows of a subject from its first one on, or from a reset or a steady state. Made by
    `my.dose_table`; for `model.with_doses`."""

    #: the ids of the records' subjects, in the order of the instances
    ids: list[Any]
    #: the number of each record's subject, counted from 0
    of_subject: Array
    #: a part of the sweep: values of the parameter `subject`, the number of an instance's record, counted from 0
    sweep: dict[Any, Array]
    #: begin and end of each record, for `time=`; doses before a steady state come before its first row
    time: tuple[Array, Array]
    #: the time of each record's first row
    first: Array
    #: by name in small letters, a value for each record: what other columns have
    covariates: dict[str, Array]
    #: times and values of observations, a row for each record, NaN where it has fewer than others
    observed_times: Array
    observed: Array

    def __init__(self, parts: Sequence[TabledDoses | TabledCovariates], records: Sequence[_Record]) -> None:
        self.parts, self.ids = parts, [one.subject for one in records]
        numbers = {one: i for i, one in enumerate(dict.fromkeys(self.ids))}
        self.of_subject = np.array([numbers[one] for one in self.ids])
        self.sweep = {subject: np.arange(len(records), dtype=float)} if parts else {}
        self.first = np.array([one.first for one in records])
        self.time = np.array([one.begin for one in records]), np.array([one.end for one in records])
        most = max(len(one.seen) for one in records)
        padded = np.array([[*one.seen, *[(np.nan, np.nan, 0)] * (most - len(one.seen))] for one in records], float
                          ).reshape(len(records), most, 3)
        self.observed_times, self.observed = padded[..., 0], padded[..., 1]

    def __repr__(self) -> str:
        states = " and ".join(part.into for part in self.parts if part.into is not None) or "no state"
        return f"doses into {states} of {len(set(self.of_subject))} subjects"

    @property
    def names(self) -> list[str]:
        """A name of each record: its subject's id, with the time of its first row where a subject has several, and a
        number where several begin at one time."""
        made: list[Any] = [f"{one} from {first:g}" if self.ids.count(one) > 1 else one
                           for one, first in zip(self.ids, self.first)]
        return [f"{one}, {1 + made[:i].count(one)}" if one in made[:i] else one for i, one in enumerate(made)]


def _check_infusions(bioavailability: Written, parts: Iterable[TabledDoses]) -> None:
    """Refuses a bioavailability of infusions, whose amounts it would change by an unknown time."""
    is_one = isinstance(bioavailability, (int, float)) and bioavailability == 1
    if not is_one and any(part.is_infusion for part in parts):
        raise Error(f"a table with infusions has the bioavailability {bioavailability!r}{at(users_line())}, which "
                    "would change how long they take: write my.doses for each")


def dose_table(data: Mapping[str, Any] | Path, into: Component | Mapping[Any, Component], *, lag: Written = 0.0,
               bioavailability: Written = 1.0, over_time: Mapping[Any, str] | None = None,
               carried: Literal["forward", "backward"] = "forward", steady_after: int = 100) -> DoseTable:
    """Doses for `model.with_doses` from a table: of pandas or polars, a dict of columns, or the path of a CSV file.

    A row is a dose, or an observation, of a subject. The columns, in any order and case, with NONMEM's meanings:

    id          the subject; each is an instance, in the order in which they come; without it there is one
    time        in the model's unit; does not decrease within a subject, but at a reset
    amt         the amount, in the unit of the state
    evid        1 for a dose, 0 for an observation, 2 for neither, 3 for a reset, 4 for a reset and a dose; by default a
                row with an amount is a dose
    cmt         which state gets it: a key of `into`; not needed where `into` is one state
    rate, dur   of an infusion: amount by time, or how long it takes; 0 for a dose at once
    addl, ii    so many more doses, at intervals of ii
    ss          1 for a dose in the steady state of such doses at intervals of ii, which replaces what was before
    dv, mdv     what was observed, unless mdv is 1

    An observation that stands below a dose at its time sees it, one above does not. So its time in `observed_times` is
    later by 1e-12 of the record's length, or of the time where that is more, which single precision does not resolve:
    leave out precision="float" there. What addl or a lag brings to the time of an observation comes after it.

    What follows a reset, or begins with a steady state, depends on nothing before it, and is a record of its own: an
    instance with the same id, which begins with the values of `start=`. Other columns are covariates, numbers that do
    not change within a subject. A missing value is empty, "." or NaN.

    lag, bioavailability  as in `my.doses`; they hold for all rows
    over_time     accessories of the model that have the values of columns, `{weight: "WT"}`, which may change; a dose
                  has the bioavailability of its own row, later ones by lag or addl that of when they come; a lag may
                  not depend on them
    carried       whether these hold from their row on, "forward", or up to it from the row before, "backward", as in
                  NONMEM's own programs; a missing one is the last before it, or else the first
    steady_after  how many doses are given before a steady state. Where a state has not settled by then, so that more
                  than about 1e-6 of its change is left, or where the time domain begins after the first of these
                  doses, the instance ends as "not_finite"

    The result has what `solve` needs: `my.solve(model.with_doses(records), {**records.sweep, ...}, time=records.time)`.
    The sweep has one parameter, `subject`, the number of a record, counted from 0 and not its id, which may also be an
    axis of `my.grid`; with a number that no record has, an instance ends as "not_finite". Doses before the begin of the
    time domain are not given, and infusions that are under way there go on. Raises `my.Error`, with the number of the
    row, for what cannot be read or is not supported: sums of steady states (ss 2), constant infusions in a steady
    state (an amount of 0), and rates that parameters decide (below zero).
    """
    states, columns = _states(into), DataTable(data, "the table of doses", any_case=True)
    if not is_whole(steady_after, 5):
        raise Error(f"steady_after is {steady_after!r}{at(users_line())}: give the number of doses before a steady "
                    "state, 5 or more")
    changing = {_accessory(key): str(name).strip().lower() for key, name in (over_time or {}).items()}
    records, of_row = _records_of(columns, states, int(steady_after))
    parts: list[Any] = [TabledDoses(state, [one.given[state] for one in records], lag, bioavailability)
                        for state in dict.fromkeys(states.values()) if any(one.given[state] for one in records)]
    _check_infusions(bioavailability, parts)
    if changing:
        parts.append(TabledCovariates([*changing], _over_time(columns, [*changing.values()], records, of_row, carried),
                                      carried == "backward"))
    made = DoseTable(parts, records)
    made.covariates = {name: _constant(name, columns, records, of_row) for name in columns.names
                       if name not in (*_columns, *changing.values())}
    return made


class _Record:
    """What the rows of a subject say, from its first one on, or from a reset or a steady state."""

    def __init__(self, subject: Any, states: Mapping[Any, str]) -> None:
        self.subject = subject
        self.given: dict[str, list[Dose]] = {state: [] for state in states.values()}
        self.seen: list[tuple[float, float, bool]] = []  # times, values, and whether a dose at the time is above
        self.begin = self.first = np.inf
        self.end = self.last_given = -np.inf

    def add(self, row: Mapping[str, float], evid: int, state: str | None, steady_after: int, where_it_is: str) -> None:
        """Takes a row, or refuses it."""
        time = row["time"]
        if time < self.end:
            raise Error(f"{where_it_is} has the time {time} after {self.end}: sort the rows of each subject by time")
        self.first, self.end = min(self.first, time), time
        self.begin = min(self.begin, time)
        if state is not None:
            if self.seen and self.seen[-1][0] == time and self.seen[-1][2]:
                raise Error(f"{where_it_is} is a dose below an observation that has another dose above it, all at the "
                            f"time {time:g}: give one of the doses a time that differs a little")
            doses = _doses_of(row, steady_after, where_it_is)
            self.given[state] += doses
            self.last_given = time
            self.begin = min(self.begin, doses[0].begin)
        elif evid == 0 and row["mdv"] != 1 and not np.isnan(row["dv"]):
            self.seen.append((time, row["dv"], time == self.last_given))

    def finish(self) -> None:
        """Lets observations that stand below a dose at their time come a little later, so that they see it."""
        for i, (time, value, is_after) in enumerate(self.seen):
            if is_after:
                time += just_after * (max(abs(time), self.end - self.begin) or 1.0)
            self.seen[i] = time, value, is_after
        self.end = max([self.end, *(time for time, _, _ in self.seen)])


def _records_of(columns: DataTable, states: Mapping[Any, str], steady_after: int) -> tuple[list[_Record], list[int]]:
    """The records of all subjects, those of each together, and the number of each row's record."""
    values = {name: columns.numbers(name, cure="give a number").tolist() for name in _columns
              if name in ("time", "amt") or name in columns and name not in ("id", "cmt")}
    ids = columns.cells("id") if "id" in columns else ["1"] * columns.length
    compartments = columns.cells("cmt") if "cmt" in columns else [None] * columns.length
    of_subject: dict[Any, list[_Record]] = {}
    rows = []
    for i, one in enumerate(ids):
        row, where_it_is = {name: values[name][i] if name in values else np.nan for name in _columns}, columns.row(i)
        if is_missing(one):
            raise Error(f"{where_it_is} has no id: give the subject")
        if not np.isfinite(row["time"]):
            raise Error(f"{where_it_is} has the time {row['time']}: give a finite number")
        evid = _evid_of(row, where_it_is)
        several = of_subject.setdefault(one, [])
        if not several or evid in (3, 4) or evid == 1 and row["ss"] > 0:
            if not several or np.isfinite(several[-1].first):
                several.append(_Record(one, states))
        state = _state_of(compartments[i], states, where_it_is) if evid in (1, 4) else None
        several[-1].add(row, evid, state, steady_after, where_it_is)
        rows.append(several[-1])
    records = [one for several in of_subject.values() for one in several]
    for one in records:
        one.finish()
    numbers = {id(one): number for number, one in enumerate(records)}
    return records, [numbers[id(one)] for one in rows]


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


def _evid_of(row: Mapping[str, float], where_it_is: str) -> int:
    """What a row is: 0 an observation, 1 a dose, 2 neither, 3 a reset, 4 a reset and a dose."""
    has_amount = not np.isnan(row["amt"]) and row["amt"] != 0
    evid = row["evid"] if not np.isnan(row["evid"]) else float(has_amount)
    if evid not in (0, 1, 2, 3, 4):
        raise Error(f"{where_it_is} has evid {evid:g}: 0 to 4 are known")
    if row["ss"] > 0 and row["rate"] > 0 and not has_amount:
        raise Error(f"{where_it_is} is a constant infusion in a steady state, with an amount of 0: give as the amount "
                    "the rate times ii, which is as much")
    if evid in (0, 2, 3) and has_amount:
        raise Error(f"{where_it_is} has evid {evid:g}, which is no dose, and the amount {row['amt']:g}: give evid 1, "
                    "or 4 with a reset, or no amount")
    if evid in (1, 4) and not 0 < row["amt"] < np.inf:
        raise Error(f"{where_it_is} is a dose of {row['amt']:g}: give an amount above zero, or evid 0 and no amount")
    return int(evid)


def _state_of(given: Any, states: Mapping[Any, str], where_it_is: str) -> str:
    """Which of the states gets a dose."""
    key = None if None in states else _key(given)
    if key not in states:
        known = ", ".join(f"{one:g}" if isinstance(one, float) else repr(one) for one in states)
        raise Error(f"{where_it_is} has cmt {given!r}: `into` has {known}")
    return states[key]


def _doses_of(row: Mapping[str, float], steady_after: int, where_it_is: str) -> list[Dose]:
    """The doses of a row, and those before it where it is one in a steady state."""
    rate, duration, more, interval, steady = (0.0 if np.isnan(row[name]) else row[name]
                                              for name in ("rate", "dur", "addl", "ii", "ss"))
    if steady not in (0, 1):
        what = (", a sum with the steady state of other doses, which only linear models have: give the doses before it "
                "as rows" if steady == 2 else ": 0 and 1 are known")
        raise Error(f"{where_it_is} has ss {steady:g}{what}")
    if rate < 0 or duration < 0:
        raise Error(f"{where_it_is} has the {'rate' if rate < 0 else 'duration'} {min(rate, duration):g}, below zero, "
                    "which parameters would decide: write it as my.doses(..., rate=) or duration=")
    if np.inf in (rate, duration, interval):
        raise Error(f"{where_it_is} has an infinite rate, dur or ii: give finite numbers, 0 for a dose at once")
    if more < 0 or not more.is_integer():
        raise Error(f"{where_it_is} has addl {more:g}: give the number of further doses, 0 or more")
    if (more > 0 or steady) and not interval > 0:
        what = f"addl {more:g}" if more > 0 else "ss 1"
        raise Error(f"{where_it_is} has {what} and ii {interval:g}: give the interval of doses in ii")
    if rate > 0 and duration > 0:
        raise Error(f"{where_it_is} has both rate and dur: give one of them")
    length = row["amt"] / rate if rate > 0 else duration
    rate = row["amt"] / length if length > 0 else 0.0
    before = steady_after if steady else 0
    marks = {before: first_of_all, before - before // 2: halfway, 0: in_steady_state} if before else {}
    return [Dose(begin := row["time"] + k * interval, begin + length, 0.0 if length > 0 else row["amt"], rate,
                 marks.get(-k, 0.0)) for k in range(-before, int(more) + 1)]


def _accessory(given: Any) -> Any:
    """The accessory of a key of over_time=."""
    if isinstance(given, str):
        return sym.accessory(given)
    if not (isinstance(given, Node) and given.op == "symbol" and given.value[0] == "accessory"):
        raise Error(f"over_time has {given!r}{at(users_line())}, which is no accessory: what changes within an "
                    "instance is one, as made by my.accessory(\"weight\")")
    return given


def _over_time(columns: DataTable, names: Sequence[str], records: Sequence[_Record], of_row: Sequence[int],
               carried: str) -> list[Array]:
    """The rows of covariates of each record: times, and values from then on."""
    if carried not in ("forward", "backward"):
        raise Error(f"carried is {carried!r}{at(users_line())}: give \"forward\" or \"backward\"")
    time = columns.numbers("time")
    cells = np.column_stack([columns.numbers(name, "over_time=", "give a number") for name in names])
    for one, rows in _by_subject(records, of_row).items():
        for column, name in enumerate(names):
            cells[rows, column] = _filled(cells[rows, column],
                                          f"the subject {one!r} of {columns.called} has nothing in the column '{name}'")
    made = []
    for number, record in enumerate(records):
        is_here = np.array(of_row) == number
        times, values = time[is_here], cells[is_here]
        if carried == "backward":  # what holds from a row on is what the next one has
            times, values = np.array([record.begin - 1.0, *times]), np.concatenate([values, values[-1:]])
        made.append(np.column_stack([times, values]))
    return made


def _by_subject(records: Sequence[_Record], of_row: Sequence[int]) -> dict[Any, list[int]]:
    """The numbers of each subject's rows."""
    found: dict[Any, list[int]] = {}
    for row, place in enumerate(of_row):
        found.setdefault(records[place].subject, []).append(row)
    return found


def _filled(cells: Array, refusal: str) -> Array:
    """Values with the last one before in the place of each that is missing, or else the first."""
    there = np.flatnonzero(~np.isnan(cells))
    if not there.size:
        raise Error(f"{refusal}: give a number in one of its rows")
    last = np.searchsorted(there, np.arange(len(cells)), side="right") - 1
    return cells[there[np.maximum(last, 0)]]


def _constant(name: str, columns: DataTable, records: Sequence[_Record], of_row: Sequence[int]) -> Array:
    """A covariate of each record, which is the same for all of a subject."""
    cells = columns.numbers(name, cure="give a number, or leave the column out")
    made: dict[Any, float] = {}
    for one, rows in _by_subject(records, of_row).items():
        there = cells[rows][~np.isnan(cells[rows])]
        if (there != there[:1]).any():
            raise Error(f"the column '{name}' of {columns.called} changes within the subject {one!r}, from "
                        f"{there[0]:g} to {there[there != there[0]][0]:g}: name it in over_time=, or leave it out")
        made[one] = there[0] if there.size else np.nan
    return np.array([made[record.subject] for record in records])
