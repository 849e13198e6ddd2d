# SPDX-License-Identifier: MIT
"""Models with events whose times have closed forms, as functions of states and time, so that the tests of event
location can write them with other event functions, in other units and backwards."""

from dataclasses import dataclass, field
from fractions import Fraction
from math import asin, atan, inf, log, pi, sqrt

import myriad_ode as my


@dataclass
class Crossing:
    """An event left = right. Its function is left - right, or any other that has its sign.

    `do` maps ("state", i) or ("mode", i) to what they become; `times` are those at which it fires. If `positive`, both
    sides are positive wherever a trial step may lead, so that even powers of them may be compared too.
    """

    left: object
    right: object
    direction: str
    times: list
    do: dict = field(default_factory=dict)
    stop_after: int = 0
    positive: bool = False


@dataclass
class Motion:
    """A model: `write(s, m, t)` gives the derivatives and the crossings, from states, modes and time.

    `bound(k, t)` is how far the k-th time of an event may be from the closed form. Where every step of a method is
    exact but for rounding (polynomials in t), it follows from `amplified`, how much later times move if one moves, and
    the roundings of t and of g: 64 roundings of the largest number that occurs. Else it is of the size of the error of
    the method at the tolerance 1e-12, of which the many steps and the amplification make 1e-10 for each event before.
    """

    name: str
    write: object
    start: list
    end: float
    modes: list = field(default_factory=list)
    exact: bool = True
    amplified: float = 1.0
    status: str = "success"
    final: dict = field(default_factory=dict)  # state: (value, bound) at the end
    final_time: tuple = ()  # (time, bound), where it is not `end`
    open_end: bool = False  # more events than the times given may follow
    largest_step: float = 0.5
    solve: dict = field(default_factory=dict)
    kind: str = ""  # of the events, for the table of counts
    jumps: bool = True  # seen in functions without a slope away from zero too
    splits: bool = True  # the domain may be cut anywhere, in calls that know only the state
    atol: float = 1e-12
    largest: float = 1.0  # of what event functions are differences of

    def bound(self, k, t):
        if self.exact:
            return 64 * 2.0**-52 * max(abs(t), self.largest) * self.amplified * (k + 1)
        return 1e-10 * (k + 1) * self.amplified


def every(period, end, first=None):
    """The times first, first + period, ... before the end."""
    times, k = [], 0
    first = period if first is None else first
    while first + k * period < end:
        times.append(first + k * period)
        k += 1
    return times


def flights(first, length, kept, end=inf, count=10**9):
    """The impacts of a ball: the first, and those after flights that become shorter by a factor."""
    times, t = [], first
    while t < end and len(times) < count:
        times.append(t)
        t += length
        length *= kept
    return times


gravity = 9.81


def fall(height, weight=gravity):
    return sqrt(2 * height / weight)


def saw(s, m, t):
    return [1.0], [Crossing(s[0], 1.0, "rising", every(1, 20.5), {("state", 0): 0.0}, positive=True)]


def long_saw(s, m, t):
    return [1.0], [Crossing(s[0], 1.0, "rising", every(1, 200.5), {("state", 0): 0.0}, positive=True)]


def remainder_saw(s, m, t):
    return [0.7], [Crossing(s[0], 1.0, "rising", every(1 / 0.7, 20.1), {("state", 0): s[0] - 1.0})]


def wrap(s, m, t):
    return [2.5], [Crossing(s[0], 2 * pi, "rising", every(2 * pi / 2.5, 20), {("state", 0): s[0] - 2 * pi})]


def wrap_to_zero(s, m, t):
    """Two angles that turn in opposite directions, and pass the end of the circle together."""
    return [2.5, -2.5], [Crossing(s[0], 2 * pi, "rising", every(2 * pi / 2.5, 20), {("state", 0): 0.0}),
                         Crossing(s[1], -2 * pi, "falling", every(2 * pi / 2.5, 20), {("state", 1): 0.0})]


def neuron(s, m, t):
    return [1.5 - s[0]], [Crossing(s[0], 1.0, "rising", every(log(3), 10), {("state", 0): 0.0}, positive=True)]


