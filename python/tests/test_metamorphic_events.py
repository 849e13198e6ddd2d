# SPDX-License-Identifier: MIT
"""Events depend on the sign of their functions alone: the same models with other functions of the same sign, in other
units, orders, parts and steps have the same events, counts, statuses and times.

A case is one instance of one such model. A test has a few cases; after the last one a table shows how many there were
and failed, by what was changed and by kind of model. As a script, `python test_metamorphic_events.py --random 5000
--seed 1`, the same file runs combinations of changes that it draws.
"""

import collections
import random
import sys
from dataclasses import dataclass, field

import numpy as np
import pytest

sys.path.insert(0, __file__.rpartition("/")[0])
import metamorphic_models as models  # noqa: E402

import myriad_ode as my  # noqa: E402

log_length = 8  # times of each event that are kept: the first ones

# Functions of the sign of g = left - right: g may be up to 14 in a trial step, where sinh(50 g) is still a number.
scales = [1e-300, 1e-100, 1e-30, 1e-8, 1e8, 1e30, 1e100, 1e300]
functions = {
    "g": (lambda g, c, t, e: g, [1.0]),
    "c g": (lambda g, c, t, e: c * g, scales),
    "g^3": (lambda g, c, t, e: g * g * g, [1.0]),
    "g^5": (lambda g, c, t, e: g**5, [1.0]),
    "g |g|": (lambda g, c, t, e: g * my.abs(g), [1.0]),
    "root of g": (lambda g, c, t, e: my.copysign(my.sqrt(my.abs(g)), g), [1.0]),
    "sinh(k g)": (lambda g, c, t, e: my.sinh(c * g), [2.0, 30.0, 50.0]),
    "exp(k g) - 1": (lambda g, c, t, e: my.exp(c * g) - 1, [2.0, 8.0, 30.0]),
    "1 - exp(-k g)": (lambda g, c, t, e: 1 - my.exp(-c * g), [2.0, 30.0]),
    "atan(k g)": (lambda g, c, t, e: my.atan(c * g), [1.0, 1e6, 1e12]),
    "tanh(k g)": (lambda g, c, t, e: my.tanh(c * g), [1.0, 100.0]),
    "g (1 + t^2)": (lambda g, c, t, e: g * (1 + t * t), [1.0]),
    "g / (1 + t^2)": (lambda g, c, t, e: g / (1 + t * t), [1.0]),
    "l^3 - r^3": (lambda g, c, t, e: (e.left + 1)**3 - (e.right + 1)**3, [1.0]),
    "l^4 - r^4": (lambda g, c, t, e: e.left**4 - e.right**4, [1.0]),
    "l^20 - r^20": (lambda g, c, t, e: e.left**20 - e.right**20, [1.0]),
    "log(l / r)": (lambda g, c, t, e: my.log((e.left + 1) / (e.right + 1)), [1.0]),
    "sign of g": (lambda g, c, t, e: my.where(g < 0, -1.0, my.where(g > 0, 1.0, 0.0)), [1.0]),
}
of_positive_sides = ("l^4 - r^4", "l^20 - r^20", "log(l / r)")
without_slope = ("sign of g", "tanh(k g)")  # whose slope is zero, or its rounding, away from zero
# Those that have the sign of the rounded g to the last bit, and so the same first time: of two that do not, the action
# of one may come before the other is there.
same_roundings = ("g", "c g", "g^3", "g^5", "g |g|", "root of g", "sinh(k g)", "atan(k g)", "tanh(k g)", "g (1 + t^2)",
                  "g / (1 + t^2)", "sign of g")
varied = ("g", "sinh(k g)", "g^3")  # what the other changes are made with


