# SPDX-License-Identifier: MIT
"""What a table of doses adds to a model: stops at the times of its rows, at which states get doses and covariates other
values."""

from __future__ import annotations

import copy
from collections.abc import Callable, Mapping, Sequence
from functools import reduce
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..base import component_kinds as kinds
from ..base.errors import Error, at, users_line
from ..symbolic import symbols as sym
from ..symbolic.expression import abs as absolute, floor, make, to_real
from ..symbolic.folding import add, constant, multiply
from ..symbolic.functions import maximum, where
from ..symbolic.node import symbols_of
from ..symbolic.table import Table
from .any_model import names_of
from .event import Stop

if TYPE_CHECKING:
    from ..symbolic.types import Array

#: The number of an instance's record, in all tables of a model.
subject = sym.parameter("subject")
#: What is done at a dose before a steady state, and at its own: keep the states, keep them a second time, judge the
#: change.
first_of_all, halfway, in_steady_state = 1.0, 2.0, 3.0
#: How much states may change in the second half of the doses before a steady state, relative to their change in all of
#: them, or to their values. What is left falls by the same factor again, as each half has as many intervals.
most_change = 1e-3


class Dose(NamedTuple):
    """When it begins and ends, the amount that is given at once, the rate of an infusion, and what else is done."""

    begin: float
    end: float
    amount: float
    rate: float
    mark: float = 0.0


class _RowsOfRecords:
    """Rows of numbers, a time first, of several records, in one table: those of each in ascending order, one record
    after the other."""

    def __init__(self, name: str, of_records: Sequence[Array]) -> None:
        lengths = [len(rows) for rows in of_records]
        rows = _padded(np.concatenate(of_records), 0.0)
        self.table = Table(sym.check_name(name, "a table"), rows)
        # the row of each record's first, and behind it the next one's; below zero where there is no such record
        self.firsts = Table(f"{name}_of", _padded(np.array([*np.cumsum([0, *lengths]), -1.0]), -1.0))
        self.halvings = max(lengths).bit_length()

    @property
    def range(self) -> tuple[Any, Any]:
        """The first row of the instance's record, and the one behind its last."""
        return tuple(make("lookup", (to_real(one),), (self.firsts, 0, 1, len(self.firsts)))
                     for one in (subject, subject + 1.0))

    @property
    def has_record(self) -> Any:
        """Whether there is a record of the instance's number."""
        return (subject >= 0.0) & (floor(subject) == subject) & (self.range[1] >= 0.0)

    def entry(self, row: Any, column: int) -> Any:
        """A number of a row."""
        return make("lookup", (row,), (self.table, column, self.table.shape[1], len(self.table)))

    def last_until_now(self, late: Any, without_now: Any = None) -> tuple[Any, Any]:
        """The last row whose time, and `late`, is over, found by bisection: the one before the first where there is
        none; and the first row. A row whose time is now counts, but where the condition `without_now` holds."""
        first, end = self.range
        row = first - 1.0
        for step in (2.0 ** k for k in reversed(range(self.halvings))):
            time = add(self.entry(row + step, 0), late)
            is_over = time <= sym.time if without_now is None else (time < sym.time) | (
                (time == sym.time) & ~without_now)
            row = row + where((row + step < end) & is_over, step, 0.0)
        return row, first

    def stop(self, late: Any, name: str, do: Callable[[Any], dict[Any, Any]], line: tuple[str, int] | None) -> Stop:
        """The stop at the times of the rows, after `late`; what is done there is a function of the row."""
        first, end = self.range
        row = first + sym.stop_number
        made = Stop([where(row < end, add(self.entry(row, 0), late), np.inf)], None, None, name, do(row))
        made.line = line
        return made


def _padded(rows: Array, value: float) -> Array:
    """As many rows as the next power of two: generated code has the length of a table, but not its values."""
    missing = (1 << (len(rows) - 1).bit_length()) - len(rows) if len(rows) else 1
    return np.pad(np.asarray(rows, float), [(0, missing), *[(0, 0)] * (rows.ndim - 1)], constant_values=value)