def two_neurons(s, m, t):
    """The same in two units, so that both fire at one instant, up to rounding."""
    return [1.5 - s[0], 4.5 - s[1]], [
        Crossing(s[0], 1.0, "rising", every(log(3), 10), {("state", 0): 0.0}, positive=True),
        Crossing(s[1], 3.0, "rising", every(log(3), 10), {("state", 1): 0.0}, positive=True)]


def kicks(end):
    """x' = y' = 1; x at 1 is set to 0 and moves y by 0.2; y at 1 is set to 0 and moves x by 0.1: the times."""
    x, y, t, times = Fraction(0), Fraction(3, 5), Fraction(0), ([], [])
    while t + 1 - max(x, y) < end:
        step = 1 - max(x, y)
        t, x, y = t + step, x + step, y + step
        assert x != y and max(x, y) == 1
        if x == 1:
            x, y = Fraction(0), y + Fraction(1, 5)
            times[0].append(float(t))
        else:
            x, y = x + Fraction(1, 10), Fraction(0)
            times[1].append(float(t))
    return times


def pulse_coupled(s, m, t):
    first, second = kicks(2.95)
    return [1.0, 1.0], [
        Crossing(s[0], 1.0, "rising", first, {("state", 0): 0.0, ("state", 1): s[1] + 0.2}, positive=True),
        Crossing(s[1], 1.0, "rising", second, {("state", 0): s[0] + 0.1, ("state", 1): 0.0}, positive=True)]


def impact(s, i, times, kept):
    return Crossing(s[i], 0.0, "falling", times, {("state", i): 0.0, ("state", i + 1): -kept * s[i + 1]})


def ball(s, m, t):
    first = fall(1)
    return [s[1], -gravity], [impact(s, 0, flights(first, 1.6 * first, 0.8, 3.5), 0.8)]


def slow_ball(s, m, t):
    """As the first, but the height is left where the event was located."""
    first = fall(1)
    return [s[1], -gravity], [Crossing(s[0], 0.0, "falling", flights(first, 1.6 * first, 0.8, 3.5),
                                       {("state", 1): -0.8 * s[1]})]


def two_balls(s, m, t):
    first = fall(1)
    times = flights(first, 1.6 * first, 0.8, 3.5)
    return [s[1], -gravity, s[3], -gravity / 3], [impact(s, 0, times, 0.8), impact(s, 2, times, 0.8)]


four_heights = [1.0, 1 / 3, 2.0, 0.7]


def four_balls(s, m, t):
    first = fall(1)
    times = flights(first, 1.6 * first, 0.8, 3.5)
    rates = [f for i, h in enumerate(four_heights) for f in (s[2 * i + 1], -gravity * h)]
    return rates, [impact(s, 2 * i, times, 0.8) for i in range(4)]


def one_contact(s, m, t):
    """Two balls that land together once, and then bounce as each of them does."""
    first = fall(1)
    return [s[1], -gravity, s[3], -gravity / 3], [
        impact(s, 0, flights(first, 1.6 * first, 0.8, 1.3), 0.8),
        impact(s, 2, flights(first, 1.0 * first, 0.5, 1.3), 0.5)]


def resting_ball(s, m, t):
    first = fall(1)
    return [s[1], -gravity], [impact(s, 0, flights(first, 1.0 * first, 0.5, count=12), 0.5)]


def two_resting_balls(s, m, t):
    """The second rests long after the end of the first, which ends the instance."""
    first = fall(1)
    rest = first * 3
    return [s[1], -gravity, s[3], -gravity / 2], [
        impact(s, 0, flights(first, 1.0 * first, 0.5, count=12), 0.5),
        impact(s, 2, flights(sqrt(2) * first, 1.8 * sqrt(2) * first, 0.9, rest), 0.9)]


def levels_of_a_sine(s, m, t):
    times = sorted(asin(0.3) + 2 * pi * k for k in range(4)) + [pi - asin(0.3) + 2 * pi * k for k in range(3)]
    return [s[1], -s[0]], [Crossing(s[0], 0.3, "either", sorted(times)),
                           Crossing(s[0], 0.3, "falling", [pi - asin(0.3) + 2 * pi * k for k in range(3)])]