@dataclass
class Change:
    """What is different from the model as it is written."""

    function: str = "g"
    factors: list | None = None  # c or k, one instance for each; else those of the function
    state_unit: float = 1.0
    time_unit: float = 1.0  # negative: backwards
    begin: float = 0.0
    order: str = "as written"  # or "reversed", "turned"
    doubled: str = ""  # "before", "behind": each function once more, which only counts
    doubled_function: str = ""  # by which those are written; empty: as the others
    cuts: int = 0  # calls at random times, each of which begins with the states of the last one
    phases: int = 0  # of equal length, in one call
    tolerance: float = 0.0  # of events, as a value of g, where the function is c g
    method: str = "tsitouras_5"
    first_step: float | None = None
    largest_step: float | None = None  # else the model's
    seed: int = 0
    others: dict = field(default_factory=dict)

    def parts(self):
        """The rows of the table that it counts for."""
        made = {"units": self.state_unit != 1 or abs(self.time_unit) != 1, "backwards": self.time_unit < 0,
                "later": self.begin != 0, "permuted": self.order != "as written",
                "doubled": self.doubled and not self.doubled_function, "doubled otherwise": self.doubled_function,
                "cut into calls": self.cuts, "cut into phases": self.phases, "tolerance": self.tolerance,
                self.method: self.method != "tsitouras_5",
                "other steps": self.first_step is not None or self.largest_step is not None}
        return [self.function, *(part for part, is_so in made.items() if is_so)]

    def label(self):
        return ", ".join(self.parts())


def applies(motion, change, events):
    """Whether the model is to have the same events with this change."""
    for function in (change.function, change.doubled_function):
        if function in of_positive_sides and not all(e.positive for e in events):
            return False
        if function in without_slope and not motion.jumps:
            return False
    if change.doubled and any(e.stop_after for e in events):
        return False
    if change.doubled_function and not {change.function, change.doubled_function} <= set(same_roundings):
        return False
    if change.method == "runge_kutta_4" and motion.name == "long_touch":  # its steps are too long
        return False
    if change.tolerance and motion.kind == "touch":
        return False
    return motion.splits or not (change.cuts or change.phases)


def event_order(change, count):
    if change.order == "reversed":
        return list(range(count))[::-1]
    if change.order == "turned":
        return [(j + 1) % count for j in range(count)]
    return list(range(count))


def written(motion, change):
    """The model and its events, in the model's own order."""
    factor = my.parameter("factor")
    count = len(motion.start)
    states = [my.state(f"y{i}") for i in range(count)]
    modes = [my.integer_accessory(f"m{i}") for i in range(len(motion.modes))]
    s, t = states, my.time
    if change.state_unit != 1:
        s = [y / change.state_unit for y in states]
    if change.begin:
        t = t - change.begin
    if change.time_unit != 1:
        t = t / change.time_unit
    derivatives, crossings = motion.write(s, modes, t)
    events = []
    accessories = {m: None for m in modes}

    def logged(name, depth):
        n = my.integer_accessory("n" + name)
        accessories[n] = None
        do = {n: n + 1}
        for k in range(depth):
            at = my.accessory(f"at{name}_{k}")
            accessories[at] = None
            do[at] = my.where(n == k, my.time, at)
        return do

    def function_of(e, name):
        return functions[name][0](e.left - e.right, factor, t, e)

    for j in event_order(change, len(crossings)):
        e = crossings[j]
        depth = min(len(e.times) + 1, log_length)
        do = logged(str(j), depth)
        for (kind, i), value in e.do.items():
            if kind == "state":
                do[states[i]] = value if change.state_unit == 1 else value * change.state_unit
            elif kind == "mode":
                do[modes[i]] = value
            else:
                do[my.end_phase] = my.integer_accessory(f"n{j}") >= 0
        tolerance = {"tolerance": change.tolerance * change.factors[0]} if change.tolerance else {}
        one = my.event(function_of(e, change.function), name=f"e{j}", direction=e.direction, stop_after=e.stop_after,
                       do=do, **tolerance)
        twin = None
        if change.doubled:
            twin = my.event(function_of(e, change.doubled_function or change.function), name=f"d{j}",
                            direction=e.direction, do=logged(f"d{j}", depth))
        events.extend(one for one in ((twin, one) if change.doubled == "before" else (one, twin)) if one is not None)
    equations = {y: f * (change.state_unit / change.time_unit) for y, f in zip(states, derivatives)}
    model = my.model(equations, events=events, accessories=accessories, parameters=["factor"], name=motion.name)
    return model, crossings