class TabledDoses:
    """What one state gets by a table."""

    def __init__(self, name: str, of_records: Sequence[Sequence[Dose]], lag: Any, bioavailability: Any) -> None:
        self.into, self.lag, self.bioavailability, self.line = name, lag, bioavailability, users_line()
        self.is_infusion = any(one.rate > 0 for several in of_records for one in several)
        self.is_steady = any(one.mark > 0 for several in of_records for one in several)
        self.rows = _RowsOfRecords(f"{name}_doses", [_rows_of(several)[:, :4 if self.is_steady else 3]
                                                     for several in of_records])
        self.rate = sym.accessory(f"{name}_infused")
        self.hidden: set[str] = {self.rate.value[1]} if self.is_infusion else set()

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

    def stops(self, target: Any, free_name: Callable[[str], str], states: Sequence[Any]) -> list[Stop]:
        """The stop at which the state gets what is given at once, and the rate of infusions changes. Of doses in a
        steady state those before it are given too; where the states do not settle, or those doses are not within the
        time domain, this one becomes infinite."""
        kept = [[sym.accessory(free_name(f"{one.value[1]}_{when}")) for when in ("first", "half")]
                for one in states] if self.is_steady else []
        times_kept: Any = sym.accessory(free_name(f"{target.value[1]}_kept")) if self.is_steady else None
        self.hidden |= {one.value[1] for one in (times_kept, *(one for pair in kept for one in pair)) if self.is_steady}

        def do(row: Any) -> dict[Any, Any]:
            after = target + multiply(self.bioavailability, self.rows.entry(row, 1))
            done = {self.rate: self.rows.entry(row, 2)} if self.is_infusion else {}
            if self.is_steady:
                mark = self.rows.entry(row, 3)
                is_second = (mark == halfway) & (times_kept == 1.0)
                done[times_kept] = where(mark == first_of_all, 1.0, where(is_second, 2.0, times_kept))
                for state, (first, half) in zip(states, kept):
                    done |= {first: where(mark == first_of_all, state, first),
                             half: where(mark == halfway, state, half)}
                is_steady = (times_kept == 2.0) & _have_settled(states, kept)
                after = where((mark == in_steady_state) & ~is_steady, np.inf, after)
            return {target: after, **done}

        return [self.rows.stop(self.lag, free_name(f"{target.value[1]}_dose"), do, self.line)]

    def inflow(self) -> Any:
        """What infusions add to the derivative of the state."""
        return self.rate if self.is_infusion else constant(0.0)

    def at_start(self, target: Any, known: Mapping[Any, Any]) -> dict[Any, Any]:
        """What is assigned at the start of a phase, where others are known: the rate of the infusions that are under
        way, which the last row until then has. Where there is no record of the instance's number, the state becomes
        infinite."""
        made = {target: where(self.rows.has_record, known.get(target, target), np.inf)}
        if self.is_infusion:
            row, first = self.rows.last_until_now(self.lag)
            made[self.rate] = where(row < first, 0.0, self.rows.entry(row, 2))
        return made


class TabledCovariates:
    """Accessories that have the values of a table's rows, each from its time on."""

    into = None  # no state gets them
    is_infusion = False

    def __init__(self, accessories: Sequence[Any], of_records: Sequence[Array], is_backward: bool) -> None:
        self.accessories, self.is_backward, self.line = accessories, is_backward, users_line()
        self.rows = _RowsOfRecords(f"{accessories[0].value[1]}_over_time", of_records)
        self.hidden: set[str] = set()
        self.values = [subject]

    def read(self, expression: Callable[[Any, str], Any]) -> TabledCovariates:
        """The same, which has no expressions of the user's."""
        return self

    def stops(self, target: Any, free_name: Callable[[str], str], states: Sequence[Any]) -> list[Stop]:
        """The stop at which they change: before doses at its time, or backwards after them, so that a dose has what
        holds in its own row."""
        made = self.rows.stop(constant(0.0), free_name("covariates"), self._entries, self.line)
        made.order = 2 if self.is_backward else 0
        return [made]

    def inflow(self) -> Any:
        """What they add to the derivative of a state: nothing."""
        return constant(0.0)

    def at_start(self, target: Any, known: Mapping[Any, Any]) -> dict[Any, Any]:
        """What is assigned at the start of a phase, where others are known: what they are by then, or, before the
        first row, what they are in that. Backwards, a row at the begin holds for the doses there, and the stop comes
        after them; in a later phase it was at the end of the one before. Where there is no record of the instance's
        number, a state becomes infinite."""
        row, first = self.rows.last_until_now(constant(0.0), sym.phase == 0 if self.is_backward else None)
        started = where(self.rows.has_record, known.get(target, target), np.inf)
        return {target: started, **self._entries(maximum(row, first))}

    def _entries(self, row: Any) -> dict[Any, Any]:
        return {one: self.rows.entry(row, column) for column, one in enumerate(self.accessories, 1)}


