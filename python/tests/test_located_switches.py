# SPDX-License-Identifier: MIT
"""Switches that steps end at: equations that jump because of the state or the past, against closed forms, against small
steps, and against the same with events by hand."""

import numpy as np
import pytest
import test_state_jumps

import myriad_ode as my
from myriad_ode.models import state_jumps

x, y = my.states("x y")
c, K, r = my.parameters("c K r")
t = my.time
quick = dict(interpreted=True, method="dormand_prince_5", rtol=1e-9, atol=1e-11)
falling = my.model({x: my.where(x > c, -2.0, -1.0)}, name="falling")
located = my.with_located_switches(falling)


def solved(model, sweep=None, **options):
    return my.solve(model, sweep, **{**quick, **options})


# -- Where steps end ---------------------------------------------------------------------------------------------------

def test_steps_end_at_the_switch_and_none_sees_both_sides():
    at = np.array([0.2, 0.5, 0.9])
    run = solved(located, {c: at}, start={x: 1.0}, time=(0, 1))
    np.testing.assert_allclose(run["x"], (at - 1) / 2, rtol=1e-14)
    assert (run["rejected_steps"] == 0).all() and (run["located_steps"] <= 2).all()


drift = {"c": 0.9, "K": 1.4}


@pytest.mark.parametrize("name", [name for name in test_state_jumps.jump if name not in (
    "a jump on a steep slope", "a small jump")])  # whose solution runs away, and which is below rounding here
def test_what_jumps_by_the_state_is_integrated_as_by_small_steps(name):
    rate = test_state_jumps.jump[name]
    model = my.model({x: 1.1 + 0.2 * rate, y: 0.4 * x - y + 0.3})  # both move across what jumps, and do not slide
    switched = my.with_located_switches(model)
    assert switched.located_switches and state_jumps.jumps(switched) == []
    given = {n: v for n, v in drift.items() if n in model.parameters}
    call = dict(start={x: 0.3, y: 0.7}, time=(0, 3.3))
    found = solved(switched, given, **call)
    small = solved(model, given, **call, maximum_step=1e-4, max_steps=10**6)
    assert found["status"] == "success"
    np.testing.assert_allclose([found[s] for s in (x, y)], [small[s] for s in (x, y)], atol=3e-5)
    coarse = solved(switched, given, **call, rtol=1e-6, atol=1e-6)
    np.testing.assert_allclose([coarse[s] for s in (x, y)], [found[s] for s in (x, y)], atol=3e-5)


@pytest.mark.parametrize("rate, start", [
    (my.where(x - my.sin(t) > 0.5, 2.0, 1.3 * my.cos(t) + 1.0), 0.0),  # time and state decide
    (my.where(t * x > 1, 0.2, 1.0), 0.1),
    (my.where(my.sin(t * t) * x > 0.3, 1.0, 0.2), 1.0),  # the times have no formula
    (my.where(my.where(y > 0.5, x, 2 * x) > 1, 0.5, 1.0), 0.1),  # a switch in what another one compares
    (my.where(x > my.where(t > 1, 1.5, 0.5), 0.3, 1.0), 0.1),  # whose threshold jumps
    (my.where((x > 0.5) & ~(y > 0.8) | (x > 1.2), 0.3, 1.0), 0.1),
    (my.where(x > 1, -my.sqrt(x - 1) - 0.1, -1.0), 2.0),  # no root beyond the switch
    (my.where(x <= 1, my.log(2 - x) + 0.4, 0.5), 0.5)])
def test_switches_of_time_and_state_and_in_each_other_are_located(rate, start):
    model = my.model({x: rate, y: 0.6}, name="mixed")
    switched = my.with_located_switches(model)
    assert state_jumps.jumps(switched) == []
    call = dict(start={x: start, y: 0.0}, time=(0, 2.5), maximum_step=0.2)
    found, small = solved(switched, **call), solved(model, **{**call, "maximum_step": 1e-4})
    np.testing.assert_allclose(found["x"], small["x"], atol=3e-4)
    tight = solved(switched, **call, rtol=1e-12, atol=1e-13)
    np.testing.assert_allclose(found["x"], tight["x"], atol=3e-8)  # 30 tolerances


