# SPDX-License-Identifier: MIT
"""Models with noise: against solutions that are functions of the path, what a path depends on, and what is refused."""

import pathlib
import pickle
import re
import signal
import subprocess
import sys

import numpy as np
import pytest

import myriad_ode as my
from myriad_ode.models import methods

ROOT = pathlib.Path(__file__).resolve().parents[2]
x, y, w = my.states("x y w")
mu, sigma, k = my.parameters("mu sigma k")
W, V = my.wiener("W V")


def shared_noise():
    """A geometric Wiener process beside its Wiener process."""
    return my.model({x: mu * x, w: 0}, noise={x: {W: sigma * x}, w: {W: 1}})


def diagonal():
    """One with a process of its own, which is the first, and an Ornstein-Uhlenbeck process."""
    return my.model({x: mu * x, y: -k * y}, noise={x: sigma * x, y: sigma})


constants = {mu: 0.3, sigma: 0.5}
of_diagonal = dict(start={x: 1, y: 2}, time=(0, 1), step=1 / 64, seed=5)


def solved(model, paths, method="euler_maruyama", **more):
    return my.solve(model, {**constants, k: 1.5} if "k" in model.parameters else constants, method=method,
                    **{"paths": paths, "start": {x: 1, w: 0}, "time": (0, 1), "seed": 5, **more})


def exact(path, correction=0.0):
    """The geometric process at t = 1, of Ito's equation with the correction one."""
    return np.exp(constants[mu] - correction * constants[sigma]**2 / 2 + constants[sigma] * path)


def error_of(run, path, correction=0.0):
    return np.sqrt(((run["x"] - exact(path, correction))**2).mean())


# -- Solutions ---------------------------------------------------------------------------------------------------------

def test_a_path_is_that_of_the_solution_and_the_same_for_all_steps_and_models():
    coarse, fine = (solved(shared_noise(), 2000, step=h, noise_step=1 / 64) for h in (1 / 16, 1 / 256))
    path = coarse["w"]
    np.testing.assert_allclose(path, fine["w"], atol=1e-13)
    assert abs(path.mean()) < 4 / np.sqrt(2000) and abs(path.var() - 1) < 4 * np.sqrt(2 / 2000)
    # of strong order 1/2: a sixteenth of the step has a quarter of the error, or a fourth to a third in this sample
    assert 3 < error_of(coarse, path, 1) / error_of(fine, path, 1) < 5.5 and error_of(fine, path, 1) < 0.03
    heun = [error_of(solved(shared_noise(), 2000, "stochastic_heun", step=h, noise_step=1 / 64), path)
            for h in (1 / 16, 1 / 256)]
    assert 12 < heun[0] / heun[1] < 20 and heun[1] < 1e-3  # of order 1, for Stratonovich's equation
    # another model's process of the same number, of the same instance, is the same
    milstein = [error_of(solved(diagonal(), 2000, "milstein", start={x: 1, y: 2}, step=h, noise_step=1 / 64), path, 1)
                for h in (1 / 16, 1 / 256)]
    assert 12 < milstein[0] / milstein[1] < 20 and milstein[1] < 3e-3
    sriw1 = [error_of(solved(diagonal(), 2000, "sriw1", start={x: 1, y: 2}, step=h, noise_step=1 / 64), path, 1)
             for h in (1 / 16, 1 / 64)]
    assert 6.5 < sriw1[0] / sriw1[1] < 9.5 and sriw1[1] < 1e-3


def test_an_ornstein_uhlenbeck_process_has_its_mean_and_variance():
    n, rate = 20_000, 1.5
    model = my.model({y: -k * y}, noise={y: sigma})
    run = my.solve(model, {k: rate, sigma: 0.5}, start={y: 2}, time=(0, 1), paths=n, method="sra1", step=1 / 32,
                   phases=2, record=[y], samples=3, seed=3)
    variance = 0.25 * (1 - np.exp(-2 * rate)) / (2 * rate)
    end = run["y"][:, 0]
    assert abs(end.mean() - 2 * np.exp(-rate)) < 4 * np.sqrt(variance / n)
    assert abs(end.var() - variance) < 4 * variance * np.sqrt(2 / n)
    np.testing.assert_array_equal(run["y_sample"][:, 2], end)
    middle = 0.25 * (1 - np.exp(-rate)) / (2 * rate)
    assert abs(run["y_sample"][:, 1].var() - middle) < 4 * middle * np.sqrt(2 / n)
    # a phase that begins anew has a path of its own
    innovation = run["y"][:, 1] - end * np.exp(-rate)
    assert abs(innovation.var() - variance) < 4 * variance * np.sqrt(2 / n)
    assert abs(np.corrcoef(end, innovation)[0, 1]) < 4 / np.sqrt(n)