def section(s, m, t):
    """Extrema of a cosine: both functions are zero at the start."""
    return [s[1], -s[0]], [Crossing(s[1], 0.0, "falling", every(2 * pi, 20)),
                           Crossing(s[1], 0.0, "rising", every(2 * pi, 20, pi))]


def stopped_section(s, m, t):
    derivatives, events = section(s, m, t)
    events[0].stop_after = 1
    events[0].times, events[1].times = events[0].times[:2], events[1].times[:2]
    return derivatives, events


def stopped_saw(s, m, t):
    derivatives, events = saw(s, m, t)
    events[0].stop_after, events[0].times = 3, every(1, 12.5)
    return derivatives, events


def thermostat(s, m, t):
    first, period = log(2 / 0.8), log(1.5)
    on = m[0] == 1
    return [my.where(on, 2.0, 0.0) - s[0]], [
        Crossing(my.where(on, s[0], 0.5), 1.2, "rising", every(2 * period, 5, first), {("mode", 0): 0}),
        Crossing(my.where(on, 1.5, s[0]), 0.8, "falling", every(2 * period, 5, first + period), {("mode", 0): 1})]


def thermostat_by_direction(s, m, t):
    """Without a function that is constant in a mode: the directions tell."""
    derivatives, events = thermostat(s, m, t)
    events[0].left = events[1].left = s[0]
    return derivatives, events


def stick_slip(s, m, t):
    """Slows down to rest at 1, sticks, and slides on from 3, where the force t is larger than what holds it."""
    sticks = m[0] == 1
    return [my.where(sticks, 0.0, t - 2.0)], [
        Crossing(my.where(sticks, 1.0, s[0]), 0.0, "falling", [1.0], {("state", 0): 0.0, ("mode", 0): 1}),
        Crossing(my.where(sticks, t, 2.0), 3.0, "rising", [3.0], {("mode", 0): 0})]


def walls(s, m, t):
    return [s[1], 0.0], [Crossing(s[0], 0.0, "falling", every(2, 20, 1.75), {("state", 1): -s[1]}),
                         Crossing(s[0], 1.0, "rising", every(2, 20, 0.75), {("state", 1): -s[1]})]


def walls_exactly(s, m, t):
    derivatives, events = walls(s, m, t)
    events[0].do[("state", 0)], events[1].do[("state", 0)] = 0.0, 1.0
    return derivatives, events


def corners(s, m, t):
    """A point on the diagonal of a rectangle: always two walls at one instant."""
    low, high = every(2, 20, 1.75), every(2, 20, 0.75)
    return [s[1], 0.0, s[3], 0.0], [
        Crossing(s[0], 0.0, "falling", low, {("state", 1): -s[1]}),
        Crossing(s[0], 1.0, "rising", high, {("state", 1): -s[1]}),
        Crossing(s[2], 0.0, "falling", low, {("state", 3): -s[3]}),
        Crossing(s[2], 3.0, "rising", high, {("state", 3): -s[3]})]


def valve(s, m, t):
    """A spring presses on a seat, from which a body bounces: it starts on it, at speed 2."""
    times, speed, at = [], 2.0, 0.0
    for _ in range(4):
        at += 2 * atan(speed)
        speed *= 0.8
        times.append(at)
    return [s[1], -s[0] - 1.0], [impact(s, 0, times, 0.8)]


def turned_round(s, m, t):
    """The action turns the motion before it has passed the surface, which it then leaves on the side it came from."""
    return [my.where(m[0] == 0, 1.0, -1.0)], [Crossing(s[0], 0.0, "either", [1.0], {("mode", 0): 1 - m[0]})]


def passed_through(s, m, t):
    return [1.0], [Crossing(s[0], 0.0, "either", [1.0])]


def levels(s, m, t):
    return [1.0], [Crossing(s[0], c, "either", [c], positive=True) for c in (0.5, 0.7, 0.5, 0.7 + 1e-9)]


def moved_past(s, m, t):
    """The action of the first moves a state past the level of the second, which is no crossing."""
    return [1.0, -1.0], [Crossing(s[0], 1.0, "rising", [1.0], {("state", 1): s[1] + 1.25}, positive=True),
                         Crossing(s[1], 0.5, "either", [0.7, 1.95])]


