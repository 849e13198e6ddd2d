# SPDX-License-Identifier: MIT
"""Rules of event location (docs/numerics/events.md) that few models need: tolerances given, the end of the domain."""

import numpy as np
import pytest

import myriad_ode as my

x, v, y = my.states("x v y")
w = my.parameter("w")
n, k = my.integer_accessory("n"), my.integer_accessory("k")
at = my.accessory("at")


def solved(equations, events, accessories, sweep=None, **options):
    return my.solve(my.model(equations, events=events, accessories=accessories), sweep or {}, device="cpu:1",
                    interpreted=True, **options)


def test_at_the_end_of_the_domain_an_event_fires_that_steps_may_have_missed_by_their_rounding():
    run = solved({x: 1.0}, my.event(1e6 * (x - 1), do={n: n + 1}), {n: 0}, size=1, start={x: 0.0},
                 time=(0, 1 - 1e-13), maximum_step=1e-3)
    assert run[n][0] == 1


def test_at_the_end_of_the_domain_an_event_does_not_fire_farther_from_zero_than_its_tolerance():
    events = [my.event(1e6 * (x - 1), do={n: n + 1}, tolerance=1e-9), my.event(x - 1, do={k: k + 1})]
    run = solved({x: 1.0}, events, {n: 0, k: 0}, size=1, start={x: 0.0}, time=(0, 1 - 1e-13), maximum_step=1e-3)
    assert run[n][0] == 0 and run[k][0] == 1


def test_a_tolerance_larger_than_what_a_function_changes_by_is_a_64th_of_that():
    run = solved({x: 1.0}, my.event(my.atan(20 * (x - 0.53)), do={at: my.time}, tolerance=1e3), {at: -1}, size=1,
                 start={x: 0.0}, time=(0, 1), method="runge_kutta_4", step=1.0)
    assert abs(np.arctan(20 * (run[at][0] - 0.53))) < (np.arctan(20 * 0.53) + np.arctan(20 * 0.47)) / 64


@pytest.mark.parametrize("keeps", [0.5, 0.99])
def test_an_action_that_moves_its_function_within_the_tolerance_does_not_make_it_fire_again(keeps):
    heights = np.linspace(1, 2, 100)
    run = solved({x: v, v: -1.0}, my.event(x, do={v: -v, x: keeps * x, n: n + 1}, tolerance=0.1), {n: 0},
                 start={x: heights, v: 0.0}, time=(0, 20), rtol=1e-9)
    fall = np.sqrt(2 * heights)
    assert np.all(abs(run[n] - (20 / fall + 1) / 2) < 1)


@pytest.mark.parametrize("beyond", [4e-15, 1e-14])
@pytest.mark.parametrize("power", [3, 5])
def test_a_flat_function_that_is_zero_up_to_rounding_where_a_trial_ends_crosses_with_the_others(beyond, power):
    events = [my.event(x - 1, do={n: n + 1, x: 0}), my.event((x - 1)**power, do={k: k + 1})]
    run = solved({x: 1.0}, events, {n: 0, k: 0}, size=1, start={x: 0.0}, time=(0, 1.5), method="runge_kutta_4",
                 step=1 + beyond)
    assert (run[n][0], run[k][0]) == (1, 1)


@pytest.mark.parametrize("height", [2e-10, 1e-9, 3e-9, 1e-8])
def test_an_action_that_moves_a_state_near_a_surface_where_time_is_coarse_does_not_take_it_across(height):
    events = [my.event(x - 1, do={v: height}), my.event(v, direction="falling", do={n: n + 1, v: 100})]
    run = solved({x: 1.0, v: -1.0}, events, {n: 0}, size=1, start={x: 0.0, v: 5.0}, time=(1e6, 1e6 + 2))
    assert run[n][0] == 1


