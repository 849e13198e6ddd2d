# SPDX-License-Identifier: MIT
"""What an attractor is, from an orbit on it: steady state, cycle and its period, torus or chaos."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..base import component_kinds as kinds
from ..base.errors import Error
from ..models.recorded import RecordedModel
from ..results.exponents import exponents
from ..symbolic.node import symbols_of
from .clusters import lags
from .equations import Equations
from .orbits import samples_of_phase
from .steady_states import SteadyState, equations_of, steady_state_at

if TYPE_CHECKING:
    from ..symbolic.types import Array
    from .orbits import Motion, Scale

fixed_point, cycle, torus, chaos, aperiodic = "fixed point", "cycle", "quasiperiodic", "chaotic", "aperiodic"
_phases_of_exponents = 1000
_samples_of_phase = 4 * samples_of_phase  # of a flow, to find its period
_samples_of_cycle, _periods_of_cycle = 2001, 2.2  # to find its period more closely
_regular = 0.95  # of the samples are not next to a jump or in a short fast part, as of relaxation oscillations


def returns_of(points: Array, tolerance: float) -> int:
    """After how many points an orbit on its attractor returns, 0 if it does not: told as closely as it can be."""
    for closely in (1e-3 * tolerance, 0.03 * tolerance, tolerance):
        lag = int(lags(points[None], closely)[0][0])
        if lag:
            return lag
    return 0


def equations_of_flow(motion: Motion) -> Equations | None:
    """The equations of a flow, where steady states can be found."""
    model = motion.model
    if motion.is_map or not isinstance(model, RecordedModel) or model.mass_matrix is not None or any(
            symbol.value[0] in kinds.accessories for symbol in symbols_of(model.equations.values())):
        return None
    return equations_of(motion.model, motion.values)


def steady_state_near(equations: Equations, end: Mapping[str, Any], reach: Array) -> SteadyState | None:
    """The steady state within reach of the end of an orbit, if Newton's method finds one."""
    state = np.array([float(end[name]) for name in equations.states])
    scale = np.where(np.isfinite(reach), reach, np.abs(state))
    found, arrived = equations.newton(state[None], 100, scale)
    if not arrived[0] or (np.abs(found[0] - state) > reach).any():
        return None
    return steady_state_at(equations, found[0], scale)


class Cycle(NamedTuple):
    """A cycle of a flow: its period, and points along it with their times."""

    period: float
    points: Array
    times: Array


def cycles_of_flow(motion: Motion, scale: Scale, ends: Mapping[str, Array], phases: int) -> list[Cycle | None]:
    """The cycles of a flow on which some states are; None for one that does not return within half of so many
    phases."""
    count = _samples_of_phase * phases
    times = motion.begin + np.linspace(0, motion.phase * phases, count + 1)
    found: list[Cycle | None] = []
    for part in motion.chunks(len(next(iter(ends.values()))), 4 * phases):
        run = motion.sampled({name: of[part] for name, of in ends.items()}, times, float(times[-1]))
        points = np.stack([run.samples[name] for name in motion.states], axis=2)
        found += [_cycle(one, scale(one), float(times[1] - times[0])) for one in points]
    places = [i for i, one in enumerate(found) if one is not None]
    if places:
        made = _resolved(motion, scale, {name: of[places] for name, of in ends.items()},
                         [one for one in found if one is not None])
        for i, one in zip(places, made):
            found[i] = one
    return found


def _resolved(motion: Motion, scale: Scale, ends: Mapping[str, Array], found: list[Cycle]) -> list[Cycle]:
    """The same cycles from as many samples of each, whatever its period is; and with the ends of steps among their
    points, of which there are many where a cycle is fast."""
    lengths = _periods_of_cycle * np.array([one.period for one in found])
    run = motion.evenly(ends, lengths, _samples_of_cycle)
    for j, points in enumerate(np.stack([run.samples[name] for name in motion.states], axis=2)):
        found[j] = _cycle(points, scale(points), float(lengths[j]) / (_samples_of_cycle - 1)) or found[j]
    run = motion.at_steps(ends, np.array([one.period for one in found]))
    more = np.stack([run.samples[name] for name in motion.states], axis=2)
    for j, (period, points, times) in enumerate(found):
        at_steps = run.t_sample[j] - motion.begin
        inside = (at_steps > 0) & (at_steps < period)  # not those beyond the samples that there are, which are NaN
        if not run.failed[j]:
            at = np.concatenate([times, at_steps[inside]])
            order = np.argsort(at, kind="stable")
            found[j] = Cycle(period, np.concatenate([points, more[j, inside]])[order], at[order])
    return found


