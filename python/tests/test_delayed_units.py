# SPDX-License-Identifier: MIT
"""Coupled units that see each other late: against the theory of synchronised oscillators and the method of steps by
SciPy, and that order, threads, batches and an end in the middle change no bit."""

import pathlib
import signal
import subprocess
import sys

import numpy as np
import pytest

import myriad_ode as my
from myriad_ode.codegen.unit_writer import unit_form

n = 24
oscillators = my.units(n)
angle, = oscillators.states("angle")
speed, strength, tau = oscillators.parameter("speed"), *my.parameters("strength tau")
A = oscillators.full_coupling("A", np.ones((n, n)) / n)
sine, cosine = A @ my.delayed(np.sin(angle), tau), A @ my.delayed(np.cos(angle), tau)
late = my.model({angle: speed + strength * (np.cos(angle) * sine - np.sin(angle) * cosine)}, name="late")
taus = np.linspace(0.2, 1.1, 37)

ring = my.units(4)
x, = ring.states("x")
a, b = my.parameters("a b")
from_left, from_right = ring.parameter("from_left"), ring.parameter("from_right")
history = [my.cos(my.time + i) for i in range(4)]


def of_neighbour(shift, lag):
    """x of the unit so many places before, as it was by a lag of the unit that sees it."""
    return my.delayed(np.roll(x, shift), lag)


cells = my.model({x: a * np.tanh(of_neighbour(1, from_left)) - x - b * of_neighbour(-1, from_right)},
                 history={x: history}, name="cells")
conduction = {from_left: [0.7, 0.3, 1.1, 0.5], from_right: [0.4, 0.9, 0.6, 0.8]}


# -- Recorded ----------------------------------------------------------------------------------------------------------

def test_values_with_one_lag_are_one_lag_for_the_library():
    text = late.cpp("late")
    assert "MYRIAD_FUNCTION static int same_lag(int) {" in text and text.count("return p[tau];") == 1
    y, z = my.states("y z")
    mixed = my.model({y: my.delayed(y + z, tau) + my.delayed_slope(y, tau), z: my.delayed(y, 2.0)}).cpp("mixed")
    assert "    if (number == z_past) return y_past;\n        return number;\n" in mixed
    assert "same_lag" not in cells.cpp("cells")


def test_each_unit_has_a_history_of_its_own():
    run = my.solve(cells, {a: 0, b: 1, from_left: 1, from_right: 1}, start={x: 0}, time=(0, 0.5), rtol=1e-10,
                   atol=1e-12)
    # x_i' = -x_i - cos(t - 1 + i + 1), x_i(0) = 0
    for i in range(4):
        begin, end = (i + 1) % 4 - 1, (i + 1) % 4 - 0.5
        expected = -(np.cos(end) + np.sin(end) - np.exp(-0.5) * (np.cos(begin) + np.sin(begin))) / 2
        assert run[f"x_{i}_end"][0] == pytest.approx(expected, abs=1e-9)


def springs(count=20, **more):
    """Units with lags of their own, slopes of the past, hooks, events and a history that read it, also of others."""
    units = my.units(count, **more)
    u, v = units.states("u v")
    lag, start, seen = units.parameter("lag"), units.shared("start"), units.accessory("seen")
    far = my.delayed(np.roll(u, 1), lag)
    model = my.model({u: v - 0.3 * far, v: 0.2 * my.delayed_slope(u, lag) - u + 0.1 * np.roll(far, 3)},
                     accessories={seen: 0}, history={u: start + my.sin(my.time)},
                     events=units.events(u + 0.1 * np.roll(far, 2), name="pass",
                                         do=lambda i: {
                                             v[i]: v[i] + 0.1 * far[i], seen[i]: seen[i] + far[(i + 1) % count]}))
    values = {lag: list(0.4 + 0.03 * np.arange(count)), start: np.linspace(0.1, 0.5, count)}
    return model, values, {u: np.linspace(0.1, 0.5, count), v: 0}


def test_units_with_delays_are_those_of_one_unit_for_gpus():
    text = late.device_source("tsitouras_5", "double")[0]
    for written in ("enum unit_delayed { angle_past, n_unit_delayed };", "lag(int, const auto& p)",
                    "myriad::same_coupling(published_1, 0)", "p.unit_delayed[angle_past]"):
        assert written in text, written
    model, _, _ = springs()
    text = model.device_source("tsitouras_5", "double")[0]
    for written in ("enum unit_delayed { u_past, u_slope, n_unit_delayed };", "return (unit + 19) % 20;",
                    "return R(p[lag_0 + unit]);", "p.of(unit_17).unit_delayed[u_past]",
                    "return number == u_slope;", "lane.of(unit_1).unit_delayed[u_past]",
                    "history([[maybe_unused]] int unit, "):
        assert written in text, written