@pytest.mark.parametrize("start", [0.0, -1e-310])
def test_a_flat_function_is_located_where_times_are_denormal_numbers(start):
    run = solved({x: 1.0}, my.event(x**3, do={n: n + 1}), {n: 0}, size=1, start={x: start}, time=(0, 1e-309))
    assert run.status[0] in ("success", "step_underflow")


def test_an_integration_ends_whose_times_are_as_large_as_numbers_can_be():
    event = my.event(x**3, do={n: n + 1})
    run = solved({x: 1e-308}, event, {n: 0}, size=1, start={x: 0.0}, time=(9e307, 1.7e308))
    assert run.status[0] == "success" and run[n][0] == 0


@pytest.mark.parametrize("samples", [1, 8])
def test_a_function_that_turns_in_a_kink_at_the_start_of_a_step_is_looked_at_once(samples):
    run = solved({x: 1.0}, my.event(1 + my.where(x > 0, x, -x), do={n: n + 1}), {n: 0}, size=1, start={x: 0.0},
                 time=(0, 1), sub_samples=samples)
    assert run.status[0] == "success" and run[n][0] == 0


def test_a_function_that_crosses_in_a_direction_not_asked_for_in_a_step_from_a_surface_is_then_on_its_other_side():
    events = [my.event(x, do={k: k + 1}), my.event(x - 1, direction="falling", do={n: n + 1})]
    run = solved({x: v, v: -1.0}, events, {n: 0, k: 0}, size=1, start={x: 0.0, v: 2.0}, time=(0, 3.8),
                 method="runge_kutta_4", step=1.9)
    assert (run[n][0], run[k][0]) == (1, 0)


def test_a_function_that_rests_at_zero_and_goes_back_has_not_crossed():
    run = solved({x: v, v: -1.0}, my.event(my.minimum(x, 0), direction="falling", do={n: n + 1}), {n: 0}, size=1,
                 start={x: -0.3, v: 1.0}, time=(0, 2), method="runge_kutta_4", step=0.125)
    assert run[n][0] == 0


def test_a_difference_whose_terms_cancel_has_their_rounding_error():
    phase = np.linspace(0, 6, 100)
    run = solved({x: my.sin(my.time + w), y: my.cos(my.time + w - np.pi / 2)}, my.event(x - y, do={n: n + 1}), {n: 0},
                 {w: phase}, start={x: 1.0, y: 1.0}, time=(0, 1), method="runge_kutta_4", step=0.25)
    assert np.any(run[x] != run[y]) and not np.any(run[n])


@pytest.mark.parametrize("samples", [1, 2])
def test_a_step_that_ends_within_the_tolerance_of_its_event_is_improved(samples):
    run = solved({x: w * (1.5 + my.sin(3 * x))}, my.event(x - 1, do={at: x}, tolerance=0.01), {at: 0},
                 {w: np.linspace(1, 3, 200)}, start={x: 0.0}, time=(0, 2), method="runge_kutta_4", step=0.25,
                 sub_samples=samples)
    error = np.abs(run[at] - 1)
    assert np.max(error) < 0.0011


@pytest.mark.parametrize("method", ["tsitouras_5", "cash_karp", "rodas_5p"])
@pytest.mark.parametrize("tolerance", [0, 1e-10, 1e-6])
def test_events_of_smooth_functions_are_located_in_few_trials(method, tolerance):
    run = solved({x: v, v: -1.0}, my.event(x, direction="falling", do={v: -v, n: n + 1}, tolerance=tolerance), {n: 0},
                 size=50, start={x: 1.0, v: np.linspace(0, 1, 50)}, time=(0, 40), method=method)
    assert np.sum(run.located_steps) <= (6 if tolerance == 0 else 1.5) * np.sum(run[n])


def test_of_two_events_in_one_step_the_first_is_located_first():
    events = [my.event(x - 0.9, do={n: n + 1}), my.event(x - 0.1, do={k: k + 1})]
    run = solved({x: 1.0}, events, {n: 0, k: 0}, size=1, start={x: 0.0}, time=(0, 1), method="runge_kutta_4", step=1.0)
    assert (run[n][0], run[k][0]) == (1, 1) and run.located_steps[0] == 2