def _cycle(points: Array, scaled: Array, step: float) -> Cycle | None:
    """The cycle that a path returns on: after the first time at which it is where it was, and stays with what it was
    before for as long as it is followed."""
    extent = np.ptp(scaled, axis=0)
    if not np.isfinite(extent).all() or not extent.any():
        return None
    scaled = scaled / np.maximum(extent, min(1.0, 0.05 * extent.max()))  # each coordinate counts, peaks and plateaus
    steps = np.sqrt((np.diff(scaled, axis=0)**2).sum(axis=1))
    longest, usual = float(steps.max()), float(np.quantile(steps, _regular))
    off = np.sqrt(((scaled[:len(scaled) // 2] - scaled[0])**2).sum(axis=1))
    least = np.flatnonzero((off[1:-1] <= off[:-2]) & (off[1:-1] < off[2:]) & (off[1:-1] <= 0.02 + longest)) + 1
    for k in least[:200]:
        lag = _refined(scaled, int(k))
        if lag < 4:
            continue
        whole, part = int(lag), lag - int(lag)
        later = (1 - part) * scaled[whole:-1] + part * scaled[whole + 1:]
        rounding = 0.01 + 0.5 * usual**2
        differs = np.abs(later - scaled[:len(later)]).max(axis=1)
        if np.quantile(differs, _regular) <= rounding and _returns_last(scaled, lag, rounding):
            return Cycle(lag * step, points[:whole], step * np.arange(whole))
    return None


def _returns_last(points: Array, lag: float, rounding: float) -> bool:
    """Whether a path is still where it was after as many returns as there are, as on a torus it may drift."""
    last = int((len(points) - 4) // lag * lag)
    k = last - 2 + int(((points[last - 2:last + 3] - points[0])**2).sum(axis=1).argmin())
    part = _refined(points, min(k, len(points) - 2))
    at = points[int(part)] + (part - int(part)) * (points[int(part) + 1] - points[int(part)])
    return bool(np.abs(at - points[0]).max() <= rounding)


def _refined(points: Array, k: int) -> float:
    """The lag next to k, in samples, at which the path between samples is nearest to the first point."""
    best, nearest = float(k), np.inf
    for i in (k - 1, k):
        along = points[i + 1] - points[i]
        length = along @ along
        part = float(np.clip((points[0] - points[i]) @ along / length, 0, 1)) if length else 0.0
        off = float(((points[i] + part * along - points[0])**2).sum())
        if off < nearest:
            best, nearest = i + part, off
    return best


def largest_exponents(motion: Motion, ends: Mapping[str, Array]) -> tuple[Array, Array]:
    """The largest Lyapunov exponent from states on attractors, per unit of time, and the mean length of a phase."""
    run = motion.run_with_tangents(ends, 20, _phases_of_exponents)
    return exponents(run)[:, 0], run["time_summed"] / _phases_of_exponents


def kinds_by_exponents(values: Array, phase: Array) -> list[str]:
    """Chaos where neighbours part faster than those on a torus, of which one is behind the other by a constant part of
    the time, so that their exponents fall as log(N) / N in N phases."""
    limit = 2 * np.log(_phases_of_exponents) / _phases_of_exponents
    return [aperiodic if np.isnan(value) else chaos if value * length > limit else torus
            for value, length in zip(values, phase)]


def exponents_of(motion: Motion, ends: Mapping[str, Array], places: Sequence[int], must: bool,
                 notes: list[str]) -> tuple[Array, Array]:
    """Exponents and lengths of phases at some places of the ends, NaN elsewhere. Unless they must be, they are left out
    where there is no compiler or the model takes no tangents, with a note."""
    count = len(next(iter(ends.values())))
    found, phase = np.full(count, np.nan), np.full(count, np.nan)
    if places:
        chosen = list(places)
        try:
            found[chosen], phase[chosen] = largest_exponents(motion, {n: v[chosen] for n, v in ends.items()})
        except Error as why:
            if must:
                raise
            notes.append(f"tori and chaos are not told apart: {why}")
    return found, phase