def time_at_the_end(s, m, t):
    return [1.0], [Crossing(t, 1.0, "either", [1.0])]


def state_at_the_end(s, m, t):
    """x' = 1 to x = 1, which is there but for the rounding of a few steps."""
    return [1.0], [Crossing(s[0], 1.0, "either", [1.0])]


def time_within(s, m, t):
    """At the end of a phase and the begin of the next: once."""
    return [1.0], [Crossing(t, 1.0, "either", [1.0])]


def state_within(s, m, t):
    """The same of a state, which may be short of it or past it by its rounding."""
    return [1.0], [Crossing(s[0], 1.0, "either", [1.0])]


def reset_within(s, m, t):
    return [1.0], [Crossing(s[0], 1.0, "rising", [1.0, 2.0, 3.0], {("state", 0): 0.0}, positive=True)]


def zero_at_the_start(s, m, t):
    """Zero at the start and on the way up, or down: no crossing."""
    return [1.0, -1.0], [Crossing(s[0], 0.0, "either", []), Crossing(s[1], 0.0, "either", []),
                         Crossing(t, 0.0, "either", [])]


def never_zero(s, m, t):
    """Decays for ever, and passes a small level once."""
    return [-s[0]], [Crossing(s[0], 0.0, "either", []), Crossing(s[0], 1e-3, "either", [log(1e3)], positive=True)]


def long_touch(s, m, t):
    """x = sin t passes 1 - 1e-8 and comes back 2.8e-4 later."""
    half = pi / 2 - asin(1 - 1e-8)
    return [s[1], -s[0]], [Crossing(s[0], 1 - 1e-8, "either", [pi / 2 - half, pi / 2 + half])]


def parabola(s, m, t):
    """x = 1 - (t - 1)^2 passes 1 - 1e-4, 1 - 1e-6 and comes back, and misses 1 + 1e-6."""
    return [s[1], -2.0], [Crossing(s[0], 1 - 1e-4, "either", [1 - 1e-2, 1 + 1e-2]),
                          Crossing(s[0], 1 - 1e-6, "falling", [1 + 1e-3]),
                          Crossing(s[0], 1 + 1e-6, "either", [])]


def double_root(s, m, t):
    """Touches zero and never is negative."""
    return [1.0], [Crossing((s[0] - 1.0) * (s[0] - 1.0), 0.0, "either", [])]


def ends_phases(s, m, t):
    return [1.0], [Crossing(s[0], 1.0, "rising", [1.0, 2.0, 3.0, 4.0, 5.0], {("state", 0): 0.0, ("phase", 0): True},
                            positive=True)]