def test_an_event_where_a_step_begins_takes_one_trial():
    run = solved({x: -1.0}, my.event(x, do={n: n + 1}), {n: 0}, size=1, start={x: 1.0}, time=(0, 2),
                 method="runge_kutta_4", step=0.25)
    assert run[n][0] == 1 and run.located_steps[0] == 1


def test_a_crossing_at_the_very_start_of_an_enormous_step_is_found():
    run = solved({x: 1.0}, my.event(my.exp(my.exp(x)) - 3, do={n: n + 1, at: my.time}), {n: 0, at: 0}, size=1,
                 start={x: 0.0}, time=(0, 1e200), method="runge_kutta_4", step=1e200)
    assert run[n][0] == 1 and abs(run[at][0] - np.log(np.log(3))) < 1e-12


def test_what_an_action_moves_past_zero_within_the_tolerance_is_past_zero():
    run = solved({x: 1.0}, my.event(x, do={x: x - 0.05, n: n + 1}, tolerance=0.1), {n: 0}, size=1, start={x: -1.0},
                 time=(0, 1.2), method="runge_kutta_4", step=0.1)
    assert run[n][0] > 1


def test_what_an_action_moves_beside_another_surface_by_the_error_of_location_goes_where_it_heads():
    events = [my.event(my.sin(x) - 0.5, do={y: x - np.arcsin(0.5)}, tolerance=1e-4), my.event(y, do={n: n + 1})]
    run = solved({x: w, y: 1.0}, events, {n: 0}, {w: np.linspace(1, 3, 100)}, start={x: 0.0, y: 5.0}, time=(0, 0.8),
                 method="runge_kutta_4", step=0.1)
    assert not np.any(run[n])


def test_what_a_stop_puts_on_a_surface_up_to_rounding_goes_where_it_heads():
    model = my.model({x: 1.0}, events=my.event(x - 1, do={n: n + 1}), accessories={n: 0},
                     stops=my.stop(0.5, do={x: 1 - 2.0**-53}))
    run = my.solve(model, size=1, start={x: 3.0}, time=(0, 1), device="cpu:1", interpreted=True)
    assert run[x][0] == pytest.approx(1.5) and run[n][0] == 0


def test_a_touch_is_found_where_the_function_turns():
    run = solved({x: v, v: -1.0}, my.event(x - (0.5 - 1e-8), do={n: n + 1}), {n: 0}, size=1, start={x: 0.0, v: 1.0},
                 time=(0, 3), method="runge_kutta_4", sub_samples=2, step=0.3)
    assert run[n][0] == 2


def test_a_touch_is_found_where_the_cubic_through_a_long_step_is_too_coarse():
    run = solved({x: v, v: -x}, my.event(x - (1 - 1e-8), do={n: n + 1}), {n: 0}, size=1, start={x: 0.0, v: 1.0},
                 time=(0, 3), method="tsitouras_5", sub_samples=2, rtol=1e-7, atol=1e-7)
    assert run[n][0] == 2


def test_an_event_does_not_take_along_what_would_cross_only_after_its_action():
    events = [my.event(x, direction="falling", do={x: 1.0, n: n + 1}, tolerance=1e-3),
              my.event(x + 5e-4, direction="falling", do={k: k + 1}, tolerance=1e-9)]
    run = solved({x: -1.0}, events, {n: 0, k: 0}, size=1, start={x: 1.0}, time=(0, 10.5))
    assert run[n][0] == 10 and run[k][0] == 0