def test_noise_may_depend_on_time_and_jump_with_it_where_steps_end():
    """The variance of the integral of a factor that is one in a part of each period, which no step divides."""
    t = my.time
    model = my.model({w: 0}, noise={w: my.where(t % 0.5 < 0.3, 1.0, 0.0)})
    run = my.solve(model, start={w: 0}, time=(0, 1), paths=20_000, step=0.25, seed=2)
    assert run.accepted_steps.max() == 6  # those that end at jumps are shorter
    assert abs(run["w"].var() - 0.6) < 4 * 0.6 * np.sqrt(2 / 20_000)


def test_a_state_that_noise_alone_moves_is_not_taken_for_a_constant():
    equations = {w: 0, x: my.where(my.time < w, 1.0, 0.0)}
    assert my.model(equations).stops and not my.model(equations, noise={w: 1}).stops


@pytest.fixture(scope="module")
def sharing():
    """Two states that share two processes whose noise does not commute: Debrabant and Roessler, Appl. Numer. Math. 59
    (2009) 582-594."""
    r = np.sqrt(2)
    return my.model({x: -273 / 512 * x, y: -x / 160 + (r / 8 - 785 / 512) * y},
                    noise={x: {W: x / 4, V: x / 16}, y: {W: (1 - 2 * r) / 4 * y, V: x / 10 + y / 16}})


def test_means_by_a_weak_method_are_those_of_the_equation(sharing):
    end, paths = 3, 100_000
    run = my.solve(sharing, start={x: 1, y: 1}, time=(0, end), step=end / 16, paths=paths, seed=2, method="dri1")
    for values, exact, bias in (
            (run["x"]**2, np.exp(-end), 0.0015), (run["x"] * run["y"], np.exp(-2 * end), 0.0073),
            (run["y"]**2, (149 * np.exp(-2.5 * end) + np.exp(-end)) / 150, 0.0295)):  # of the method with such steps
        assert abs(values.mean() - exact) < 4 * values.std() / paths**0.5 + bias * exact


def test_a_stiff_drift_takes_long_steps_by_an_implicit_method():
    relaxing, paths, h = my.model({x: 0, y: k * (x - y)}, noise={y: sigma}), 50_000, 0.1
    run = my.solve(relaxing, {k: 1000, sigma: 2}, start={x: 3, y: 0}, time=(0, 10 * h), step=h, paths=paths, seed=2,
                   method="linearly_implicit_euler_maruyama")
    variance = 2**2 * h / ((1 + 1000 * h)**2 - 1)  # of y1 - x = (y - x + sigma dW) / (1 + k h)
    assert abs(run["y"].mean() - 3) < 4 * (variance / paths)**0.5
    assert abs(run["y"].var() / variance - 1) < 4 * (2 / paths)**0.5


# -- Events and extrema ------------------------------------------------------------------------------------------------

def near(values, mean, variance=None, errors=5):
    """Whether the moments of values are those, as far as their number tells."""
    deviation = values.std() / np.sqrt(values.size)
    fourth = ((values - values.mean())**4).mean()
    of_variance = np.sqrt((fourth - values.var()**2) / values.size)
    return (abs(values.mean() - mean) < errors * deviation
            and (variance is None or abs(values.var() - variance) < errors * of_variance))


def test_first_passages_have_their_law_by_long_steps():
    level = my.parameter("level")
    model = my.model({x: mu}, noise={x: sigma}, events=my.event(x - level, direction="rising", stop_after=1))
    run = my.solve(model, {mu: [1.0, 2.0], sigma: 0.8, level: 1.0}, paths=20_000, start={x: 0}, time=(0, 100), step=0.3,
                   seed=2)
    assert (run.status == "stopped_by_event").all() and abs(run["x"] - 1).max() < 1e-14
    for rate, times in zip((1.0, 2.0), run.sweep.unstack(run.t_last)):
        assert near(times, 1 / rate, 0.64 / rate**3)


def test_a_neuron_fires_at_the_mean_rate_and_rests_after_each_spike():
    """A perfect integrator that rests for 0.5 after each spike, by a stop time that its action sets."""
    spikes, awake, wakes = (my.accessory(name) for name in ("spikes", "awake", "wakes"))
    model = my.model({x: mu * awake}, noise={x: sigma * awake}, accessories={spikes: 0, awake: 1, wakes: 1e9},
                     events=my.event(x - 1, direction="rising",
                                     do={spikes: spikes + 1, x: 0, awake: 0, wakes: my.time + 0.5}),
                     stops=my.stop(wakes, do={awake: 1}))
    t_end, paths = 300, 1000
    run = my.solve(model, {mu: 1.0, sigma: 0.5}, paths=paths, start={x: 0}, time=(0, t_end), step=0.2, seed=3)
    # renewals with intervals of mean 1 + 0.5 and variance 0.25, but for the first, which begins awake
    assert near(run["spikes"], t_end / 1.5 + (0.25 / 1.5**2 + 1) / 2 - 1 / 1.5, t_end * 0.25 / 1.5**3, errors=6)