@pytest.mark.parametrize("history, equation", [
    (lambda i: my.cos(my.time + i), lambda x: -my.delayed(x, 1.0)), (None, lambda x: -my.delayed(x, 1 + x * x)),
    (None, lambda x: -my.delayed(x[0], 1.0) * x), (None, lambda x: -my.delayed(x, 1 + 0.1 * np.arange(20)))])
def test_units_with_delays_that_are_not_alike_are_written_out_for_gpus(history, equation):
    x = my.units(20).state("x")
    model = my.model({x: equation(x)}, history=None if history is None else {x: [history(i) for i in range(20)]})
    assert model.device_source("tsitouras_5", "double") == model.source()


def test_units_with_delays_are_the_same_as_one_unit_and_written_out():
    for (model, values, start), more in ((springs(8), dict(rtol=1e-8, atol=1e-8)), (springs(8), dict(step=1 / 64))):
        header = "#include <myriad/coupled_units.hpp>\n"
        as_units = my.CppModel(header + unit_form(model).source("springs"), "springs",
                               model.states, model.parameters, model.shared, accessories=model.accessories,
                               events=[one.name for one in model.events])
        by_name = {f"{key[i].value[1]}": one for key, several in values.items() for i, one in enumerate(several)}
        begin = {state.value[1]: one for key, several in start.items()
                 for state, one in zip(key, np.broadcast_to(several, 8))}
        runs = [my.solve(model, values, start=start, time=(0, 2), device="cpu", history_steps=4096, **more),
                my.solve(as_units, by_name, start=begin, time=(0, 2), device="cpu", history_steps=4096, **more)]
        assert (runs[0].status == "success").all()
        assert any(runs[0][f"seen_{i}"][0] != 0 for i in range(8))
        for name in (*model.states, *model.accessories):
            np.testing.assert_array_equal(runs[0][name], runs[1][name], err_msg=name)


# -- Solved ------------------------------------------------------------------------------------------------------------

def test_late_oscillators_have_the_frequency_of_the_theory():
    run = my.solve(late, {speed: 1, strength: 0.6, tau: taus}, start={angle: 0.02 * np.arange(n)}, time=(0, 210),
                   samples=[200, 210], rtol=1e-9, atol=1e-9)
    frequency = np.ones(37)
    for _ in range(300):  # Omega = omega - K sin(Omega tau): Yeung, Strogatz, Phys. Rev. Lett. 82 (1999) 648
        frequency = 1 - 0.6 * np.sin(frequency * taus)
    for i in (0, n - 1):
        np.testing.assert_allclose(np.diff(run[f"angle_{i}_sample"], axis=1)[:, 0] / 10, frequency, atol=1e-8)


def by_steps(t_end):
    """`cells` by the method of steps: SciPy integrates over the shortest lag at a time, with the past as it was."""
    from scipy.integrate import solve_ivp
    left, right = np.array(conduction[from_left]), np.array(conduction[from_right])
    pieces = []

    def past(unit, t):
        if t <= 0:
            return np.cos(t + unit)
        return next(piece for end, piece in pieces if t <= end + 1e-12)(t)[unit]

    def slope(t, y):
        return [1.4 * np.tanh(past((i - 1) % 4, t - left[i])) - y[i] - 0.8 * past((i + 1) % 4, t - right[i])
                for i in range(4)]

    lags = sorted({*left, *right})
    points = {0.0}
    for _ in range(4):  # where derivatives of lower orders jump
        points |= {round(t + lag, 12) for t in points for lag in lags if t + lag < t_end}
    points = sorted({*points, *np.arange(0, t_end, lags[0]), t_end})
    y = np.cos(np.arange(4)) + 0.3
    for begin, end in zip(points, points[1:]):
        if end - begin < 1e-9:
            continue
        found = solve_ivp(slope, (begin, end), y, method="DOP853", rtol=1e-11, atol=1e-12, dense_output=True)
        pieces.append((end, found.sol))
        y = found.y[:, -1]
    return y


@pytest.mark.parametrize("method", ["dormand_prince_5", pytest.param("verner_7", marks=pytest.mark.long)])
def test_a_ring_with_conduction_times_by_the_method_of_steps(method):
    pytest.importorskip("scipy")
    run = my.solve(cells, {a: 1.4, b: 0.8, **conduction}, start={x: np.cos(np.arange(4)) + 0.3}, time=(0, 4),
                   method=method, rtol=1e-10, atol=1e-11, history_steps=2048)
    np.testing.assert_allclose([run[f"x_{i}_end"][0] for i in range(4)], by_steps(4.0), atol=3e-9)