@pytest.mark.parametrize("tolerance", [0.0, 1e-9])
def test_an_event_takes_along_its_double_with_a_smaller_tolerance(tolerance):
    events = [my.event(my.sinh(8 * x), direction="falling", do={x: y, n: n + 1}, tolerance=1e-2),
              my.event(my.sinh(8 * x), direction="falling", do={k: k + 1}, tolerance=tolerance)]
    run = solved({x: -1.0, y: 0.0}, events, {n: 0, k: 0}, start={x: 1.0, y: np.linspace(0.2, 1, 200)}, time=(0, 10))
    assert (run[n] > 9).all() and (run[n] == run[k]).all()


def test_steps_before_the_last_action_of_an_event_do_not_count_at_the_end_of_the_domain():
    level = my.accessory("level")
    event = my.event(x - level, direction="rising", do={level: 1.0, n: n + 1})
    run = solved({x: 1.0}, event, {n: 0, level: 0.9}, size=1, start={x: 0.0}, time=(0, 1 - 2e-12), maximum_step=1e-4)
    assert run[n][0] == 1


def test_the_roundings_of_the_times_of_all_actions_count_at_the_end_of_the_domain():
    rates = np.linspace(1, 2, 300)
    run = solved({x: w}, my.event(x - 1, do={x: x - 1, n: n + 1}), {n: 0}, {w: rates}, start={x: 0.0},
                 time=(0, 200 / rates))
    assert (run[n] == 200).all()


@pytest.mark.parametrize("before", [2e-9, 1e-8])
def test_a_touch_a_little_after_the_end_of_the_domain_is_no_crossing(before):
    rates = np.linspace(1, 2, 300)
    run = solved({x: v, v: -2 * w * w}, my.event(x - 1, do={n: n + 1}), {n: 0}, {w: rates},
                 start={x: 0.0, v: 2 * rates}, time=(0, 1 / rates - before), maximum_step=0.05)
    assert (run[n] == 0).all()


@pytest.mark.parametrize("does", [{n: n + 1}, {n: n + 1, v: v + 1}])
def test_a_function_that_goes_to_zero_and_rests_there_has_crossed_once(does):
    flat = my.maximum(1 - x, 0)**3 - my.maximum(x - 2, 0)**3
    run = solved({x: 1.0, v: 0.0}, my.event(flat, direction="falling", do=does), {n: 0}, size=1,
                 start={x: 0.0, v: 0.0}, time=(0, 4), maximum_step=0.4)
    assert run.status[0] == "success" and run[n][0] == 1


def test_a_ball_past_its_surface_that_comes_back_has_not_hit_it_again():
    pull, keeps = my.parameters("pull keeps")
    generator = np.random.default_rng(1)
    a, e, h = generator.uniform(0.5, 2, 500), generator.uniform(0.6, 1, 500), generator.uniform(0.05, 1, 500)
    run = solved({x: v, v: -pull}, my.event(1 - my.exp(-20 * x), direction="falling", do={v: -keeps * v, n: n + 1},
                                            tolerance=0.1), {n: 0}, {pull: a, keeps: e}, start={x: h, v: 0.0},
                 time=(0, 6), max_steps=20_000)
    impact = np.sqrt(2 * h / a)[:, None] * np.concatenate(
        [np.ones((500, 1)), 2 * np.cumprod(np.repeat(e[:, None], 40, axis=1), axis=1)], axis=1).cumsum(axis=1)
    count = (impact < 6).sum(axis=1)
    clear = (np.abs(impact - 6).min(axis=1) > 0.1) & (count < 20)
    assert clear.sum() > 200 and np.array_equal(run[n][clear], count[clear])


@pytest.mark.parametrize("exponent", [-900, -1000, -1020, -1030, -1040, -1050])
def test_events_of_states_that_are_denormal_numbers_are_those_of_others(exponent):
    unit = 2.0**exponent
    run = solved({x: v, v: -1.3 * unit}, my.event(x, direction="falling", do={v: -0.8 * v, n: n + 1}), {n: 0}, size=1,
                 start={x: unit, v: 0.0}, time=(0, 6))
    assert run.status[0] == "success" and run[n][0] == 3