def test_paths_with_events_are_the_same_in_studies_and_in_any_number():
    model = my.model({x: -x}, noise={x: sigma}, accessories={"hits": 0},
                     events=my.event(x - 1, do={x: 0, "hits": my.accessory("hits") + 1}))
    call = dict(time=(0, 50), step=0.1, seed=4)
    run = my.solve(model, {sigma: [0.6, 0.9]}, paths=50, start={x: 0}, **call)
    few = my.solve(model, {sigma: [0.6]}, paths=7, start={x: 0}, **call)
    np.testing.assert_array_equal(few["x"], run["x"][:7])
    study = my.study(model, my.grid({sigma: [0.6, 0.9]}), paths=50, keep=["hits"], start={x: 0}, **call)
    np.testing.assert_array_equal(np.ravel(study.run(chunk=9, device="cpu:1")["hits_end"]), run["hits"])
    assert run["hits"].mean() > 2


def test_extrema_of_paths_have_their_law_by_long_steps():
    model = my.model({x: 0}, noise={x: sigma}, accessories={"top": my.phase_maximum(x), "low": my.phase_minimum(x)})
    run = my.solve(model, {sigma: 2.0}, paths=20_000, start={x: 0}, time=(0, 1), step=0.5, seed=6)
    for size in (run["top"], -run["low"]):  # that of a normal number
        assert near(size, 2 * np.sqrt(2 / np.pi), 4 * (1 - 2 / np.pi))


def test_an_event_that_stays_at_zero_under_noise_ends_the_instance():
    passed = my.accessory("passed")
    model = my.model({x: mu}, noise={x: sigma}, events=my.event(x - 1))
    call = dict(start={x: 0}, time=(0, 5), step=0.1, paths=20)
    assert (my.solve(model, constants | {mu: 1.0}, **call).status == "event_accumulation").all()
    moved = my.model({x: mu}, noise={x: sigma}, accessories={passed: 0},
                     events=my.event(my.where(passed > 0, 1.0, x - 1), do={passed: 1}))
    assert (my.solve(moved, constants | {mu: 1.0}, **call).status == "success").all()


def test_an_event_function_without_a_derivative_along_the_noise_ends_the_instance():
    model = my.model({x: 0}, noise={x: sigma}, events=my.event(my.cbrt(x) - 1, stop_after=1))
    run = my.solve(model, {sigma: [0.5]}, start={x: [0.0]}, time=(0, 5), step=0.1)
    assert run.status == "not_finite"  # of the cube root at zero


def test_methods_whose_steps_are_longer_than_the_drift_takes_have_no_events_and_no_extrema():
    call = dict(start={x: 0}, time=(0, 1), step=0.1, method="linearly_implicit_euler_maruyama")
    for more, what in ((dict(events=my.event(x - 1)), "events"), (dict(accessories={"a": my.phase_maximum(x)}),
                                                                  "extrema")):
        with pytest.raises(my.Error, match=f"the model's {what} are found within steps as if it did not: give method="):
            my.solve(my.model({x: -x}, noise={x: 1}, **more), **call)


@pytest.mark.parametrize("function, start, step", [
    (x**3 - 1, 0.0, 0.5), (x**2 - 1, 0.2, 1.0), (my.exp(x) - np.e, 0.2, 1.0), (my.exp(20 * x) - np.exp(20), 0.2, 0.1),
    (my.tanh(50 * (x - 1)), 0.2, 1.0), (my.where(x > 1, 1.0, -1.0), 0.0, 0.1), (my.cbrt(x - 1), 0.2, 0.5)])
def test_an_event_on_a_noisy_path_is_where_its_function_is_zero_however_bent_that_is(function, start, step):
    model = my.model({x: 1.0}, noise={x: 1.0}, events=my.event(function, stop_after=1), name="bent")
    run = my.solve(model, start={x: start}, time=(0, 1e4), paths=4000, step=step, seed=3)
    assert (run.status == "stopped_by_event").all()
    np.testing.assert_allclose(np.abs(run["x"]), 1, atol=1e-8)


def test_methods_that_follow_no_path_take_no_events_and_no_extrema():
    call = dict(start={x: 0}, time=(0, 1), step=0.1, method="dri1")
    with pytest.raises(my.Error, match="dri1 follows no path, .* the model's events to be found on: give method="):
        my.solve(my.model({x: -x}, noise={x: 1}, events=my.event(x - 1)), **call)
    with pytest.raises(my.Error, match="dri1 follows no path, .* the model's extrema to be found on: give method="):
        my.solve(my.model({x: -x}, noise={x: 1}, accessories={"a": my.phase_maximum(x)}), **call)
    with pytest.raises(my.Error, match="sub_samples is 3, but the model has a diffusion"):
        my.solve(my.model({x: -x}, noise={x: 1}, events=my.event(x - 1)), start={x: 0}, time=(0, 1), step=0.1,
                 sub_samples=3)