rest = fall(1) * 3  # of a ball that keeps half of its speed
phases = {"phases": 4, "carry_on": True}
motions = [
    Motion("saw", saw, [0.0], 20.5, amplified=2, kind="reset"),
    Motion("long_saw", long_saw, [0.0], 200.5, amplified=2, kind="reset"),
    Motion("remainder_saw", remainder_saw, [0.0], 20.1, amplified=2, kind="reset"),
    Motion("wrap", wrap, [0.0], 20, amplified=2, kind="reset", largest=2 * pi),
    Motion("wrap_to_zero", wrap_to_zero, [0.0, 0.0], 20, amplified=2, kind="together", largest=2 * pi),
    Motion("neuron", neuron, [0.0], 10, exact=False, kind="reset"),
    Motion("two_neurons", two_neurons, [0.0, 0.0], 10, exact=False, kind="together"),
    Motion("pulse_coupled", pulse_coupled, [0.0, 0.6], 2.95, amplified=2, kind="reset"),
    Motion("ball", ball, [1.0, 0.0], 3.5, amplified=20, kind="impact"),
    Motion("slow_ball", slow_ball, [1.0, 0.0], 3.5, amplified=40, kind="impact"),
    Motion("two_balls", two_balls, [1.0, 0.0, 1 / 3, 0.0], 3.5, amplified=20, kind="together"),
    Motion("four_balls", four_balls, [f for h in four_heights for f in (h, 0.0)], 3.5, amplified=20, kind="together"),
    Motion("one_contact", one_contact, [1.0, 0.0, 1 / 3, 0.0], 1.3, amplified=20, kind="together"),
    Motion("resting_ball", resting_ball, [1.0, 0.0], 3.0, amplified=20, status="event_accumulation", open_end=True,
           final_time=(rest, 1e-6), kind="accumulation", splits=False),
    Motion("two_resting_balls", two_resting_balls, [1.0, 0.0, 1.0, 0.0], 3.0, amplified=20,
           status="event_accumulation", open_end=True, final_time=(rest, 1e-6), kind="accumulation", splits=False),
    Motion("levels_of_a_sine", levels_of_a_sine, [0.0, 1.0], 20, exact=False, kind="counting"),
    Motion("section", section, [1.0, 0.0], 20, exact=False, kind="start"),
    Motion("stopped_section", stopped_section, [1.0, 0.0], 20, exact=False, kind="start", status="stopped_by_event",
           solve={"phases": 2, "carry_on": True}, final_time=(4 * pi, 1e-9), splits=False),
    Motion("stopped_saw", stopped_saw, [0.0], 20.5, amplified=2, status="stopped_by_event", solve=phases,
           final_time=(12.0, 1e-11), kind="phases", splits=False),
    Motion("thermostat", thermostat, [0.0], 5, modes=[1], exact=False, kind="modes"),
    Motion("thermostat_by_direction", thermostat_by_direction, [0.0], 5, modes=[1], exact=False, kind="modes"),
    Motion("stick_slip", stick_slip, [1.5], 5, modes=[0], amplified=4, kind="modes", final={0: (4.0, 1e-11)},
           largest=5.0),
    Motion("walls", walls, [0.25, 1.0], 20, amplified=4, kind="impact"),
    Motion("walls_exactly", walls_exactly, [0.25, 1.0], 20, amplified=4, kind="impact"),
    Motion("corners", corners, [0.25, 1.0, 0.75, 3.0], 20, amplified=4, kind="together"),
    Motion("valve", valve, [0.0, 2.0], 8.5, exact=False, amplified=2, kind="start"),
    Motion("turned_round", turned_round, [-1.0], 3, modes=[0], kind="modes", final={0: (-2.0, 1e-12)}),
    Motion("passed_through", passed_through, [-1.0], 3, kind="counting", final={0: (2.0, 1e-12)}),
    Motion("levels", levels, [0.0], 2, kind="together"),
    Motion("moved_past", moved_past, [0.0, 1.2], 3, kind="modes"),
    Motion("time_at_the_end", time_at_the_end, [0.0], 1, kind="end", splits=False),
    Motion("state_at_the_end", state_at_the_end, [0.0], 1, kind="end, by rounding", splits=False, jumps=False),
    Motion("time_within", time_within, [0.0], 2, solve={"phases": 2, "phase_length": 1.0}, kind="end of a phase",
           splits=False),
    Motion("state_within", state_within, [0.0], 2, solve={"phases": 2, "phase_length": 1.0}, kind="end of a phase",
           splits=False),
    Motion("reset_within", reset_within, [0.0], 3.5, solve={"phases": 4, "phase_length": 1.0}, kind="end of a phase",
           amplified=2, splits=False),
    Motion("zero_at_the_start", zero_at_the_start, [0.0, 0.0], 2, kind="start"),
    Motion("never_zero", never_zero, [1.0], 20, exact=False, kind="counting", atol=1e-20),
    Motion("long_touch", long_touch, [0.0, 1.0], 3, exact=False, kind="touch", amplified=100,
           solve={"sub_samples": 2}, jumps=False),
    Motion("parabola", parabola, [0.0, 2.0], 2.5, amplified=1000, kind="touch", solve={"sub_samples": 2}, jumps=False),
    Motion("double_root", double_root, [0.0], 2, kind="touch"),
    Motion("ends_phases", ends_phases, [0.0], 20, solve={"phases": 5, "carry_on": True}, status="stopped_by_user",
           final_time=(5.0, 1e-12), kind="phases", splits=False),
]
by_name = {motion.name: motion for motion in motions}