def test_a_matrix_of_lags_is_a_lag_for_each_pair():
    pairs = 0.5 + 0.1 * np.add.outer(np.arange(4), 2 * np.arange(4))
    seen = [sum(my.delayed(x[j], float(pairs[i, j])) for j in range(4)) for i in range(4)]
    model = my.model({x: -x + 0.2 * np.array(seen, dtype=object)}, name="pairs")
    run = my.solve(model, start={x: [1, 2, 3, 4]}, time=(0, 0.5), rtol=1e-10, atol=1e-12)
    for i in range(4):  # until the shortest lag the past is what it was at the start
        assert run[f"x_{i}_end"][0] == pytest.approx(2 + (i - 1) * np.exp(-0.5), abs=1e-9)


def test_derivatives_by_the_lag_of_units_equal_differences():
    options = dict(start={angle: 0.3 * np.arange(n)}, time=(0, 3), rtol=1e-10, atol=1e-10)
    run = my.solve(late, {speed: 1, strength: 0.6, tau: 0.8}, free=[tau], **options)
    h = 1e-4
    up, down = (my.solve(late, {speed: 1, strength: 0.6, tau: 0.8 + step}, **options) for step in (h, -h))
    for i in (0, 11):
        expected = (up[f"angle_{i}_end"] - down[f"angle_{i}_end"]) / (2 * h)
        np.testing.assert_allclose(run[f"angle_{i}_by_tau_end"], expected, atol=1e-6)


# -- Order, threads, and an end in the middle --------------------------------------------------------------------------

options = dict(start={angle: 0.3 * np.arange(n)}, time=(0, 12), rtol=1e-6, atol=1e-6)


def study_of(values, **more):
    return my.study(late, {tau: values, speed: np.linspace(1, 1.5, n)[:, None] * np.ones(len(values)), strength: 0.6},
                    keep=[angle[0], angle[n - 1]], **{**options, **more})


def test_order_threads_and_chunks_change_no_bit():
    def run(values, device):
        return my.solve(late, {tau: values, speed: np.linspace(1, 1.5, n), strength: 0.6}, device=device, **options)

    whole, back, one = run(taus, "cpu:1"), run(taus[::-1], "cpu:2"), run(taus[17], "cpu:1")
    assert whole.report.failed == 0
    for i in range(n):
        np.testing.assert_array_equal(back[f"angle_{i}"][::-1], whole[f"angle_{i}"])
        assert one[f"angle_{i}"][0] == whole[f"angle_{i}"][17]


SLOW = f"""
import sys
sys.path.insert(0, {str(pathlib.Path(__file__).parent)!r})
from test_delayed_units import long_study
begun = lambda done, total: done > 10 and print("begun", flush=True)
long_study().run(sys.argv[1], chunk=3, device="cpu:1", progress=begun)
"""


def long_study():
    return my.study(late, my.grid({tau: my.linspace(0.2, 1.1, 37)}), start={angle: 0.3 * np.arange(n), speed: 1,
                    strength: 0.6}, keep=[angle[0], angle[n - 1]], time=(0, 60), maximum_step=1 / 256,
                    history_steps=512, rtol=1e-6, atol=1e-6)


def test_a_study_of_units_that_was_killed_goes_on_to_the_same_bits(tmp_path):
    expected = long_study().run(device="cpu:2")
    child = subprocess.Popen([sys.executable, "-c", SLOW, str(tmp_path / "store")], stdout=subprocess.PIPE, text=True)
    assert child.stdout.readline() == "begun\n"
    child.send_signal(signal.SIGKILL)
    child.communicate(timeout=60)
    before = my.open_study(tmp_path / "store").done
    assert 0 < before < 37
    result = long_study().run(tmp_path / "store", device="cpu:2")
    assert result.complete and result.instances == 37 - before
    for name in ("angle_0_end", f"angle_{n - 1}_end"):
        np.testing.assert_array_equal(result[name], expected[name])


# -- Refused -----------------------------------------------------------------------------------------------------------

def test_teams_take_no_units_whose_delays_change():
    together = my.units(4, threads_per_instance=4)
    z, = together.states("z")
    with pytest.raises(my.Error, match="threads_per_instance is 4 .* teams of threads take no units whose delays"):
        my.model({z: -my.delayed(z, 1 + z * z)})
    assert my.model({z: -my.delayed(z, 1.0)}).device_source("tsitouras_5", "double")