# -- What a path depends on --------------------------------------------------------------------------------------------

@pytest.fixture(scope="module")
def whole():
    return my.solve(diagonal(), {mu: [0.1, 0.2], sigma: 0.5, k: 1}, paths=150, **of_diagonal)


def test_paths_are_a_last_axis_and_the_instances_numbers_their_seeds(whole):
    assert whole.shape == (2, 150) and whole.size == 300
    np.testing.assert_array_equal(whole["mu"].reshape(2, 150)[:, 7], [0.1, 0.2])
    flat = my.solve(diagonal(), {mu: np.repeat([0.1, 0.2], 150), sigma: 0.5, k: 1}, **of_diagonal)
    grid = my.solve(diagonal(), my.grid({mu: [0.1, 0.2]}, sigma=0.5, k=1.0), paths=150, **of_diagonal)
    for other in (flat, grid):
        np.testing.assert_array_equal(whole["x"], other["x"])
        np.testing.assert_array_equal(whole["y"], other["y"])
    some = my.solve(diagonal(), {mu: 0.1, sigma: 0.5, k: 1}, paths=20, **of_diagonal)
    np.testing.assert_array_equal(some["x"], whole["x"][:20])
    assert len(np.unique(whole["y"])) == 300
    another = my.solve(diagonal(), {mu: 0.1, sigma: 0.5, k: 1}, paths=20, **{**of_diagonal, "seed": 6})
    assert not np.intersect1d(another["x"], whole["x"]).size


def test_threads_and_order_change_no_bit(whole):
    for more in (dict(device="cpu:1"), dict(device="cpu:2", schedule="dynamic")):
        again = my.solve(diagonal(), {mu: [0.1, 0.2], sigma: 0.5, k: 1}, paths=150, **of_diagonal, **more)
        np.testing.assert_array_equal(whole["x"], again["x"])


def study_of(**more):
    return my.study(diagonal(), my.grid({mu: [0.1, 0.2]}, sigma=0.5, k=1.0), paths=150, keep=[x, y],
                    **{**of_diagonal, **more})


def test_a_study_has_the_paths_of_a_call_by_any_chunks(whole):
    result = study_of().run(chunk=37, device="cpu:1")
    assert result.axes == {"mu": 2, "path": 150}
    np.testing.assert_array_equal(result["x_end"], whole["x"].reshape(2, 150))
    of_options = study_of(seed=None, options=my.Options(seed=5)).run(device="cpu:1")
    np.testing.assert_array_equal(of_options["y_end"], result["y_end"])
    assert not (study_of(seed=6).run(device="cpu:1")["x_end"] == result["x_end"]).any()


def test_a_store_of_another_seed_or_noise_step_is_refused(tmp_path):
    study_of().run(tmp_path / "store", device="cpu:1")
    for other in (dict(seed=6), dict(noise_step=1 / 32)):
        with pytest.raises(my.Error, match="seed|noise_step"):
            study_of(**other).run(tmp_path / "store", device="cpu:1")


SLOW = f"""
import sys
sys.path.insert(0, {str(pathlib.Path(__file__).parent)!r})
from test_noise import long_study
begun = lambda done, total: done and print("begun", flush=True)
long_study().run(sys.argv[1], chunk=50, device="cpu:1", progress=begun)
"""


def long_study():
    return my.study(diagonal(), {mu: 0.1, sigma: 0.5, k: 1}, paths=2000, keep=[x, y],
                    **{**of_diagonal, "step": 1 / 16384})


def test_a_study_that_was_killed_goes_on_along_the_same_paths(tmp_path):
    my.solve(diagonal(), {mu: 0.1, sigma: 0.5, k: 1}, **of_diagonal)  # so that the other process finds the kernel
    child = subprocess.Popen([sys.executable, "-c", SLOW, str(tmp_path / "store")], stdout=subprocess.PIPE, text=True)
    assert child.stdout.readline() == "begun\n"
    child.send_signal(signal.SIGKILL)
    child.communicate(timeout=60)
    before = my.open_study(tmp_path / "store").done
    assert 0 < before < 2000
    result = long_study().run(tmp_path / "store", device="cpu:2")
    assert result.complete and result.instances == 2000 - before
    expected = long_study().run(device="cpu:2")
    np.testing.assert_array_equal(result["x_end"], expected["x_end"])
    np.testing.assert_array_equal(result["y_end"], expected["y_end"])


# -- The model ---------------------------------------------------------------------------------------------------------

