# SPDX-License-Identifier: MIT
"""Random systems of states with constant rates, whose events set, move and turn them: the same counts and states as in
exact arithmetic, with event functions of any form. Small denominators make many events happen at one instant."""

import random
from dataclasses import dataclass
from fractions import Fraction

import pytest

import myriad_ode as my

forms = [lambda g: g, lambda g: g**3, lambda g: g * my.abs(g), lambda g: my.sinh(20 * g), lambda g: 1e-120 * g,
         lambda g: my.atan(1e4 * g), lambda g: my.copysign(my.sqrt(my.abs(g)), g), lambda g: g**5,
         lambda g: g / (1 + my.time**2)]


@dataclass
class Level:
    """An event where a state comes to a level, what it does to others, and the form of its function."""

    state: int
    level: Fraction
    direction: str
    actions: list  # ("set" or "move", state, by what), or ("turn", state, None)
    form: int


@dataclass
class System:
    levels: list
    start: list
    rates: list
    end: Fraction


def sign(x):
    return (x > 0) - (x < 0)


def drawn_system(seed, denominator):
    drawn = random.Random(seed)

    def number(low, high):
        return Fraction(drawn.randint(low * denominator, high * denominator), denominator)

    count = drawn.randint(1, 4)
    start = [number(-1, 1) for _ in range(count)]
    rates = [drawn.choice([-1, 1]) * (number(0, 2) or Fraction(1)) for _ in range(count)]
    levels = []
    for _ in range(drawn.randint(1, 4)):
        own, actions = drawn.randrange(count), {}
        for _ in range(drawn.randint(0, 3)):
            other = drawn.choice([own, drawn.randrange(count)])
            kind, value = drawn.choice([("set", number(-2, 2)), ("move", number(-1, 1)), ("turn", None)])
            actions[kind == "turn", other] = (kind, other, value)
        levels.append(Level(own, number(-2, 2), drawn.choice(["rising", "falling", "either"]), list(actions.values()),
                            drawn.randrange(len(forms))))
    return System(levels, start, rates, drawn.randint(2, 8) + Fraction(1, 7))


def exact(system, most=60):
    """How often each event fires, and the states at the end; None if there are too many events."""
    x, v, t = list(system.start), list(system.rates), Fraction(0)
    levels = system.levels
    counts = [0] * len(levels)
    side = [sign(x[e.state] - e.level) or sign(v[e.state]) for e in levels]
    while sum(counts) <= most:
        coming = [max(Fraction(0), (e.level - x[e.state]) / v[e.state]) for e, s in zip(levels, side)
                  if s != sign(v[e.state])]
        if not coming or t + min(coming) > system.end:
            return counts, [float(a + b * (system.end - t)) for a, b in zip(x, v)]
        t, x = t + min(coming), [a + b * min(coming) for a, b in zip(x, v)]
        crossed = [j for j, e in enumerate(levels) if side[j] != sign(v[e.state]) and x[e.state] == e.level]
        firing = [j for j in crossed if levels[j].direction in ("either", "rising" if side[j] < 0 else "falling")]
        for j in firing:
            counts[j] += 1
            before = list(x)
            for kind, k, value in levels[j].actions:
                if kind == "turn":
                    v[k] = -v[k]
                else:
                    x[k] = value if kind == "set" else before[k] + value
        side = [sign(x[e.state] - e.level) or sign(v[e.state]) for e in levels]
    return None


def solved(system, formed):
    states = [my.state(f"x{i}") for i in range(len(system.start))]
    rates = [my.state(f"v{i}") for i in range(len(system.start))]
    counts = [my.integer_accessory(f"n{j}") for j in range(len(system.levels))]
    events = []
    for e, n in zip(system.levels, counts):
        do = {n: n + 1}
        for kind, k, value in e.actions:
            if kind == "turn":
                do[rates[k]] = -rates[k]
            else:
                do[states[k]] = float(value) if kind == "set" else states[k] + float(value)
        form = forms[e.form] if formed else forms[0]
        events.append(my.event(form(states[e.state] - float(e.level)), direction=e.direction, do=do))
    model = my.model({**dict(zip(states, rates)), **{v: 0 * v for v in rates}}, events=events,
                     accessories={n: 0 for n in counts})
    start = dict(zip(states + rates, map(float, system.start + system.rates)))
    run = my.solve(model, {}, start=start, time=(0, float(system.end)), maximum_step=0.4, method="tsitouras_5",
                   device="cpu:1", interpreted=True)
    return ([int(run[n][0]) for n in counts], [float(run[x][0]) for x in states], str(run.status[0]))


def faults(seed, denominator):
    system = drawn_system(seed, denominator)
    right = exact(system)
    found = []
    for formed in (False, True) if right else ():
        counts, states, status = solved(system, formed)
        near = all(abs(a - b) <= 1e-8 for a, b in zip(states, right[1]))
        if counts != right[0] or not near or status != "success":
            found.append(f"seed {seed}, denominator {denominator}, {'other forms' if formed else 'x - c'}: {counts}, "
                         f"right {right[0]}; {states}, right {right[1]}; {status}")
    return found


@pytest.mark.parametrize("denominator", [1, 2, 3, 8])
def test_events_are_those_of_exact_arithmetic(denominator):
    seeds = *range(100), 308, 338  # in which actions move states onto surfaces of other events
    wrong = [fault for seed in seeds for fault in faults(seed, denominator)]
    assert not wrong, "\n".join(wrong)


def level(state, level, direction, *actions, form=0):
    return Level(state, Fraction(level), direction, list(actions), form)


def test_a_state_that_an_action_moves_onto_the_surface_of_another_event_does_not_cross_it():
    """It lies beside the surface by what the first event was located short of or past its own."""
    for form in range(len(forms)):
        system = System([level(0, "-1", "either", ("move", 0, Fraction(1)), form=form),
                         level(0, "0", "either", ("set", 0, Fraction(5)), form=(form + 2) % len(forms))],
                        [Fraction(1, 3)], [Fraction(-2)], Fraction(4))
        counts, _, status = solved(system, True)
        assert (counts, status) == (exact(system)[0], "success"), form


def test_a_flat_event_function_is_located_to_the_resolution_of_time():
    """Neither short of its event nor past it by the fifth part of an exponent's rounding error."""
    for form in (1, 2, 7):
        system = System([level(0, "-3/2", "falling", ("move", 0, Fraction(-1, 2)), ("turn", 0, None), form=form)],
                        [Fraction(-1)], [Fraction(-1, 2)], Fraction(22, 7))
        counts, states, _ = solved(system, True)
        assert counts == [1]
        assert abs(states[0] - exact(system)[1][0]) < 4e-15, (form, states)


def test_after_many_steps_an_event_fires_at_the_end_of_the_domain_exactly_if_it_is_due_by_then():
    """The errors of steps before its last action do not count, those of the times of all actions do."""
    x, n = my.state("x"), my.integer_accessory("n")
    model = my.model({x: 1.0}, events=my.event(x - 0.1, direction="rising", do={x: 0, n: n + 1}), accessories={n: 0})
    for end, due in [(20.09999999, 200), (20.1, 201), (20.10000001, 201)]:
        run = my.solve(model, size=1, start={x: 0.0}, time=(0, end), maximum_step=2e-4, max_steps=10**7,
                       device="cpu:1", interpreted=True)
        assert run[n][0] == due, (end, run[n][0], run[x][0])