def solved(motion, change):
    """Runs the cases of a change: the values at the end by name, with "t" and "status", one for each factor."""
    model, crossings = written(motion, change)
    factors = np.asarray(change.factors if change.factors is not None else functions[change.function][1], float)
    size = len(factors)
    values = {f"y{i}": np.full(size, y * change.state_unit) for i, y in enumerate(motion.start)}
    values |= {f"m{i}": np.full(size, m) for i, m in enumerate(motion.modes)}
    for j, e in enumerate(crossings):
        for name in (f"{j}", f"d{j}") if change.doubled else (f"{j}",):
            values["n" + name] = np.zeros(size, int)
            for k in range(min(len(e.times) + 1, log_length)):
                values[f"at{name}_{k}"] = np.full(size, -1e300)
    names = list(values)
    unit = abs(change.time_unit)
    largest = motion.largest_step if change.largest_step is None else change.largest_step
    options = dict(method=change.method, rtol=1e-12, atol=motion.atol * change.state_unit, device="cpu:1",
                   interpreted=True, maximum_step=largest * unit, **(motion.solve | change.others))
    if change.method == "runge_kutta_4":
        options["step"] = 2.0**-6 * unit
    if change.first_step is not None:
        options["step"] = change.first_step * unit
    times = [0.0, motion.end]
    if change.cuts:
        drawn = random.Random(change.seed)
        times = [0.0, *sorted(away_from_events(drawn, motion, crossings) for _ in range(change.cuts)), motion.end]
    if "phase_length" in motion.solve:
        options["phase_length"] *= unit
    if change.phases:
        options |= dict(phases=change.phases, phase_length=motion.end / change.phases * unit)
    run = None
    for begin, end in zip(times, times[1:]):
        run = my.solve(model, {"factor": factors}, start=values,
                       time=(begin * change.time_unit + change.begin, end * change.time_unit + change.begin), **options)
        values = {name: np.array(run[name]) for name in names}
    values["t"], values["status"] = np.array(run.t_last), list(run.status)
    values["size"] = size
    return values, crossings, factors


def away_from_events(drawn, motion, crossings):
    """A random time at which nothing happens."""
    while True:
        t = drawn.uniform(0, motion.end)
        if all(abs(t - at) > 1e-6 for e in crossings for at in e.times):
            return t


def faults(motion, change, values, crossings, i):
    """What is wrong with an instance, as sentences."""
    found = []

    def ask(condition, text):
        if not condition:
            found.append(text)

    def model_time(t):
        return float((t - change.begin) / change.time_unit)

    # What t resolves where it begins late, and the times at which a function is within its tolerance: it changes at a
    # rate of at least 1e-3 where it is zero, but for touches.
    coarse = (64 * 2.0**-52 * abs(change.begin / change.time_unit) + 2e3 * change.tolerance) * motion.amplified
    method_error = 1e-8 if change.method == "runge_kutta_4" and not motion.exact else 0
    ask(values["status"][i] == motion.status, f"status {values['status'][i]}, right {motion.status}")
    end, end_bound = motion.final_time or (motion.end, 0)
    t = model_time(values["t"][i])
    ask(abs(t - end) <= end_bound + coarse + method_error * motion.amplified, f"ends at {t!r}, right {end!r}")
    for state, (value, bound) in motion.final.items():
        y = float(values[f"y{state}"][i] / change.state_unit)
        ask(abs(y - value) <= bound + coarse, f"state {state} ends as {y!r}, right {value!r}")
    for j, e in enumerate(crossings):
        for name in (f"{j}", f"d{j}") if change.doubled else (f"{j}",):
            count, right = int(values["n" + name][i]), len(e.times)
            ask(count == right or motion.open_end and count >= right,
                f"event {name} fires {count} times, right {right}")
            for k in range(min(right, log_length, count)):
                at, bound = model_time(values[f"at{name}_{k}"][i]), motion.bound(k, e.times[k])
                bound += (coarse + method_error * motion.amplified) * (k + 1)
                ask(abs(at - e.times[k]) <= bound,
                    f"event {name} no. {k + 1} at {at!r}, right {e.times[k]!r} within {bound:.1e}")
        if change.doubled and not change.doubled_function:
            for k in range(min(len(e.times), log_length)):
                at, twin = float(values[f"at{j}_{k}"][i]), float(values[f"atd{j}_{k}"][i])
                ask(at == twin, f"event {j} no. {k + 1} at {at!r}, its double at {twin!r}")
    return found