def test_a_model_shows_its_noise():
    model = my.model({x: mu * x - y, y: 0}, noise={x: {W: sigma * x, V: -1}, y: {V: 1}}, name="wells")
    assert repr(model) == "<myriad model wells: dx = (mu * x - y) dt + (sigma * x) dW + (-1) dV; dy = dV>"
    assert model.latex() == "\n".join([
        r"\begin{aligned}",
        r"\mathrm{d} x &= \left(\mu \, x - y\right) \, \mathrm{d} t + \left(\sigma \, x\right) \, \mathrm{d} W"
        r" + \left(-1\right) \, \mathrm{d} V \\",
        r"\mathrm{d} y &= \mathrm{d} V", r"\end{aligned}"])
    own = my.model({x: -k, y: 0.5}, noise={"x": "sigma"}, parameters="sigma")
    assert repr(own) == "<myriad model model: dx = (-k) dt + sigma dW_x; dy = 0.5 dt>"
    assert r"\mathrm{d} x &= \left(-k\right) \, \mathrm{d} t + \sigma \, \mathrm{d} W_{x} \\" in own.latex()
    assert r"\mathrm{d} W_{x}" in own._repr_html_()
    taken = my.model({my.state("W_1"): k}, noise={"W_1": 1})
    assert r"\mathrm{d} B_{W_{1}}" in taken.latex()  # W would be taken for the state


def test_noise_of_texts_and_functions():
    by_text = my.model("x' = mu*x; w' = 0", parameters="mu sigma",
                       noise={"x": {"W": "sigma*x"}, "w": {"W": 1}})
    assert by_text.cpp() == shared_noise().cpp()
    by_function = my.model(lambda t, s, mu: [mu * s[0], 0.0], states="x w", noise={x: {W: sigma * x}, w: {"W": 1}})
    assert by_function.cpp() == shared_noise().cpp()


def test_the_cpp_has_a_diffusion():
    text = shared_noise().cpp()
    assert "enum noise { W, n_noise };" in text and "additive_noise" not in text
    assert "return {myriad::vec<R, n_noise>{p[sigma] * y[x]}, myriad::vec<R, n_noise>{R(1)}};" in text
    text = my.model({x: -x, y: x}, noise={y: sigma * my.cos(my.time)}).cpp()
    assert "static constexpr bool additive_noise = true;" in text and "enum noise" not in text
    assert "return {R(0), p[sigma] * myriad::cos(t)};" in text
    assert pickle.loads(pickle.dumps(shared_noise())).cpp() == shared_noise().cpp()
    assert shared_noise().hash != my.model({x: mu * x, w: 0}, noise={x: {W: sigma * x}}).hash
    alone = my.model({x: -k * x}, noise={x: {W: k, V: x}}).cpp()
    assert "return myriad::vec<myriad::vec<R, n_noise>, n_state>{myriad::vec<R, n_noise>{p[k], y[x]}};" in alone


def test_processes_are_numbered_as_noise_names_them():
    assert my.model({x: 0, y: 0}, noise={y: {V: 1}, x: {W: 1, V: 2}}).noise.names == ["V", "W"]


@pytest.mark.parametrize("given, said", [
    (dict(noise={k: 1}), r"noise has a factor of 'k' \(test_noise.py:\d+\), which is no state: there are x, y"),
    (dict(noise={x: 1, "x": 2}), "'x' is given twice in noise"),
    (dict(noise={x: {W: 1, "W": 2}}), "'W' is given twice in the noise of x"),
    (dict(noise={x: {W: 1}, y: 2}), "noise has a factor of y, for a Wiener process of its own, and names processes of "
                                    "x .*: name them for all, as in {y: {W: factor}}"),
    (dict(noise={x: {}}), "noise names no Wiener process"),
    (dict(noise={x: {k: 1}}), r"the noise of x has a factor of k .*: name Wiener processes, as from my.wiener"),
    (dict(noise={x: [1, 2]}), "the noise of x: "),
    (dict(noise=3), "noise is a int"),
    (dict(noise={x: W}), "the Wiener process W stands in an expression or is assigned .*a key of noise= alone"),
    (dict(noise={x: {W: 1}}, after_step={W: 1}), "the Wiener process W stands in an expression or is assigned"),
    (dict(noise={x: {"y": 1}}), "'y' names both a state and a Wiener process"),
    (dict(noise={x: my.parameter("diffusion")}), "'diffusion' names a parameter .* in a model with noise"),
    (dict(noise={x: 1}, triggers=my.trigger(x > 1, do={y: 1})), "a model with noise has no triggers yet .*after_step"),
    (dict(noise={x: 1}, accessories={"a": my.integral(x)}), "has no integrals over a phase yet"),
    (dict(noise={x: 1}, accessories={"a": my.phase_maximum(x)}, events=my.event(x)),
     "has no extrema over a phase beside events yet"),
    (dict(noise={x: 1}, mass_matrix={x: 2}), "a model with noise has no mass matrix yet"),
    (dict(noise={x: 1}, initialise={my.t_end: 3}), "a model with noise has no hooks that assign t_begin or t_end yet"),
])
def test_what_noise_is_no_noise(given, said):
    with pytest.raises(my.Error, match=said):
        my.model({x: -k * x, y: x}, **given)