def test_a_comparison_that_is_written_again_is_one_switch():
    model = my.with_located_switches(my.model({x: my.where(x > c, 1.0, 2.0), y: my.where(x > c, -y, y)}))
    assert len(model.located_switches) == len(model.events) == 1


@pytest.mark.parametrize("rate", [np.sign(x - c), my.where(x >= c, 1.0, my.where(x < c, -1.0, 0.0)),
                                  my.where(2 * x > 2 * c, 1.0, my.where(x < c, -1.0, 5.0))])
def test_a_value_on_the_surface_alone_is_never_taken(rate):
    run = solved(my.with_located_switches(my.model({x: -1.5 - 0.5 * rate})), {c: [0.3, 0.5, 0.7]}, start={x: 1.0},
                 time=(0, 1))
    np.testing.assert_allclose(run["x"], 0.5 * np.array([0.3, 0.5, 0.7]) - 0.5, rtol=1e-13)


def test_what_does_not_jump_stays_as_it_is():
    smooth = my.model({x: my.maximum(x, c) - my.where(my.time > 1, 1.0, 2.0)})
    assert my.with_located_switches(smooth) is smooth


@pytest.mark.parametrize("surface", [x > 1, x >= 1, 1 < x, ~(x <= 1), x // 1 >= 1])
@pytest.mark.parametrize("speed", [1.0, -1.0])
def test_a_solution_that_starts_on_a_switch_is_on_the_side_to_which_it_goes(surface, speed):
    model = my.with_located_switches(my.model({x: speed * my.where(surface, 2.0, 1.0)}))
    run = solved(model, start={x: 1.0}, time=(0, 0.4), samples=[0.0, 0.2, 0.4])
    rate = 2.0 if speed > 0 else -1.0
    np.testing.assert_allclose(run["x_sample"], [[1.0, 1 + 0.2 * rate, 1 + 0.4 * rate]], rtol=1e-14)


def test_a_solution_goes_through_a_switch_backwards_in_time():
    run = solved(located, {c: 0.5}, start={x: -0.25}, time=(1, 0))
    np.testing.assert_allclose(run["x"], 1.0, rtol=1e-14)


# -- Phases ------------------------------------------------------------------------------------------------------------

def test_phases_that_end_at_the_switch_or_beside_it_go_on_as_one():
    lengths = np.array([0.25, 0.1, 0.05, 0.2])  # the switch is at 0.25
    for length in lengths:
        run = solved(located, {c: 0.5}, start={x: 1.0}, time=(0, 1), phases=round(1 / length), carry_on=True,
                     phase_length=length)
        np.testing.assert_allclose(run["x"], -0.25, rtol=1e-13)
    number = my.model({x: 1.0 + my.floor(x)}, name="number")
    run = solved(my.with_located_switches(number), start={x: 0.0}, time=(0, 1.75), phases=7, carry_on=True,
                 phase_length=0.25)
    np.testing.assert_allclose(run["x"], 2.75, rtol=1e-12)  # 1 at 1, 2 at 1.5, and then three times as fast


def test_an_event_that_ends_the_phase_at_the_switch_leaves_the_mode_to_the_next_one():
    model = my.with_located_switches(my.model({x: my.where(x > c, -2.0, -1.0)}, events=[
        my.event(x - c, name="there", stop_after=1)]))
    run = solved(model, {c: [0.2, 0.5]}, start={x: 1.0}, time=(0, 1), phases=2, carry_on=True)
    np.testing.assert_allclose(run["x"], [-0.4, -0.25], rtol=1e-14)


def test_phases_that_begin_elsewhere_look_where_they_are():
    for hook in (dict(initialise={x: 1.0}), dict(finalise={x: 1.0}), dict(stops=my.stop(0, do={x: 1.0}))):
        model = my.with_located_switches(my.model({x: my.where(x > c, -2.0, -1.0)}, **hook))
        run = solved(model, {c: 0.5}, start={x: 1.0}, time=(0, 1), phases=3, record=[x])
        np.testing.assert_allclose(run["x"], 1.0 if "finalise" in hook else -0.25, rtol=1e-14)


# -- Beside events, triggers and hooks ---------------------------------------------------------------------------------

def _reset(switched, **how):
    model = my.model({x: my.where(x > 1, 1.0, 2.0), y: 1.0}, **how)
    return my.with_located_switches(model) if switched else model


@pytest.mark.parametrize("do", [
    lambda do: dict(events=my.event(y - 0.7, name="kick", do=do)),
    lambda do: dict(stops=my.stop(0.7, name="kick", do=do)),
    lambda do: dict(triggers=my.trigger(y > 0.7, name="kick", do=do)),
    lambda do: dict(triggers=my.trigger(y > 0.5, delay=0.2, name="kick", do=do)),
    lambda do: dict(triggers=[my.trigger(y > 0.7, priority=1, do={x: x + 5}), my.trigger(y > 0.7, do=do)])])
@pytest.mark.parametrize("to, expected", [(0.0, 0.6), (1.0, 1.3), (3.0, 3.3), (my.where(x > 1, 0.0, 3.0), 0.6)])
def test_an_action_may_move_the_state_to_either_side(do, to, expected):
    """x is 1.2 at 0.7, where it is set."""
    model = _reset(True, **do({x: to}))
    run = solved(model, start={x: 0.0, y: 0.0}, time=(0, 1.0))
    np.testing.assert_allclose(run["x"], expected, rtol=1e-12)


def test_an_impact_on_the_surface_of_a_switch_stays_on_its_side():
    """A ball on the ground, where where(x > 0, ...) is a switch: it never is below."""
    v, = my.states("v")
    below = my.accessory("below")
    ball = my.with_located_switches(my.model({x: v, v: my.where(x > 0, -1.0, 50.0)}, events=[
        my.event(x, name="impact", direction="falling", do={x: 0.0, v: -0.5 * v})],
        accessories={below: my.phase_minimum(x)}))
    assert ball.events[0].name == "impact"
    run = solved(ball, start={x: 0.5, v: 0.0}, time=(0, 2.2), interpreted=False)
    assert run["status"] == "success" and run[below] > -1e-12


def test_events_keep_their_numbers_and_names():
    given = my.event(y - 0.2, name="first", do={y: y + c})
    model = my.model({x: my.where(x > c, -2.0, -1.0), y: 1.0}, events=[given, my.event(y - 0.9, name="second")],
                     accessories={my.integer_accessory("seen"): 0})
    switched = my.with_located_switches(model)
    assert [one.name for one in switched.events[:2]] == ["first", "second"]
    assert switched.parameters == model.parameters and switched.states == model.states
    run = solved(switched, {c: 0.5}, start={x: 1.0, y: 0.0}, time=(0, 1), events={"second": dict(stop_after=1)})
    assert run["status"] == "stopped_by_event" and "seen" in run.accessories
    assert not [name for name in run if "switch" in name]


def test_doses_are_given_to_a_model_with_located_switches_and_before():
    both = [my.with_located_switches(falling).with_doses(my.doses("x", 1.0, at=[0.6])),
            my.with_located_switches(falling.with_doses(my.doses("x", 1.0, at=[0.6])))]
    for model in both:  # 0.15 at 0.6, then from 1.15 on 0.5 after 0.325
        run = solved(model, {c: 0.5}, start={x: 1.0}, time=(0, 1))
        np.testing.assert_allclose(run["x"], 0.5 - 0.075, rtol=1e-12)


def test_sliding_ends_with_a_status_and_a_note():
    for rate in (my.where(x > 0, -1.0, 1.0), 0.3 - np.sign(x), -np.sign(x - my.sin(t)) * 3):
        run = solved(my.with_located_switches(my.model({x: rate}, name="slides")), start={x: 1.0}, time=(0, 3))
        assert run["status"] == "event_accumulation"
        assert "if both sides lead to the jump" in str(run.report)
    result = my.study(my.with_located_switches(my.model({x: -np.sign(x)})), my.grid({x: [0.5, 5.0]}), time=(0, 3),
                      interpreted=True).run()
    assert result["status"].tolist() == ["event_accumulation", "success"] and "slide" in str(result)


# -- Derivatives -------------------------------------------------------------------------------------------------------

def test_derivatives_by_what_moves_a_switch_are_exact():
    """x is (c - 1) / 2 at the end."""
    run = my.solve(located, {c: [0.2, 0.5, 0.9]}, start={x: 1.0}, time=(0, 1), free=[c, x], method="dormand_prince_5")
    np.testing.assert_allclose(run.sensitivity[x, c], 0.5, rtol=1e-13)
    np.testing.assert_allclose(run.sensitivity[x, x], 0.5, rtol=1e-13)
    assert not [note for note in run.report.notes if "jump" in note]


def test_derivatives_of_summaries_and_of_several_switches_are_those_of_differences():
    area = my.accessory("area")
    model = my.with_located_switches(my.model(
        {x: my.where((x > c) | (y < K), -x, 0.3) + 0.1 * my.floor(3 * y), y: my.cos(t) - 0.2 * x},
        accessories={area: my.integral(my.where(x > c, 1.0, 0.0))}, name="several"))
    call = dict(start={x: 1.0, y: 0.4}, time=(0, 4), method="dormand_prince_5", rtol=1e-11, atol=1e-12)
    point, step = {"c": 0.31, "K": 0.77}, 1e-6
    run = my.solve(model, point, free=[c, K], **call)
    for name in point:
        up, down = (my.solve(model, {**point, name: point[name] + by}, **call) for by in (step, -step))
        for of in (x, y, area):
            slope = (up[of] - down[of]) / (2 * step)
            np.testing.assert_allclose(run.sensitivity[of, name], slope, rtol=2e-5, atol=2e-6, err_msg=name)


def test_a_fit_of_a_threshold_finds_it():
    data = {"t": np.array([0.1, 0.4, 0.6, 1.0]), x: np.array([0.8, 0.3, 0.1, -0.3])}  # c = 0.4
    found = my.fit(located, data, free={c: (0.1, 0.9)}, start={x: 1.0}, starts=3, seed=1)
    np.testing.assert_allclose(found.best["c"], 0.4, atol=1e-6)


def test_lyapunov_exponents_go_through_the_saltation_of_a_switch():
    """The derivative of an autonomous solution by its start is the quotient of its slopes."""
    model = my.with_located_switches(my.model({x: my.where(x > 1, -2 * x, -x)}))
    run = my.solve(my.with_tangents(model, 1), start={x: 3.0}, time=(0, 1.5), method="dormand_prince_5", rtol=1e-11,
                   atol=1e-12)
    slope = np.exp(-(1.5 - np.log(3) / 2)) / 6.0
    np.testing.assert_allclose(run["exponent_1_end"], np.log(slope) / 1.5, rtol=1e-9)


def test_what_there_is_not_is_refused_by_name():
    with pytest.raises(my.Error, match="no adjoint, as its switches are located"):
        my.batched(located, free=[c], of=[x], start={x: 1.0}, time=(0, 1), adjoint=True)
    with pytest.raises(my.Error, match="before anything is made of it"):
        my.with_located_switches(my.with_tangents(falling))
    with pytest.raises(my.Error, match="has noise"):
        my.with_located_switches(my.model({x: my.where(x > c, -2.0, -1.0)}, noise={x: 0.1}))


def test_the_note_on_jumps_and_their_refusal_name_the_cure():
    assert "my.with_located_switches(model)" in state_jumps.note(falling)
    assert state_jumps.note(located) is None


# -- Where it is computed ----------------------------------------------------------------------------------------------

@pytest.mark.parametrize("precision", ["double", "float"])
def test_compiled_and_interpreted_models_agree(precision):
    model = my.with_located_switches(my.model({x: my.where(x > c, -2.0 * x, -1.0) + 0.2 * (y // 1), y: 1.0 - 0.1 * x},
                                              name="agrees"))
    call = dict(start={x: 1.0, y: 0.0}, time=(0, 2.5), method="dormand_prince_5", precision=precision, rtol=1e-5,
                atol=1e-6)
    sweep = {c: np.linspace(0.1, 0.9, 20)}
    compiled = my.solve(model, sweep, **call)
    interpreted = my.solve(model, sweep, interpreted=True, **{**call, "precision": "double"})
    np.testing.assert_allclose(compiled["x"], interpreted["x"], rtol=1e-13 if precision == "double" else 2e-5)
    result = my.study(model, my.grid(sweep), **call).run()
    np.testing.assert_array_equal(result["x_end"], compiled["x"])


def test_a_mass_matrix_and_a_stiff_method_go_with_located_switches():
    model = my.with_located_switches(my.model({x: my.where(x > c, -2.0, -1.0), y: y - x**2}, mass_matrix={y: 0}))
    run = my.solve(model, {c: 0.5}, start={x: 1.0, y: 1.0}, time=(0, 1), method="rodas_5p", rtol=1e-9, atol=1e-11)
    np.testing.assert_allclose([run["x"], run["y"]], [[-0.25], [0.0625]], rtol=1e-8)


def test_files_have_located_switches():
    model = my.with_located_switches(my.read_xpp("par c=0.5\nx'=-1-heav(x-c)\nx(0)=1\naux twice=2*x"))
    run = solved(model, {"c": [0.2, 0.5]}, time=(0, 1))
    np.testing.assert_allclose(run["twice"], [-0.8, -0.5], rtol=1e-14)
    result = my.study(model, my.grid(c=[0.2, 0.5]), time=(0, 1), interpreted=True).run()
    np.testing.assert_allclose(result["twice_end"], [-0.8, -0.5], rtol=1e-14)


# -- Delays ------------------------------------------------------------------------------------------------------------

u, = my.states("u")
tau = my.parameter("tau")


@pytest.mark.parametrize("tolerance", [1e-5, 1e-9])
def test_a_switch_by_the_past_is_located_also_where_the_delay_vanishes(tolerance):
    """Problem B2 of DDETST, whose u(t) is 66 e^-t - 1 at the end."""
    model = my.with_located_switches(my.model({u: my.where(my.delayed(u, t / 2) < 0, 1, -1) - u}, name="b2"))
    end = 2 * np.log(66)
    run = my.solve(model, start={u: 1.0}, time=(0, end), rtol=tolerance, atol=tolerance, method="dormand_prince_5")
    assert run["status"] == "success"
    np.testing.assert_allclose(run["u"], 66 * np.exp(-end) - 1, atol=20 * tolerance)


def test_a_relay_with_a_delay_has_its_period():
    """u' = -sign(u(t - 1)) is a triangle with the period 4 that goes from -1 to 1."""
    model = my.with_located_switches(my.model({u: -np.sign(my.delayed(u, tau))}, name="relay"))
    run = my.solve(model, {tau: [0.5, 1.0]}, start={u: 0.5}, time=(0, 10.25), samples=[5.0, 9.0, 10.0, 10.25],
                   rtol=1e-8, atol=1e-8, method="dormand_prince_5")
    # falls until u(t - tau) = 0: from 0.5 to -tau at 0.5 + tau, then up to tau at 0.5 + 3 tau
    def triangle(at, lag):
        phase = (at - 0.5 + lag) % (4 * lag)
        return np.where(phase < 2 * lag, lag - phase, phase - 3 * lag)
    np.testing.assert_allclose(run["u_sample"], [triangle(run["t_sample"][0], lag) for lag in (0.5, 1.0)], atol=1e-9)


def test_a_past_that_jumps_across_a_switch_switches():
    """u is -1, and 1 from 1 on; v' is 1, and 3 from 1 + tau on, as u is seen a while later."""
    v, = my.states("v")
    model = my.with_located_switches(my.model({u: 0.0, v: my.where(my.delayed(u, tau) > 0, 3.0, 1.0)}, stops=my.stop(
        1, do={u: 1.0}), name="late"))
    run = my.solve(model, {tau: [0.25, 0.5]}, start={u: -1.0, v: 0.0}, time=(0, 2), method="dormand_prince_5")
    np.testing.assert_allclose(run[v], [1.25 + 3 * 0.75, 1.5 + 3 * 0.5], rtol=1e-12)
