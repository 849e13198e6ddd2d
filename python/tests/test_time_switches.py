# SPDX-License-Identifier: MIT
"""Equations of traced models that jump in time: no step passes over a jump. test_sbml.py and test_xpp.py have models
from files."""

import numpy as np
import pytest

import myriad_ode as my
from myriad_ode import where
from myriad_ode.codegen.unit_writer import unit_form

x, clock = my.states("x clock")
k, T = my.parameters("k T")
on = my.accessory("on")
t = my.time
rates = np.array([0.1, 0.2])
tight = {"rtol": 1e-10, "atol": 1e-12}


def after(starts, end, length=1.0, rate=rates):
    """What is left at the end of infusions at the rate 1 from some times on."""
    starts = np.asarray(starts, float)[:, None]
    return ((np.exp(-rate * (end - starts - length)) - np.exp(-rate * (end - starts))) / rate).sum(axis=0)


def infused(on, **more):
    return my.model({x: where(on, 1.0, 0.0) - k * x}, **more)


def test_a_short_pulse_is_not_passed_over():
    starts = np.linspace(1, 90, 50)
    model = my.model({x: where((t > T) & (t < T + 1e-3), 1000.0, 0.0) - 0.01 * x})
    for begin, end in ((0, 100), (100, 0)):
        run = my.solve(model, {T: starts}, start={x: 0}, time=(begin, end), rtol=1e-8)
        at_end = 1e5 * (np.exp(-0.01 * (end - starts - 1e-3)) - np.exp(-0.01 * (end - starts)))
        np.testing.assert_allclose(run["x"], np.sign(end - begin) * at_end, rtol=1e-6)
        assert run.accepted_steps.max() < 100