def test_a_process_in_an_equation_is_refused():
    with pytest.raises(my.Error, match="the Wiener process W stands in an expression"):
        my.model({x: -k * x + W})
    with pytest.raises(my.Error, match="W is no state but a Wiener process"):
        my.model({W: 1.0})


def noisy_units(n=4, **noise):
    """Units in a ring, with a process for each state."""
    units = my.units(n)
    u, v = units.states("u v")
    strength, around = units.parameter("strength"), units.circulant_coupling("A", np.roll(np.eye(n), 1, axis=1), 1)
    return my.model({u: around @ u - u, v: u - v}, noise={u: strength * u, v: sigma}, **noise), (u, v, strength)


def test_units_have_noise_of_their_own_which_is_that_of_the_written_system():
    model, (u, v, strength) = noisy_units()
    states = my.states("u_0 v_0 u_1 v_1 u_2 v_2 u_3 v_3")
    of_u, of_v, factors = states[::2], states[1::2], my.parameters("s_0 s_1 s_2 s_3")
    written = my.model({one: slope for i in range(4) for one, slope in
                        ((of_u[i], of_u[(i + 1) % 4] - of_u[i]), (of_v[i], of_u[i] - of_v[i]))},
                       noise={one: factor for i in range(4) for one, factor in
                              ((of_u[i], factors[i] * of_u[i]), (of_v[i], sigma))})
    each = dict(time=(0, 1), step=1 / 64, seed=5, paths=20)
    units = my.solve(model, {strength: [0.1, 0.2, 0.3, 0.4], sigma: 0.5}, start={u: [1, 2, 3, 4], v: 0}, **each)
    whole = my.solve(written, {**dict(zip(factors, [0.1, 0.2, 0.3, 0.4])), sigma: 0.5},
                     start={**dict(zip(of_u, [1, 2, 3, 4])), **dict.fromkeys(of_v, 0)}, **each)
    for state in written.states:
        np.testing.assert_allclose(units[state], whole[state], rtol=1e-13)
    assert abs(np.corrcoef(units["v_0"], units["v_1"])[0, 1]) < 1


def test_the_cpp_of_units_has_a_diffusion_of_one_unit():
    text, _ = noisy_units(20)[0].device_source("euler_maruyama", "double")
    assert "diffusion([[maybe_unused]] int unit" in text and "coupled_units<" in text
    units = my.units(20)
    u = units.state("u")
    looks = my.model({u: -u}, noise={u: np.roll(u, 1)}).device_source("euler_maruyama", "double")[0]
    assert "coupled_units<" not in looks  # a unit's factors see its own states alone
    named = my.model({u: -u}, noise={one: {W: 1} for one in u}).device_source("euler_maruyama", "double")[0]
    assert "coupled_units<" not in named


# -- Adaptive steps ----------------------------------------------------------------------------------------------------

def test_tolerances_without_a_step_give_adaptive_steps_along_the_same_path():
    model = my.model({x: mu * x}, noise={x: sigma * x})
    values, each = {mu: 0.3, sigma: 0.5}, dict(start={x: 1}, time=(0, 1), seed=5, noise_step=0.25, paths=200)
    path = my.solve(my.model({x: 0}, noise={x: 1}), time=(0, 1), start={x: 0}, step=0.25, seed=5, paths=200)["x"]
    errors = []
    for tolerance in (1e-2, 1e-3, 1e-4):
        run = my.solve(model, values, method="sriw1", rtol=tolerance, atol=tolerance, **each)
        errors.append(np.abs(run["x"] - exact(path, 1)).mean())
        assert errors[-1] < 3 * tolerance and run.report.accepted_steps > 200 * 4
    assert errors[0] > 3 * errors[1] > 9 * errors[2] and run.report.rejected_steps > 200
    result = my.study(model, values, method="sriw1", rtol=1e-4, atol=1e-4, keep=[x], **each).run(chunk=37)
    np.testing.assert_array_equal(result["x_end"].ravel(), run["x"])
    fixed = my.solve(model, values, method="sriw1", rtol=1e-4, step=1 / 4096, **each)
    assert fixed.report.rejected_steps == 0 and np.abs(fixed["x"] - run["x"]).max() < 1e-2


def test_steps_do_not_depend_on_where_the_path_goes_in_them():
    """A relative tolerance has the same steps along all paths of a geometric Wiener process."""
    run = my.solve(my.model({x: mu * x}, noise={x: sigma * x}), {mu: 0.3, sigma: 1.0}, start={x: 1}, time=(0, 1),
                   method="sriw1", rtol=1e-2, atol=1e-9, noise_step=0.25, seed=11, paths=500)
    assert run.report.failed == 0 and set(run.accepted_steps) == {32} and len(set(run.rejected_steps)) == 1


def test_adaptive_steps_of_additive_noise_begin_with_a_64th_of_the_domain():
    model = my.model({x: -x**3}, noise={x: 0.01})
    run = my.solve(model, start={x: 0}, time=(0, 1), method="sra1", rtol=1e-2, atol=1e-2, seed=1, paths=3)
    assert run.accepted_steps.tolist() == [64] * 3