class Table:
    """How many cases there were and failed, by change and by kind of model."""

    def __init__(self):
        self.run, self.failed = collections.Counter(), collections.Counter()

    def add(self, motion, change, wrong):
        for row in (("all", "all"), *(("change", part) for part in change.parts()), ("kind", motion.kind)):
            self.run[row] += 1
            self.failed[row] += bool(wrong)

    def text(self):
        rows = ["", f"metamorphic event cases: {self.run['all', 'all']}, failed: {self.failed['all', 'all']}"]
        for of in ("change", "kind"):
            rows.append(f"  failed by {of} (of how many):")
            rows += [f"    {self.failed[row]:5} ({self.run[row]:5})  {row[1]}" for row in self.run
                     if row[0] == of and self.failed[row]]
        return "\n".join(rows)


table = Table()


@pytest.fixture(scope="module", autouse=True)
def counts(request):
    """Prints the table after all tests."""
    yield
    with request.config.pluginmanager.getplugin("capturemanager").global_and_fixture_disabled():
        print(table.text())


def check(motion, change, counted=table):
    """Runs the cases of a change; the faults of all of them, with their numbers."""
    try:
        values, crossings, factors = solved(motion, change)
        wrong = [faults(motion, change, values, crossings, i) for i in range(values["size"])]
    except my.Error as error:
        factors = [0]
        wrong = [[f"refused: {error}"]]
    for one in wrong:
        counted.add(motion, change, one)
    return [f"{motion.name}, {change.label()}, {factor:g}: {'; '.join(one[:4])}" for factor, one in zip(factors, wrong)
            if one]


def crossings_of(motion):
    """The events, for what depends on their directions and sides alone."""
    return motion.write([my.state(f"y{i}") for i in range(len(motion.start))],
                        [my.integer_accessory(f"m{i}") for i in range(len(motion.modes))], my.time)[1]


def with_others(function, **change):
    """A change made with a function and its largest factor."""
    return Change(function, functions[function][1][-1:], **change)


changes = {
    "functions": [Change(function) for function in functions],
    "orders": [
        *(with_others(f, order=order) for f in varied for order in ("reversed", "turned")),
        *(with_others(f, doubled=where) for f in varied for where in ("before", "behind")),
        Change("g", doubled="behind", doubled_function="g^3"),
        Change("g", doubled="before", doubled_function="sinh(k g)", factors=[1.0, 20.0]),
        Change("g", doubled="before", doubled_function="c g", factors=[1e-100, 1e100])],
    "parts": [
        *(with_others(f, time_unit=-1.0) for f in varied), *(with_others(f, begin=2.0**20) for f in varied),
        *(with_others(f, cuts=5, seed=i) for i, f in enumerate(varied)), *(with_others(f, phases=7) for f in varied)],
    "steps": [
        *(with_others(f, first_step=step) for f in varied for step in (1e-9, 1e-3, 0.3)),
        *(with_others(f, largest_step=0.05) for f in varied),
        *(with_others(f, method=method) for f in varied for method in ("cash_karp", "dormand_prince_5",
                                                                      "runge_kutta_4"))],
    "tolerances": [Change("c g", [scale], tolerance=1e-9) for scale in (1.0, 1e-100, 1e100)],
}


def applying(motion, changes):
    events = crossings_of(motion)
    return [change for change in changes if applies(motion, change, events)]


@pytest.mark.parametrize("motion", models.motions, ids=lambda motion: motion.name)
@pytest.mark.parametrize("which", changes)
def test_the_same_sign_has_the_same_events(which, motion):
    wrong = [fault for change in applying(motion, changes[which]) for fault in check(motion, change)]
    assert not wrong, "\n".join(wrong)


def test_the_closed_forms_are_those_of_short_steps_with_many_samples():
    """What all other tests compare with."""
    wrong = [fault for motion in models.motions for fault in check(motion, Change(
        largest_step=1e-3 if motion.kind == "touch" else 0.02, others={"sub_samples": 4}), Table())]
    assert not wrong, "\n".join(wrong)


units = [(2.0**20, 2.0**-30), (2.0**-100, 1.0), (1.0, 2.0**100)]