def refuse_misfits(parts: Sequence[Any], model: Any, has_table: bool) -> None:
    """Refuses what tables name that a model does not have, or has for something else."""
    tabled = [part for part in parts if isinstance(part, (TabledDoses, TabledCovariates))]
    if tabled and not has_table and subject.value[1] in model.component_names:
        raise Error(f"the model {model.name} has a component 'subject'{at(tabled[0].line)}, which a table of doses "
                    "needs for the number of its record: rename it in the model")
    read = {symbol.value for part in parts for symbol in symbols_of(part.values)}
    known = {value for value in read if value[0] in kinds.accessories} | {
        (kind, name) for kind in kinds.accessories for name in names_of(model)[kind]}
    for part in tabled:
        for one in part.accessories if isinstance(part, TabledCovariates) else ():
            if one.value not in known:
                raise Error(f"over_time has {one.value[1]}{at(part.line)}, which is no accessory of the model "
                            f"{model.name}: name one that it reads")
    _refuse_lags_that_change(parts, model)


def _refuse_lags_that_change(parts: Sequence[Any], model: Any) -> None:
    """Refuses lags that depend on covariates over time, and those of tables that depend on what actions change: stops
    have the times that follow from the values of now."""
    over_time = {one.value for part in parts if isinstance(part, TabledCovariates) for one in part.accessories}
    acted = {target.value for one in (*model.events, *model.stops, *model.triggers) for target, _ in one.do}
    acted |= over_time | {target.value for target, _ in model.after_step}
    late = [(part.line, [part.lag], acted if isinstance(part, TabledDoses) else over_time) for part in parts
            if not isinstance(part, TabledCovariates)]
    late += [(one.line, one.times, acted) for one in model.stops if one.by_number]  # of tables that were added before
    for line, values, changing in late:
        moved = next((symbol.value[1] for symbol in symbols_of(values) if symbol.value in changing), None)
        if moved is not None:
            raise Error(f"the lag of doses{at(line)} depends on {moved}, which changes over time, so that doses would "
                        "be lost or come twice: let it depend on parameters, or write later times")


def _rows_of(several: Sequence[Dose]) -> Array:
    """The rows of a record: times, amounts, rates from then on, and marks."""
    doses = np.array(several, float).reshape(-1, len(Dose._fields))
    begin, end, amount, rate, mark = doses[np.argsort(doses[:, 0], kind="stable")].T
    is_infusion = rate > 0
    begins, ends, rates = begin[is_infusion], end[is_infusion], rate[is_infusion]
    times, nothing = np.concatenate([begin, ends]), np.zeros(len(ends))
    at_each = ((begins <= times[:, None]) & (times[:, None] < ends)) @ rates
    rows = np.column_stack([times, np.concatenate([amount, nothing]), at_each, np.concatenate([mark, nothing])])
    return rows[np.argsort(times, kind="stable")]


def _have_settled(states: Sequence[Any], kept: Sequence[Sequence[Any]]) -> Any:
    """Whether all states have changed by little since they were kept for the second time."""
    return reduce(lambda one, other: one & other, [
        absolute(state - half) <= most_change * maximum(absolute(state - first), absolute(state))
        for state, (first, half) in zip(states, kept)])