@pytest.mark.parametrize("more, said", [
    (dict(method="milstein"), "milstein takes fixed steps: give step="),
    (dict(method="sriw1", rtol=my.Options().rtol),
     "sriw1 takes fixed steps or adaptive ones: give step=, or rtol= and atol="),
    (dict(method="sriw1", control="rms_norm"), "adaptive steps along a path are halved and doubled, and have no other"),
    (dict(method="sriw1", control="halving", step=0.1), "there is no step-size control 'halving': leave out step="),
])
def test_what_adaptive_steps_along_paths_do_not_take_is_refused(more, said, nothing_compiles):
    with pytest.raises(my.Error, match=said):
        call(diagonal(), **{**dict(step=None, rtol=1e-2), **more})


@pytest.mark.parametrize("given", [dict(rtol=1e-8, atol=1e-8), dict(options=my.Options(atol=1e-8))])
def test_tolerances_that_are_given_are_given_whatever_their_value(given):
    options = pickle.loads(pickle.dumps(given))
    run = my.solve(my.model({x: 0}, noise={x: 1}), start={x: 0}, time=(0, 1), method="sra1", seed=1, **options)
    assert run.report.failed == 0 and run.accepted_steps[0] >= 64


def test_events_with_adaptive_steps_along_paths_are_refused(nothing_compiles):
    with pytest.raises(my.Error, match="the model's events are so far found only with fixed steps: give step="):
        call(my.model({x: -x}, noise={x: 1}, events=my.event(x - 3)), method="sra1", step=None, rtol=1e-2)


def test_instances_with_domains_of_their_own_need_a_noise_step_for_adaptive_steps():
    with pytest.raises(my.Error, match="noise_step is not set, and instances have domains of their own"):
        call(diagonal(), method="sriw1", step=None, rtol=1e-2, time=(0, [1, 2]))


# -- Calls that do not fit ---------------------------------------------------------------------------------------------

@pytest.fixture
def nothing_compiles(monkeypatch):
    """What is refused is refused before any work."""
    monkeypatch.setattr("myriad_ode.solving.solve.kernel_for", None)
    monkeypatch.setattr("myriad_ode.studies.study.kernel_for", None)


def call(model, **more):
    values = dict.fromkeys(model.parameters, 1.0)
    return my.solve(model, values, **{**dict(start=dict.fromkeys(model.states, 1), time=(0, 1), step=0.1), **more})


crossed = my.model({x: -x, y: -y}, noise={x: y, y: 1})
many = my.model({x: 0}, noise={x: {f"W{i}": 1 for i in range(257)}})


@pytest.mark.parametrize("model, more, said", [
    (diagonal(), dict(step=None), "euler_maruyama takes fixed steps: give step="),
    (diagonal(), dict(method="tsitouras_5"), 'the model has noise, which tsitouras_5 would ignore: give '
     'method="euler_maruyama", "milstein", '),
    (diagonal(), dict(method="rodas_5p"), "the model has noise, which rodas_5p would ignore"),
    (diagonal(), dict(method="em"), "there is no method 'em': use \"euler_maruyama\""),
    (diagonal(), dict(method="ImplicitEM"), "no method 'ImplicitEM': use \"linearly_implicit_euler_maruyama\""),
    (diagonal(), dict(control="pi_control"), "euler_maruyama takes fixed steps and has no step-size control"),
    (my.model({x: -x}), dict(method="milstein"), "milstein is for equations with noise, and the model has none"),
    (my.model({x: -x}), dict(paths=3), "paths is 3, and the model has no noise"),
    (diagonal(), dict(paths=0), "paths is 0: give the number of paths"),
    (diagonal(), dict(paths=1.5), "paths is 1.5: give the number of paths"),
    (diagonal(), dict(paths=3, size=4), "3.*4|4.*3"),
    (shared_noise(), dict(method="milstein"), "milstein takes a Wiener process for each state, and the model names "
     "processes, which states may share: give method=\"euler_maruyama\""),
    (crossed, dict(method="milstein"), "whose factor of a state depends on no other state, and that of x depends on y"),
    (crossed, dict(method="sriw1"), "sriw1 takes noise whose factor of a state depends on no other state"),
    (shared_noise(), dict(method="sriw1"), "sriw1 takes a Wiener process for each state"),
    (diagonal(), dict(method="sri1"), "there is no method 'sri1': use \"sriw1\""),
    (diagonal(), dict(method="DRI1"), "there is no method 'DRI1': use \"dri1\""),
    (diagonal(), dict(method="sra1"), "sra1 takes noise that depends on no state, and that of the model depends on x"),
    (many, {}, "the model has 257 Wiener processes, and there may be 256 in double precision"),
    (diagonal(), dict(free=[k]), "the model has noise, and derivatives along its paths are not there yet"),
    (diagonal(), dict(interpreted=True), "the model cannot be interpreted, as it has noise: install a C"),
])
def test_what_does_not_fit_is_refused_by_solve(model, more, said, request):
    if "interpreted" not in more:
        request.getfixturevalue("nothing_compiles")
    with pytest.raises(my.Error, match=said):
        call(model, **more)