@pytest.mark.parametrize("motion", models.motions, ids=lambda motion: motion.name)
@pytest.mark.parametrize("function, step", [("g", None), ("g", 2.0**-10), ("sinh(k g)", None)])
def test_units_that_are_powers_of_two_change_no_bit(motion, function, step):
    wrong = []
    factors = functions[function][1][-1:]
    base, crossings, _ = solved(motion, Change(function, factors, first_step=step))
    for state_unit, time_unit in units:
        change = Change(function, factors, state_unit=state_unit, time_unit=time_unit, first_step=step)
        values, _, _ = solved(motion, change)
        found = [f"{name}: {float(values[name][0]) / unit!r} instead of {float(base[name][0])!r}"
                 for name, unit in [("t", time_unit), *((f"y{i}", state_unit) for i in range(len(motion.start))),
                                    *((f"at{j}_{k}", time_unit) for j, e in enumerate(crossings)
                                      for k in range(min(len(e.times), log_length))),
                                    *((f"n{j}", 1) for j in range(len(crossings)))]
                 if values[name][0] != -1e300 and values[name][0] / unit != base[name][0]]
        found += [] if values["status"] == base["status"] else [f"{values['status']}, not {base['status']}"]
        table.add(motion, change, found)
        wrong += [f"{function}, units {state_unit:g} and {time_unit:g}: {'; '.join(found[:3])}"] if found else []
    assert not wrong, "\n".join(wrong)


def test_an_action_that_scales_the_function_at_its_event_does_not_make_it_fire_again():
    """What is left of v at its event is an error of rounding: so is any multiple of it."""
    x, v, k, factor, n = *my.states("x v"), my.parameter("k"), my.shared("factor"), my.integer_accessory("n")
    stiffness = np.linspace(1, 2, 200)
    turns = np.floor((60 * np.sqrt(stiffness) + 1.5 * np.pi) / (2 * np.pi))
    functions = (v, 1e20 * v, my.sinh(5 * v), my.exp(v) - 1, v * v * v)
    for function, factors in zip(functions, [(0.9, 1 + 1e-9, 3, -1, -5)] * 4 + [(0.9, 1.9, -1)]):
        model = my.model({x: v, v: -k * x}, accessories={n: 0},
                         events=my.event(function, direction="falling", do={v: factor * v, n: n + 1}))
        for value in factors:
            run = my.solve(model, {k: stiffness, factor: value}, start={x: 0, v: 1}, time=(0, 60), rtol=1e-5,
                           method="cash_karp", device="cpu", interpreted=True)
            assert (run["n"] == turns).all(), (function, value)


def test_neighbours_change_no_bit():
    """All motions: an instance among others and alone."""
    wrong = []
    for motion in models.motions:
        together, _, factors = solved(motion, Change("c g", scales))
        for i in (0, 3, 7):
            alone, _, _ = solved(motion, Change("c g", [factors[i]]))
            found = [name for name in alone if name != "size" and alone[name][0] != together[name][i]]
            table.add(motion, Change("c g"), found)
            wrong += [f"{motion.name}, {factors[i]:g}: {found}"] if found else []
    assert not wrong, "\n".join(wrong)


def drawn_change(drawn, motion):
    """A combination of changes."""
    function = drawn.choice(list(functions))
    factors = [10.0**drawn.uniform(-300, 300)] if function == "c g" else [drawn.choice(functions[function][1])]
    change = Change(function, factors, seed=drawn.getrandbits(30))
    if drawn.random() < 0.3:
        change.order = drawn.choice(["reversed", "turned"])
    if drawn.random() < 0.3:
        change.doubled = drawn.choice(["before", "behind"])
        if factors == [1.0] and drawn.random() < 0.5:
            change.doubled_function = drawn.choice(["g", "g^3", "g^5", "g |g|", "g (1 + t^2)", "sinh(k g)",
                                                   "atan(k g)"])
    if drawn.random() < 0.3:
        change.state_unit = 2.0**drawn.randint(-40, 40)
    if drawn.random() < 0.4:
        change.time_unit = drawn.choice([-1.0, 1.0]) * 2.0**drawn.randint(-40, 40)
    if drawn.random() < 0.2:
        change.begin = drawn.choice([-1.0, 1.0]) * 2.0**drawn.randint(0, 20) * abs(change.time_unit)
    if drawn.random() < 0.3:
        change.cuts = drawn.randint(1, 8)
    elif drawn.random() < 0.3:
        change.phases = drawn.choice([2, 3, 5, 7, 11])
    if drawn.random() < 0.3:
        change.first_step = motion.end * 10.0**drawn.uniform(-12, 0)
    if drawn.random() < 0.3:
        change.largest_step = motion.largest_step * drawn.uniform(0.1, 1)
    change.method = drawn.choice(["tsitouras_5", "tsitouras_5", "cash_karp", "dormand_prince_5"])
    if function in ("g", "c g") and motion.kind != "touch" and not change.begin:
        change.tolerance = drawn.choice([0.0, 10.0**drawn.uniform(-12, -7)])
    return change


