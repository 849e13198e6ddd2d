# SPDX-License-Identifier: MIT
"""The search for attractors. All starts are integrated and grouped by features; a leader of each group goes on for
several times as long. Groups whose leaders stayed where they were are done, the others go on too. At last the leaders'
sets of points tell which groups have one attractor."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .clusters import Features, PointSet, distances, features_of, grouped, merged, path
from .kinds import (aperiodic, cycle, cycles_of_flow, equations_of_flow, exponents_of, fixed_point, kinds_by_exponents,
                    returns_of, steady_state_near)
from .orbits import Scale, on_host

if TYPE_CHECKING:
    from ..symbolic.types import Array
    from .orbits import Motion, Orbits
    from .starts import Starts
    from .steady_states import SteadyState

diverged, unsettled = -1, -2
_most_leaders = 512
_pilots = 64
_rounds, _longer = 3, 4  # in each, transients are so many times as long
_points_of_open = 2400  # of what does not return on a map


class Found(NamedTuple):
    """One attractor: its points by state, those of one cycle or many; and what `Attractor` says of it."""

    kind: str
    period: float
    returns: int
    exponent: float
    steady_state: SteadyState | None
    points: Array
    end: dict[str, float]


class _Reference(NamedTuple):
    """What a leader has come to, and whether it was there when its group was made; how many starts it leads."""

    set: PointSet
    found: Found
    is_settled: bool
    weight: int


class Search:
    """A search with its options; `run` returns attractors and the label of each start."""

    def __init__(self, motion: Motion, starts: Starts, transient: int, phases: int, tolerance: float,
                 exponents: bool | None, bound: float | None) -> None:
        self.motion, self.starts, self.transient, self.phases = motion, starts, transient, phases
        self.tolerance, self.exponents = tolerance, exponents
        largest = max((float(np.abs(of).max()) for name, of in starts.values.items() if name in motion.model.states),
                      default=1.0)
        self.bound = 1e9 * max(largest, 1.0) if bound is None else bound
        self.notes: list[str] = []
        self.status = np.zeros(starts.size, np.uint8)  # of the last run of each start
        self._references: list[_Reference] = []

    def run(self) -> tuple[list[Found], Array]:
        self.scale = self._scale()
        leader = np.full(self.starts.size, diverged)  # the number of a reference
        left, values, transient = np.arange(self.starts.size), dict(self.starts.values), self.transient
        for _ in range(_rounds):
            of, values, goes_on = self._turn(left, values, transient)
            leader[left] = of
            left, values = left[goes_on], {name: each[goes_on] for name, each in values.items()}
            transient = _longer * max(transient, 1)
            if not left.size:
                break
        found, label = self._merged(leader)
        if (count := int((label == unsettled).sum())):
            self.notes.append(f"{_starts(count)} not come to an attractor: give a longer transient=, or angles= "
                              "if states turn")
        found, label = self._without_saddles(self._with_exponents(found), label)
        return self._ordered(found, label)

    def _scale(self) -> Scale:
        """The scale of what is seen, from some starts that are spread over all."""
        values = self.starts.values
        order = np.lexsort([values[name] for name in sorted(values)])
        chosen = order[np.unique(np.linspace(0, len(order) - 1, min(_pilots, len(order))).astype(int))]
        orbits = self.motion.orbits({n: of[chosen] for n, of in values.items()}, 0, self.transient + self.phases)
        good = self._are_good(orbits)
        points, chosen = orbits.points[good], chosen[good]
        first = points.shape[1] * self.transient // (self.transient + self.phases)
        return Scale(self.motion, points, points[:, first:],
                     self.motion.least_extents({n: of[chosen] for n, of in values.items()}))

    def _are_good(self, orbits: Orbits) -> Array:
        """Which orbits have neither failed nor diverged."""
        well = ~orbits.failed
        for c, name in enumerate(self.motion.states):
            column = orbits.points[..., c]
            with np.errstate(invalid="ignore"):
                extent = np.maximum(column.max(axis=1), -column.min(axis=1))
                within = np.isfinite(extent) if name in self.motion.angles else extent <= self.bound
            well &= on_host(within)
        return well

    def _turn(self, numbers: Array, values: Mapping[str, Array],
              transient: int) -> tuple[Array, dict[str, Array], Array]:
        """Integrates starts with these numbers from where they are. Returns the reference of each, the states at the
        ends, and which have to go on."""
        features, ends, good = self._all(numbers, values, transient)
        leader, goes_on = np.full(len(numbers), diverged), np.zeros(len(numbers), bool)
        if not good.any():
            return leader, ends, goes_on
        places = self.scale(np.stack([ends[name][good] for name in self.motion.states], axis=1))
        leaders, group = grouped(Features(*(of[good] for of in features)), places, self.tolerance, _most_leaders)
        chosen = np.flatnonzero(good)[leaders]
        made, status = self._followed({name: of[chosen] for name, of in ends.items()}, transient,
                                      np.bincount(group + 1, minlength=len(leaders) + 1)[1:])
        first = len(self._references)
        self._references += [one for one in made if one is not None]
        number = np.array([diverged if one is None else 0 for one in made] + [unsettled])
        number[np.flatnonzero(number == 0)] = first + np.arange((number == 0).sum())
        is_settled = np.array([one is None or one.is_settled for one in made] + [False])
        leader[good], goes_on[good] = number[group], ~is_settled[group]
        lost = np.flatnonzero(good)[number[group] == diverged]
        self.status[numbers[lost]] = status[group[number[group] == diverged]]
        alone = np.flatnonzero(group < 0)
        if alone.size:  # there are more groups than may lead
            near = self._nearest(places[alone], first)
            rest = np.flatnonzero(good)[alone]
            leader[rest], goes_on[rest] = near, near == unsettled
        return leader, ends, goes_on

    def _all(self, numbers: Array, values: Mapping[str, Array],
             transient: int) -> tuple[Features, dict[str, Array], Array]:
        """Features and ends of orbits, and which of these are good."""
        parts, ends, good = [], [], []
        for part in self.motion.chunks(len(numbers), self.phases):
            orbits = self.motion.orbits({n: of[part] for n, of in values.items()}, transient, self.phases, stay=True)
            well = self._are_good(orbits)
            self.status[numbers[part]] = orbits.status
            points = orbits.points
            points[np.asarray(~well, like=points)] = 0.0
            made = features_of(self.scale(points), self.tolerance, self.motion.is_map)
            parts.append(Features(*(on_host(of) for of in made)))
            ends.append(orbits.ends)
            good.append(well)
        return Features.joined(parts), {n: np.concatenate([e[n] for e in ends]) for n in ends[0]}, np.concatenate(good)

    def _followed(self, ends: dict[str, Array], transient: int,
                  weights: Array) -> tuple[list[_Reference | None], Array]:
        """What leaders come to from their ends, None of those that diverge; and codes of their statuses."""
        early = self.motion.orbits(ends, 0, self.phases)
        late = self.motion.orbits(early.ends, _longer * transient, 2 * self.phases)
        good = self._are_good(early) & self._are_good(late)
        made: list[_Reference | None] = [None] * len(good)
        places = np.flatnonzero(good)
        found = self._classified(late, places)
        for i, one in zip(places, found):
            points, spacing = self.scale(one.points), 0.0
            if one.kind == cycle and not self.motion.is_map:
                points, spacing = path(points, self.tolerance)
            of = PointSet(points, one.kind in (fixed_point, cycle), spacing)
            made[i] = _Reference(of, one, of.holds(self.scale(early.points[i]), self.tolerance), int(weights[i]))
        return made, np.where(early.failed, early.status, late.status)

    def _nearest(self, places: Array, first: int) -> Array:
        """The reference, from the first of this turn on, that each of some points is on; `unsettled` if it is on
        none."""
        number, least = np.full(len(places), unsettled), np.zeros(len(places))
        for i, one in enumerate(self._references[first:], first):
            if one.is_settled:
                off = distances(places, one.set.points) - one.set.within(self.tolerance)
                nearer = off < least
                number[nearer], least[nearer] = i, off[nearer]
        return number

    # What the references are

    def _classified(self, late: Orbits, places: Array) -> list[Found]:
        """What some orbits are on."""
        ends = [{name: value[i] for name, value in late.ends.items()} for i in places]
        if self.motion.is_map:
            return self._with_more([self._of_map(late, i, end) for i, end in zip(places, ends)])
        found: list[Found | None] = [self._at_rest(late.points[i], end) for i, end in zip(places, ends)]
        moving = [j for j, one in enumerate(found) if one is None]
        if moving:
            chosen = places[moving]
            cycles = cycles_of_flow(self.motion, self.scale, {n: of[chosen] for n, of in late.ends.items()},
                                    self.phases)
            for j, of in zip(moving, cycles):
                found[j] = Found(aperiodic, np.nan, 0, np.nan, None, late.points[places[j]], ends[j]) if (
                    of is None) else Found(cycle, of.period, 0, np.nan, None, of.points, ends[j])
        return [one for one in found if one is not None]

    def _of_map(self, late: Orbits, i: int, end: dict[str, float]) -> Found:
        points = late.points[i]
        lag = returns_of(self.scale(points), self.tolerance)
        if not lag or late.times is None:
            return Found(aperiodic, np.nan, 0, np.nan, None, points, end)
        period = abs(float((late.times[i, -lag:] - self.motion.begin).sum()))
        return Found(cycle, period, lag, np.nan, None, points[-lag:], end)

    def _with_more(self, found: list[Found]) -> list[Found]:
        """The same with more points of those on a map that do not return: on a torus they may fill it slowly."""
        open_ = [j for j, one in enumerate(found) if one.kind == aperiodic]
        if open_:
            ends = {name: np.array([found[j].end[name] for j in open_]) for name in found[open_[0]].end}
            orbits = self.motion.orbits(ends, 0, max(_points_of_open, 2 * self.phases))
            good = self._are_good(orbits)
            for i, j in enumerate(open_):
                if good[i]:
                    found[j] = found[j]._replace(points=orbits.points[i])
        return found

    def _at_rest(self, points: Array, end: dict[str, float]) -> Found | None:
        """The steady state that an orbit of a flow is at, if it is at one."""
        motion, size = self.motion, float(np.ptp(self.scale(points), axis=0).max())
        if size > self.tolerance:
            return None
        equations = equations_of_flow(motion)
        reach = np.full(len(motion.model.states), np.inf)
        for name, extent in zip(motion.states, self.scale.extent):
            reach[motion.model.states.index(name)] = 5 * self.tolerance * extent
        steady = None if equations is None else steady_state_near(equations, end, reach)
        if steady is not None and steady.kind.startswith("unstable") and size > 1e-6:
            return None  # on a small cycle around it
        at = points[-1:] if steady is None else np.array([[steady.state[name] for name in motion.states]])
        return Found(fixed_point, np.nan, 0, np.nan, steady, at, end)

    # What the attractors are

    def _merged(self, leader: Array) -> tuple[list[Found], Array]:
        """Attractors, and the label of each start by the number of its reference. What no leader has stayed on is no
        attractor, as orbits that drift away slowly."""
        references = self._references
        used = np.unique(leader[leader >= 0])
        chosen, belongs = merged([references[i].set for i in used], np.array([references[i].weight for i in used]),
                                 self.tolerance)
        stayed = sorted({belongs[n] for n, i in enumerate(used) if references[i].is_settled})
        of = np.full(len(references) + 2, unsettled)
        of[diverged] = diverged
        of[used] = _relabelled(belongs, stayed, len(chosen))
        return [references[used[chosen[n]]].found for n in stayed], of[leader]

    def _with_exponents(self, found: list[Found]) -> list[Found]:
        """The same with their largest Lyapunov exponents, of those that neither rest nor return, or of all."""
        if self.exponents is False or not found:
            return found
        places = [i for i, one in enumerate(found) if self.exponents or one.kind == aperiodic]
        ends = {name: np.array([one.end[name] for one in found]) for name in found[0].end}
        values, phase = exponents_of(self.motion, ends, places, bool(self.exponents), self.notes)
        kinds = kinds_by_exponents(values, phase)
        return [one._replace(exponent=float(value), kind=kind if one.kind == aperiodic else one.kind)
                for one, value, kind in zip(found, values, kinds)]

    def _without_saddles(self, found: list[Found], label: Array) -> tuple[list[Found], Array]:
        """Steady states that are not stable attract nothing: orbits that rest there started on their stable manifold,
        or have not left yet."""
        kept = []
        for i, one in enumerate(found):
            kind = "" if one.steady_state is None else one.steady_state.kind
            if kind.startswith(("saddle", "unstable")):
                self.notes.append(f"{_starts(int((label == i).sum()))} come to {one.steady_state!r}, which is no "
                                  "attractor")
                label = np.where(label == i, unsettled, label)
            else:
                kept.append(i)
        return [found[i] for i in kept], _relabelled(label, kept, len(found))

    def _ordered(self, found: list[Found], label: Array) -> tuple[list[Found], Array]:
        """Attractors with most starts first, equal ones in the order of their places."""
        counts = np.bincount(label[label >= 0], minlength=len(found))
        order = sorted(range(len(found)), key=lambda i: (
            -counts[i], *np.round(self.scale(found[i].points).mean(axis=0), 6)))
        return [found[i] for i in order], _relabelled(label, order, len(found))


def _starts(count: int) -> str:
    return f"{count} starts have" if count > 1 else "1 start has"


def _relabelled(label: Array, order: list[int], count: int) -> Array:
    """Labels of attractors in another order, of those that are left."""
    new = np.full(count + 2, unsettled)
    new[diverged] = diverged
    new[order] = np.arange(len(order))
    return new[label]