def test_what_does_not_fit_is_refused_by_studies(nothing_compiles):
    def study(model, **more):
        return my.study(model, {mu: [0.1, 0.2], sigma: 0.5}, **{**of_diagonal, "start": {x: 1, w: 0}, **more})

    with pytest.raises(my.Error, match="milstein takes a Wiener process for each state"):
        study(shared_noise(), method="milstein")
    with pytest.raises(my.Error, match="euler_maruyama takes fixed steps: give step="):
        study(shared_noise(), step=None)
    with pytest.raises(my.Error, match="paths is 3, and the model has no noise"):
        my.study(my.model({x: -x}), start={x: 1}, time=(0, 1), paths=3)


def test_additive_noise_suits_all_methods(nothing_compiles):
    shared = my.model({x: -x, y: -y}, noise={x: {W: k}, y: {W: 1}})
    for method in methods.stochastic:
        with pytest.raises(TypeError, match="not callable"):  # as nothing compiles: nothing has refused it
            call(shared, method=method)


def test_derivatives_and_fits_are_refused(nothing_compiles):
    model, said = diagonal(), "the model has noise, and (derivatives|tangents|fits) along its paths are not there yet"
    data = {"t": np.linspace(0, 1, 3), "y": np.ones(3)}
    usual = dict(sweep={mu: 1, sigma: 1}, start={x: 1, y: 1}, step=0.1)
    for refused in (lambda: my.with_tangents(model), lambda: my.with_sensitivities(model, [k]),
                    lambda: my.fit(model, data, free={k: (0.1, 10)}, **usual),
                    lambda: my.least_squares(model, data, free={k: (0.1, 10)}, **usual),
                    lambda: my.batched(model, free=[k], of=[y], time=(0, 1), adjoint=True, **usual),
                    lambda: my.batched(model, free=[k], of=[y], time=(0, 1), **usual).with_jacobian([1.0]),
                    lambda: my.batched(model, free=[k], of=[y], time=(0, 1), **usual).vjp([1.0], [1.0])):
        with pytest.raises(my.Error, match=said):
            refused()


def test_seeds_and_steps_of_paths_are_refused_without_noise_or_out_of_range():
    plain = my.model({x: -x})
    for more in (dict(seed=3), dict(noise_step=0.1)):
        with pytest.raises(my.Error, match="(seed is 3|noise_step is 0.1), and the model has no noise"):
            call(plain, **more)
    with pytest.raises(my.Error, match="noise_step is 0.1, and the model has no noise"):
        my.study(plain, start={x: 1}, time=(0, 1), noise_step=0.1)
    my.study(plain, start={x: my.normal(0, 1)}, time=(0, 1), seed=-3)  # of random values
    for more, said in ((dict(seed=-1), "seed is -1"), (dict(seed=2**32), "seed is 4294967296"),
                       (dict(seed=0.5), "seed is 0.5: give a whole number"),
                       (dict(noise_step=0.03), "step is 0.1, which is neither a multiple of noise_step, 0.03")):
        with pytest.raises(my.Error, match=said):
            call(diagonal(), **more)


def test_a_path_that_leaves_the_domain_of_a_root_ends_its_instance_alone():
    model = my.model({x: 0}, noise={x: my.sqrt(x)})
    run = my.solve(model, start={x: 0.3}, time=(0, 4), step=0.25, paths=200, seed=1)
    assert {"success", "not_finite"} == set(run.status)


# -- The library's side ------------------------------------------------------------------------------------------------

def test_methods_for_noise_are_those_of_the_library():
    found = {}
    for header in (ROOT / "include/myriad/kernel/methods").glob("*.hpp"):
        if taken := re.search(r"constexpr noise_taken noise = noise_taken::(\w+);", header.read_text("utf-8")):
            found[header.stem] = taken[1]
    assert set(found) == set(methods.stochastic) < set(my.methods)
    assert set(methods.additive_noise) == {name for name, taken in found.items() if taken == "additive"}
    assert set(methods.diagonal_noise) == {name for name, taken in found.items() if taken == "diagonal"}


def test_a_model_in_cpp_takes_the_methods_for_noise(whole):
    text = diagonal().cpp("written")
    run = my.solve(my.CppModel(text, "written", "x y", "mu k sigma"), {"mu": 0.1, "sigma": 0.5, "k": 1}, paths=20,
                   **{**of_diagonal, "start": {"x": 1, "y": 2}}, method="euler_maruyama")
    np.testing.assert_array_equal(run["x"], whole["x"][:20])