@pytest.mark.parametrize("wave", [
    t % 24 < 12, (t // 12) % 2 == 0, my.ceil(t / 12) % 2 == 1, my.trunc(t / 12) % 2 == 0, my.fmod(t, 24.0) < 12,
    my.round(t / 12 - 0.5) % 2 == 0, my.sin(np.pi * t / 12) > 0, my.sinpi(t / 12) > 0, my.cospi(t / 12 - 0.5) > 0,
    my.copysign(1.0, my.sinpi(t / 12)) > 0, abs(t % 24 - 6) < 6])
def test_a_wave_is_right_however_it_is_written(wave):
    run = my.solve(infused(wave), {k: rates}, start={x: 0}, time=(0, 120), **tight)
    np.testing.assert_allclose(run["x"], after(24 * np.arange(5), 120, 12.0), rtol=1e-9)


@pytest.mark.parametrize("condition, span, on", [
    (t % 24 < 12, (0, -48), -24), (abs(t) < 1, (0, -20), -1), ((-t) % 24 < 12, (0, 48), 24),
    (my.maximum(-t, t) < 1, (0, 20), 1), (my.minimum(-t, t) > -1, (0, 20), 1)])
def test_a_jump_at_time_zero_is_seen_from_either_side(condition, span, on):
    run = my.solve(my.model({x: where(condition, 1.0, 0.0)}), start={x: [0]}, time=span, rtol=1e-9, interpreted=True)
    np.testing.assert_allclose(run["x"], on, rtol=1e-9)


@pytest.mark.parametrize("phase", [1e5 + 0.1, 1e7 + 0.1, 1e9 + 0.1])
def test_periods_are_not_lost_far_from_their_origin(phase):
    steps = np.floor((phase + np.linspace(0, 10, 1_000_001)) / 0.7)
    edges = np.concatenate([[0], np.unique(steps)[1:] * 0.7 - phase, [10]])
    on = np.minimum(edges[1:], edges[:-1] + 0.3) - edges[:-1]
    on[0] = max(0.0, 0.3 - phase % 0.7)
    for condition, given, starts in (((t + T) % 0.7 < 0.3, {T: phase}, {}), (clock % 0.7 < 0.3, {}, {clock: phase})):
        model = my.model({x: where(condition, 1.0, 0.0), **({clock: 1.0} if starts else {})})
        run = my.solve(model, given, start={x: [0], **starts}, time=(0, 10), rtol=1e-9, interpreted=True)
        np.testing.assert_allclose(run["x"], on.sum(), rtol=1e-6)


def test_pulses_as_short_as_a_time_stamp_resolves_are_not_lost():
    stamp = 1.7e9 + 1
    for on, start, end, height in ((stamp, 1.7e9, 1.7e9 + 10, 1 / 0.15), (30.0, 0, 100, 1e9)):
        model = my.model({x: where((t > T) & (t < T + 1 / height), height, 0.0)})
        run = my.solve(model, {T: on}, start={x: [0]}, time=(start, end), rtol=1e-3, atol=1e-3, interpreted=True)
        np.testing.assert_allclose(run["x"], 1, rtol=1e-5)


def test_periods_in_single_precision_are_not_lost():
    periods = np.array([0.1, 0.3, 0.7, 1.1, 2.3])
    run = my.solve(my.model({x: where(t % T < T / 2, 1.0, 0.0)}), {T: periods}, start={x: 0}, time=(0, 11),
                   precision="float", rtol=1e-5, device="cpu")
    whole = np.floor(11 / periods)
    np.testing.assert_allclose(run["x"], whole * periods / 2 + np.minimum(11 - whole * periods, periods / 2), rtol=1e-4)


def test_summaries_of_what_jumps_are_exact():
    largest, when, area = (my.accessory(name) for name in ("largest", "when", "area"))
    gone = x * where(t < T, 1.0, 0.0)
    for rate in (where(t < T, 1.0, 0.0), 1.0):  # also where no equation jumps
        model = my.model({x: rate}, accessories={
            largest: my.phase_maximum(gone), when: my.time_of_maximum(gone), area: my.integral(gone)})
        run = my.solve(model, {T: [7.3]}, start={x: 0}, time=(0, 10), rtol=1e-9)
        np.testing.assert_allclose([run["largest"], run["when"], run["area"]], [[7.3], [7.3], [7.3**2 / 2]], rtol=1e-9)


def test_a_phase_that_initialise_begins_elsewhere_has_its_own_first_jump():
    model = my.model({x: where((t > T) & (t < T + 2), 1.0, 0.0)}, initialise={my.t_begin: T + 1})
    run = my.solve(model, {T: [-3.0, 4.0]}, start={x: 0}, time=(0, 10), rtol=1e-9)
    np.testing.assert_allclose(run["x"], 1, rtol=1e-9)


@pytest.mark.parametrize("options, rtol", [
    ({"method": "rodas_5p", **tight}, 1e-9), ({"interpreted": True, **tight}, 1e-9),
    ({"method": "verner_7", **tight}, 1e-9), ({"method": "runge_kutta_4", "step": 0.7}, 1e-4),
    ({"precision": "float", "rtol": 1e-5}, 1e-4)])
def test_all_methods_and_kinds_of_numbers_stop_at_jumps(options, rtol):
    run = my.solve(infused((t > T) & (t < T + 1)), {k: rates, T: 9.0}, start={x: 0}, time=(0, 20), **options)
    np.testing.assert_allclose(run["x"], after([9.0], 20), rtol=rtol)


def test_jumps_go_on_where_a_phase_goes_on():
    model = infused((t > T) & (t < T + 1))
    parts = my.solve(model, {k: rates, T: 9.5}, start={x: 0}, time=(0, 20), phases=5, phase_length=4, carry_on=True,
                     **tight)
    np.testing.assert_allclose(parts["x"], after([9.5], 20), rtol=1e-9)


@pytest.mark.parametrize("model, starts", [
    (infused(t < on + 1, accessories={on: -9.0}, stops=my.stop(5, every=10, do={on: t})), [5, 15, 25, 35]),
    (infused((t > on) & (t < on + 1), accessories={on: None}, initialise={on: T + 1}, stops=my.stop(20, do={on: 25.0})),
     [10, 25]),
    (infused((t >= on) & (t < on + 1), accessories={on: -9.0}, triggers=my.trigger(
        (t - 3) % 10 < 1, delay=2.0, do={on: t})), [5, 15, 25, 35]),
    (my.model({x: where(clock < 1, 1.0, 0.0) - k * x, clock: 1.0}, events=my.event(clock - 10, do={clock: 0.0})),
     [0, 10, 20, 30])])
def test_actions_find_the_next_jump_anew(model, starts):
    given = {T: 9.0} if "T" in model.parameters else {}
    run = my.solve(model, {k: rates, **given}, start=dict.fromkeys(model.states, 0), time=(0, 38), **tight)
    np.testing.assert_allclose(run["x"], after(starts, 38), rtol=1e-8)
    assert not set(run.accessories) & {"next_jump", "between_jumps"}


def test_jumps_that_have_no_formula_are_noted():
    model = infused(t * t < 4)
    assert model.jumps_to_miss == ["time * time < 4"] and not model.stops
    run = my.solve(model, {k: rates}, start={x: 0}, time=(0, 9))
    assert run.report.notes == [
        "the model jumps where `time * time < 4` changes, at times where no step ends: it may pass over what is "
        "between two of them; give a maximum_step= shorter than that"]
    assert not my.solve(model, {k: rates}, start={x: 0}, time=(0, 9), maximum_step=0.5).report.notes


@pytest.mark.parametrize("name", ["stop", "stop_time"])
def test_a_parameter_may_have_the_name_of_a_hook_of_stops(name):
    until = my.parameter(name)
    model = infused(t < until)
    run = my.solve(model, {k: rates, until: 1.0}, start={x: 0}, time=(0, 20), **tight)
    np.testing.assert_allclose(run["x"], after([0.0], 20), rtol=1e-8)
    if name != "stop":
        assert "or rename 'stop_time'" in run.report.notes[0]
    else:
        units = my.units(40)
        a, = units.states("a")
        form = unit_form(my.model({a: [where(t < until, 1.0, 0.0) - k * a[i] for i in range(40)]}))
        assert form is not None and "int stop" not in form.source("ring")


def test_what_does_not_jump_in_time_has_no_stops():
    times = np.arange(9.0)
    for smooth in (my.interpolate(t, times, times % 2), where(my.parameter("mode") > 1, t, -t),
                   my.interpolate(t, times, times % 2, outside="periodic", kind="cubic"),
                   where(x > 0.5, 1.0, 0.0), my.sin(t)):
        model = my.model({x: smooth - k * x})
        assert not model.stops and not model.accessories


def test_names_of_users_stay_theirs():
    own = my.accessory("next_jump")
    model = my.model({x: where(t > T, 1.0, 0.0) - k * x + own}, accessories={own: 0.5}, name="jump")
    assert [s.name for s in model.stops] != ["jump"] and "next_jump" not in model.hidden
    run = my.solve(model, {k: rates, T: 100.0}, start={x: 0}, time=(0, 1), **tight)
    np.testing.assert_allclose(run["x"], 0.5 * (1 - np.exp(-rates)) / rates, rtol=1e-9)


def test_a_model_shows_its_equations_as_they_were_written():
    model = infused((t > T) & (t < T + 1))
    assert "where(time > T and time < T + 1, 1, 0) - k * x" in repr(model)
    np.testing.assert_array_equal(model.derivatives(np.array([1.0, 2.5]), [0.5], T=2.0, k=2.0), [[-1.0, 0.0]])
    assert "struct traced" in model.cpp("traced") and "after_stop" in model.cpp()


def test_derivatives_by_the_time_of_a_jump_are_those_of_a_closed_form():
    run = my.solve(infused((t > T) & (t < T + 1)), {k: rates, T: 9.0}, start={x: 0}, time=(0, 20),
                   free=[T, k], **tight)
    h = 1e-6
    np.testing.assert_allclose(run["x_by_T"], (after([9 + h], 20) - after([9 - h], 20)) / (2 * h), rtol=1e-7)
    np.testing.assert_allclose(run["x_by_k"], (after([9.0], 20, rate=rates + h) - after([9.0], 20, rate=rates - h)) /
                               (2 * h), rtol=1e-7)


@pytest.mark.parametrize("precision, error", [("double", 1e-8), ("float", 1e-4)])
def test_jumps_at_one_time_each_contribute_the_derivative_of_their_own_time(precision, error):
    """Single jumps, periods, jumps within jumps and an action, at one time exactly or but for rounding, and apart."""
    nested, level, z = my.states("nested level z")
    c, period, a, b, dose = my.parameters("c period a b dose")
    pulses = 2.0 * where(t % period < a, 1.0, 0.0) + 5.0 * where(t % period < b, 1.0, 0.0)
    model = my.model({x: where(t > T, 3.0, 0.0) + where(t > c, 1.0, 0.0) + pulses,
                      nested: where(t > T, where(t > c, 3.0, 1.0), 0.0), level: my.floor(t / period),
                      z: where(t > T, 1.0, 0.0) - z}, stops=my.stop(dose, do={z: z + 1}), name="coinciding")
    given = {T: np.array([0.3, 0.3, 0.22]), c: np.array([0.3, 0.3, 0.26]), dose: np.array([0.3, 0.3, 0.31]),
             period: np.array([0.1, 0.15, 0.15]), a: 0.05, b: 0.05}  # 3 * 0.1 is a rounding later than 0.3
    end, tolerance = 0.38, max(1e-3 * error, 1e-6 if precision == "float" else 0)
    run = my.solve(model, given, start={x: 0, nested: 0, level: 0, z: 0}, time=(0, end), precision=precision,
                   rtol=tolerance, atol=tolerance, device="cpu", free=[T, c, period, a, b, dose])
    s, near = run.sensitivity, {"rtol": error, "atol": error}
    pulse_count, level_sum = np.array([4, 3, 3]), np.array([1 + 2 + 3, 1 + 2, 1 + 2])
    nothing = np.zeros(3)
    np.testing.assert_allclose(s[x], np.stack([nothing - 3, nothing - 1, nothing, 2.0 * pulse_count, 5.0 * pulse_count,
                                               nothing], axis=-1), **near)
    np.testing.assert_allclose(s[nested][:, 0] + s[nested][:, 1], [-3, -3, -3], **near)  # each differs by the side
    np.testing.assert_allclose(s[nested][2], [-1, -2, 0, 0, 0, 0], **near)
    np.testing.assert_allclose(s[level, period], -level_sum, **near)
    np.testing.assert_allclose(s[z, dose], np.exp(given[dose] - end), **near)
    np.testing.assert_allclose(s[z, T], -np.exp(given[T] - end), **near)
    np.testing.assert_allclose(s[z, c], nothing, **near)


def test_jumps_have_stops_of_their_own_only_where_derivatives_are_by_their_times():
    model = my.model({x: where(t > T, 1.0, 0.0) + where(t % 24 < 12, k, 0.0)})
    assert model.stop_names == ["jump"] and len(model.accessories) == 2
    assert my.with_sensitivities(model, [k]).model is model
    assert len(my.with_sensitivities(model, [T, k]).model.stop_names) == 2


@pytest.mark.parametrize("method", ["tsitouras_5", pytest.param("rodas_5p", marks=pytest.mark.thorough)])
def test_an_adjoint_goes_back_through_jumps(method):
    height = my.parameter("height")
    model = my.model({x: where(t % 10 < 1, height - k * x * x, -k * x * x)}, events=my.event(x - 0.9, do={x: 0.5 * x}),
                     stops=my.stop(5.5, do={x: x + height}))
    at = np.array([[0.1, 1.0, 0.0], [0.2, 1.5, 0.3]])
    call = dict(free=[k, height, x], of=x, time=(0, 24), samples=[0.5, 10.5, 24.0], method=method, device="cpu",
                sensitivity_control=False, **tight)
    found, expected = (my.batched(model, adjoint=adjoint, **call).vjp(at, np.ones((2, 3, 1)))
                       for adjoint in (True, False))
    np.testing.assert_allclose(found[0], expected[0], rtol=1e-12)
    np.testing.assert_allclose(found[1], expected[1], rtol=1e-8)


@pytest.mark.parametrize("model, why", [
    (infused((t > T) & (t < T + 1)), "jump at times that depend on components that derivatives are by"),
    (my.model({x: where(clock < 1, 1.0, 0.0) - k * x, clock: T}), "jump at times that depend"),
    (my.model({x: where(clock < 1, 1.0, 0.0) - k * T * x, clock: 1.0},
              events=my.event(x - 10, name="hit", do={clock: 0.0})),
     "the event 'hit' changes when the equations jump")])
def test_an_adjoint_refuses_jumps_at_times_that_move(model, why):
    with pytest.raises(my.Error, match=f"{why}.*leave out adjoint=True"):
        my.batched(model, free=[k, T], of=x, start={"x": 0, **({"clock": 0} if "clock" in model.states else {})},
                   time=(0, 9), adjoint=True)


def test_pulses_of_coupled_units_are_exact_and_stay_units():
    units = my.units(40)
    a, = units.states("a")
    start = units.parameter("start")
    model = my.model({a: [where((t > start[i]) & (t < start[i] + 1), 1.0, 0.0) - k * a[i] for i in range(40)]})
    assert unit_form(model) is not None
    run = my.solve(model, {k: rates, **{start[i]: 1.0 + i / 8 for i in range(40)}}, start={a: 0}, time=(0, 20), **tight)
    for i in (0, 17, 39):
        np.testing.assert_allclose(run[f"a_{i}"], after([1 + i / 8], 20), rtol=1e-9)


@pytest.mark.parametrize("rate, span, right", [
    (where(t > 0, my.sin(t) / t, 1.0), (0, 1), 0.946083070367183),
    (where(t != 0, my.sin(t) / t, 1.0), (-1, 1), 2 * 0.946083070367183),
    (where(t == 0, 1.0, my.sin(t) / t), (1, 0), -0.946083070367183),
    (where(t > T, (t - T) * my.log(t - T), 0.0), (0, 2), -0.25),
    (where(t % 1 > 0, (t % 1) * my.log(t % 1), 0.0), (0, 3), -0.75),
    (where(clock + 1 > 0, my.sin(clock + 1) / (clock + 1), 1.0), (0, 1), 0.946083070367183)])
def test_at_the_very_time_of_a_jump_a_guard_keeps_out_what_has_no_value_there(rate, span, right):
    model = my.model({x: rate + 0.0 * T, clock: 1.0})
    run = my.solve(model, {T: [1.0]}, start={x: 0, clock: -1}, time=span, rtol=1e-8, interpreted=True)
    assert run.status[0] == "success"
    assert abs(run[x][0] - right) < 1e-6


@pytest.mark.parametrize("rate", [where(t >= 0, my.sin(t) / t, 1.0), where(t > 0, my.log(-1 - t), 1.0)])
def test_what_has_no_value_where_its_condition_holds_is_not_guarded(rate):
    assert my.solve(my.model({x: rate}), size=1, start={x: 0}, time=(0, 1), interpreted=True).status[0] == "not_finite"