def random_cases(count, seed):
    """Draws and checks cases; their counts and faults."""
    drawn, counted, wrong = random.Random(seed), Table(), []
    events = {motion.name: crossings_of(motion) for motion in models.motions}
    while counted.run["all", "all"] < count:
        motion = drawn.choice(models.motions)
        change = drawn_change(drawn, motion)
        if applies(motion, change, events[motion.name]):
            wrong += [f"{one}\n    {change}" for one in check(motion, change, counted)]
    return counted, wrong


def test_functions_of_one_crossing_fire_together_however_flat_they_are():
    """The action of one resets the state before the other crosses, if they do not."""
    cases = [
        ("turned_round", Change("g / (1 + t^2)", [1.0], time_unit=-128.0, doubled="before", doubled_function="g^5")),
        ("neuron", Change("g |g|", [1.0], begin=-16384.0, doubled="behind", doubled_function="atan(k g)",
                          method="cash_karp", largest_step=0.25188328799727056)),
        ("four_balls", Change("g^3", [1.0], order="turned", doubled="before", doubled_function="atan(k g)",
                              first_step=0.033510682106381966, largest_step=0.08171679370096055)),
        ("two_balls", Change("g^5", [1.0], order="turned", doubled="before", doubled_function="g |g|", cuts=6,
                             seed=365469946)),
        # A step ends at the very crossing, at which only the steeper of both has crossed by more than its rounding.
        ("corners", Change("g", [1.0], doubled="behind", doubled_function="g^5", method="runge_kutta_4")),
        ("pulse_coupled", Change("g", [1.0], doubled="behind", doubled_function="g^5")),
        # Balls that land together differ by some rounding errors, of which those of flat functions look larger.
        ("four_balls", Change("g (1 + t^2)", [1.0], doubled="before", doubled_function="g^5")),
        ("four_balls", Change("g^5", [1.0], state_unit=2.0**31, doubled="behind", doubled_function="atan(k g)",
                              phases=11))]
    wrong = [fault for name, change in cases for fault in check(models.by_name[name], change)]
    assert not wrong, "\n".join(wrong)


def test_of_functions_that_cross_together_none_is_lost_to_the_tolerance_of_another():
    """The doubles have no tolerance. What has one fires, and resets the state, a little before they cross."""
    cases = [
        ("one_contact", Change("g", [1.0], doubled="behind", cuts=8, tolerance=1e-10, seed=594700773)),
        ("two_balls", Change("c g", [1e-70], state_unit=2.0**-11, doubled="before", tolerance=1.58e-11)),
        # They cross within the first 1e-16 of a step.
        ("corners", Change("g", [1.0], state_unit=2.0**-24, time_unit=0.125, doubled="behind", phases=3,
                           tolerance=3.383e-12, method="cash_karp")),
        ("corners", Change("c g", [1e281], time_unit=-65536.0, doubled="before", cuts=7, tolerance=7.9e-11,
                           seed=505502121))]
    wrong = [fault for name, change in cases for fault in check(models.by_name[name], change)]
    assert not wrong, "\n".join(wrong)


def test_a_function_with_an_infinite_slope_where_a_phase_begins_does_not_fire_there():
    wrong = check(models.by_name["zero_at_the_start"], Change("root of g", time_unit=-2.0**-12, phases=5))
    assert not wrong, "\n".join(wrong)


@pytest.mark.long
def test_random_combinations_have_the_same_events():
    counted, wrong = random_cases(500, 1)
    assert not wrong, "\n".join(wrong)


if __name__ == "__main__":
    import argparse
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--random", type=int, default=5000, help="number of cases (default: 5000)")
    arguments.add_argument("--seed", type=int, default=1)
    arguments.add_argument("--quiet", action="store_true", help="the counts alone")
    given = arguments.parse_args()
    counts, faulty = random_cases(given.random, given.seed)
    if not given.quiet:
        print("\n".join(faulty))
    print(counts.text())
    sys.exit(bool(faulty))
