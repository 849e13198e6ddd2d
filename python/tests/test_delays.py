# SPDX-License-Identifier: MIT
"""Models with delays: how they are recorded and written, against solutions by the method of steps, and what is
refused."""

import math
import pathlib
import pickle
import signal
import subprocess
import sys

import numpy as np
import pytest

import myriad_ode as my
from myriad_ode.models.delays import own_names
from myriad_ode.solving.past import steps_to_keep

x, y, k_seen = my.states("x y k_seen")
k, tau, sigma = my.parameters("k tau sigma")
t = my.time
exact = dict(rtol=1e-10, atol=1e-12)


def powers(times, terms):
    """The sum of weight * (t - begin)^n / n! over the terms (weight, begin, n) that have begun."""
    return sum(weight * np.maximum(times - begin, 0)**n / math.factorial(n) for weight, begin, n in terms)


def with_two_lags(times, a, b, first, second):
    """The solution of x' = a x(t - first) + b x(t - second), which was 1 before: its Laplace transform as a series."""
    return 1 + (a + b) * powers(times, [
        (math.comb(i + j, i) * a**i * b**j, i * first + j * second, i + j + 1) for i in range(30) for j in range(30)])


# -- Recorded ----------------------------------------------------------------------------------------------------------

def test_equal_states_and_lags_are_one_delayed_value():
    assert my.delayed(x, tau) is my.delayed(x, tau) and my.delayed(x, 2) is my.delayed(x, 2.0)
    model = my.model({x: my.delayed(x, tau) * my.delayed(x, tau), y: my.delayed(y, tau) + my.delayed(x, 2 * tau)},
                     events=my.event(my.delayed(x, tau) - 1))
    assert [(d.state, str(d.lag)) for d in model.delays] == [("x", "tau"), ("x", "2 * tau"), ("y", "tau")]


def test_states_and_the_time_of_a_delayed_expression_are_those_of_then_and_parameters_those_of_now():
    assert repr(my.delayed(k * x * my.sin(t), tau)) == "k * delayed(x, tau) * sin(time - tau)"
    assert my.delayed(k, tau) is k and my.delayed(3.0, tau).value == 3
    assert repr(my.delayed(x > y, 2)) == "delayed(x, 2) > delayed(y, 2)"


def test_lags_of_delays_of_delays_add_up():
    assert my.delayed(my.delayed(x, 1.0), tau) is my.delayed(x, 1.0 + tau)
    assert repr(my.delayed(my.delayed(x, tau), x * x)) == "delayed(x, tau + x * x)"
    with pytest.raises(my.Error, match="would be that of then"):
        my.delayed(my.delayed(x, 1 + x * x), tau)


def test_arrays_are_delayed_element_by_element():
    both = my.delayed([x, y], tau)
    assert both[0] is my.delayed(x, tau) and both[1] is my.delayed(y, tau)
    lags = my.delayed(x, np.array([tau, 2 * tau], dtype=object))
    assert lags[1] is my.delayed(x, 2 * tau)


def test_texts_sympy_and_functions_have_delays():
    sympy = pytest.importorskip("sympy")
    wanted = my.model({x: k * my.delayed(x, tau)}).cpp("model")
    assert my.model("x' = k * delayed(x, tau)", parameters="k tau").cpp("model") == wanted
    s, now, by, lag = sympy.Function("x"), *sympy.symbols("t k tau")
    assert my.model({s(now): by * s(now - lag)}, parameters="k tau").cpp("model") == wanted

    def f(t, y, k, tau):
        return k * my.delayed(y[0], tau)

    assert my.model(f, states="x").cpp("model") == wanted
    with pytest.raises(my.Error, match="no value of the past"):
        my.model({s(now): s(lag * by)}, parameters="k tau")


def test_delayed_values_are_pickled():
    one = my.delayed(x * my.sin(t), tau + x)
    assert pickle.loads(pickle.dumps(one)) is one


# -- Written -----------------------------------------------------------------------------------------------------------

def test_a_model_with_delays_in_cpp():
    model = my.model({x: k * my.delayed(x, tau) - y, y: my.delayed(y, 0.5) + my.delayed(x, 2 * tau)}, name="both",
                     history={x: my.cos(t), y: k})
    assert model.cpp().partition("struct ")[2] == """both {
    static constexpr int rhs_weight = 3;
    enum state { x, y, n_state };
    enum parameter { k, tau, n_parameter };
    enum delayed { x_past, x_past_2, y_past, n_delayed };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& s, const auto& p) {
        return {p[k] * p.delayed[x_past] - s[y], p.delayed[y_past] + p.delayed[x_past_2]};
    }

    /// The state that a delayed value is of.
    MYRIAD_FUNCTION static int delayed_state(int number) {
        if (number == x_past) return x;
        if (number == x_past_2) return x;
        return y;
    }

    /// How long ago it was.
    template <class R>
    MYRIAD_FUNCTION static R lag(int number, const auto& p) {
        if (number == x_past) return p[tau];
        if (number == x_past_2) return 2 * p[tau];
        return R(0.5);
    }

    /// Its value before the begin.
    template <class R>
    MYRIAD_FUNCTION static R history(int number, const R& t, const auto& p) {
        if (number == x_past) return myriad::cos(t);
        if (number == x_past_2) return myriad::cos(t);
        return p[k];
    }
};
"""


def test_one_lag_that_changes_gives_all_the_general_form():
    text = my.model({x: my.delayed(x, 1 + y * y) + my.delayed(y, t / 2), y: my.delayed(x, tau)}).cpp()
    assert "R lag(int number, const R& t, const myriad::vec<R, n_state>& s, const auto& p) {" in text
    assert "return 1 + s[y] * s[y];" in text and "return p[tau];" in text


def test_some_states_may_have_a_history_and_others_their_initial_value():
    text = my.model({x: my.delayed(x, 1), y: my.delayed(y, 1)}, history={x: my.exp(t)}).cpp()
    assert "static bool has_history(int number) {\n        return number == x_past;" in text
    assert "has_history" not in my.model({x: my.delayed(x, 1), y: x}, history={x: my.exp(t)}).cpp()


def test_a_model_without_delays_has_nothing_of_them():
    text = my.model({x: y, y: -k * x}, name="plain").cpp()
    assert text == """// SPDX-License-Identifier: MIT
// Written by Myriad's Python package from a traced model.
#pragma once

#include <myriad/model.hpp>

/// x' = y
/// y' = -k * x
struct plain {
    static constexpr int rhs_weight = 2;
    enum state { x, y, n_state };
    enum parameter { k, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& s, const auto& p) {
        return {s[y], -p[k] * s[x]};
    }
};
"""


def test_names_of_delays_are_names_of_components_where_there_are_none():
    for name in own_names:
        value = my.parameter(name)
        assert my.model({x: -value * x}).parameters == [name]
        with pytest.raises(my.Error, match=f"'{name}' names a parameter.*a model with delays: call it '{name}_'"):
            my.model({x: -value * my.delayed(x, 1)})
    past = my.parameter("x_past")  # that of a component is no other's
    assert my.model({x: past * my.delayed(x, 1)}).delays[0].name == "x_past_"


def test_delays_in_latex():
    model = my.model({x: my.delayed(x, tau) + my.delayed(y, 1 + y), y: 0}, history={x: my.exp(t)})
    text = model.latex()
    assert r"x\left(t - \tau\right) + y\left(t - \left(1 + y\right)\right)" in text
    assert r"\text{before the begin:} & \; x = e^{t}" in text


# -- Solutions ---------------------------------------------------------------------------------------------------------

def test_the_method_of_steps():
    """x' = -x(t - 1), which was 1."""
    run = my.solve(my.model({x: -my.delayed(x, 1)}), start={x: 1}, time=(0, 6), samples=61, **exact)
    wanted = 1 - powers(run["t_sample"], [((-1)**i, i, i + 1) for i in range(7)])
    np.testing.assert_allclose(run["x_sample"], wanted, atol=1e-8)


def test_two_lags_that_differ_between_instances():
    """Of two delayed values of one state, by a series."""
    lags = np.array([[0.5, 1.25], [1.0, 0.75], [0.8, 0.8], [2.5, 0.3]])
    model = my.model({x: k * my.delayed(x, tau) - 0.5 * my.delayed(x, sigma)})
    run = my.solve(model, {tau: lags[:, 0], sigma: lags[:, 1], k: -1.0}, start={x: 1}, time=(0, 4), samples=41, **exact)
    for row, (first, second) in enumerate(lags):
        np.testing.assert_allclose(run["x_sample"][row], with_two_lags(run["t_sample"][row], -1.0, -0.5, first, second),
                                   atol=1e-8)


def test_a_history_is_what_was_before_and_where_the_state_begins():
    """x' = -x(t - pi / 2) of cos(t)."""
    model = my.model({x: -my.delayed(x, tau)}, history={x: my.cos(t)})
    begins = np.array([0.0, 0.5, 2.0])
    run = my.solve(model, {tau: np.pi / 2}, time=(begins, begins + 5), samples=11, **exact)
    np.testing.assert_array_equal(run["x_start"], np.cos(begins))
    np.testing.assert_allclose(run["x_sample"], np.cos(run["t_sample"]), atol=1e-8)


def of_table(kind, times, outside="nan"):
    """x' = -x(t - pi / 2), where a table has cos(t)."""
    return my.model({x: -my.delayed(x, tau)}, name="of_table",
                    history={x: my.interpolate(t, times, np.cos(times), kind=kind, outside=outside)})


@pytest.mark.parametrize("kind, interpreted, error, call", [
    ("cubic", False, 1e-9, dict(method="dormand_prince_5", **exact)),
    ("cubic", True, 1e-9, dict(method="rodas_5p", history_steps=1024, **exact)),
    ("linear", True, 2e-5, dict(method="runge_kutta_4", step=0.01))])
def test_tables_are_histories(kind, interpreted, error, call):
    for times in (np.linspace(-2, 0, 201), -np.linspace(0, 2**0.5, 201)[::-1]**2):
        run = my.solve(of_table(kind, times), {tau: np.pi / 2}, time=(0, 5), samples=11, interpreted=interpreted,
                       **call)
        assert run.report.failed == 0
        np.testing.assert_allclose(run["x_sample"], np.cos(run["t_sample"]), atol=error)


def test_a_table_that_ends_too_early_is_refused_or_a_status():
    times = np.linspace(-2, 0, 21)
    known = dict(time=(0, 1), interpreted=True)
    for lag, time, missing in ((3.0, (0, 1), "-3"), (np.array([1.0, 2.5]), (0, 1), "-2.5"), (1.0, (0.5, 1), "0.5")):
        with pytest.raises(my.Error, match=f"the history of x .*has no value at {missing}, which `delayed"):
            my.solve(of_table("linear", times), {tau: lag}, **{**known, "time": time})
    assert my.solve(of_table("linear", times, "hold"), {tau: 3.0}, **known)["status"] == "success"
    changing = my.model({x: -my.delayed(x, 1.5 + 2 * t)}, history={x: my.interpolate(t, times, times, outside="nan")})
    assert my.solve(changing, **known)["status"] == "not_finite"
    with pytest.raises(my.Error, match="outside is 'never'"):
        my.interpolate(t, times, times, outside="never")


def test_stops_where_kinks_of_a_table_arrive_end_steps_there():
    times, values = np.array([-2, -1.3, -0.6, 0.0]), np.array([0, 1, -1, 1.0])
    before, ends = {x: my.interpolate(t, times, values)}, my.stop((times[1:-1] + 1.7).tolist())
    whole = np.interp(-1.7, times, values), np.interp(0, times, values)
    wanted = whole[1] + np.trapezoid([whole[0], *values[1:]], [-1.7, *times[1:]])
    call = dict(time=(0, 1.7), interpreted=True, rtol=1e-6, atol=1e-6)
    across = my.solve(my.model({x: my.delayed(x, 1.7)}, history=before), **call)
    exactly = my.solve(my.model({x: my.delayed(x, 1.7)}, history=before, stops=ends), **call)
    assert across.report.rejected_steps > 10 and exactly.report.rejected_steps == 0
    assert abs(across["x"][0] - wanted) > 1e-6
    assert exactly["x"][0] == pytest.approx(wanted, abs=1e-12)


def test_fixed_steps_keep_what_their_longest_lag_needs():
    model = my.model({x: -my.delayed(x, tau) - my.delayed(x, 0.5)})

    def kept(lag, domain=(0, 100), of=model, method="runge_kutta_4", **options):
        return steps_to_keep(of, method, {"tau": np.asarray(lag)}, domain, my.Options(step=0.01, **options))

    assert 3000 < kept([1.0, 30.0]) < 3050  # the longest of all instances, with steps at jumps
    assert 500 < kept(30.0, (0, 5)) < 550 and 1500 < kept(30.0, (0, 5), phases=3) < 1550
    assert kept(np.nan) == kept([-1.0, np.inf]) == kept(0.5) < 100
    assert kept(1e7, (0, 1e7)) == 1048576
    many = my.model({x: -sum(my.delayed(x, 0.01 * (i + 1)) for i in range(100))})
    assert 2 * 5151 < kept(1.0, of=many) < 2 * 5151 + 200  # jumps up to the second derivative, as the kernel follows
    assert kept(1.0, history_steps=64) is kept(1.0, method="tsitouras_5") is None  # as it is told, or unknown
    assert kept(1.0, of=my.model({x: my.delayed(x, tau * t)})) is None
    assert kept(0.1, of=my.model({x: my.delayed(x, tau)}, stops=my.stop(1, do={x: 2}))) == 1024  # as actions jump
    assert kept(1.0, of=my.model({x: my.delayed(x, tau)}, finalise={tau: 9.0})) is None
    run = my.solve(my.model({x: -my.delayed(x, tau)}), {tau: [0.01, 0.0101, 0.05, 30.0]}, start={x: 1}, time=(0, 60),
                   method="runge_kutta_4", step=0.01, interpreted=True)
    assert run.report.failed == 0
    assert run["x"][-1] == pytest.approx(1 - 60 + 30**2 / 2, abs=1e-9)
    axes = my.grid({tau: my.linspace(0.5, 30, 3), sigma: [1.0, 29.0]})
    both = my.model({x: -my.delayed(x, tau) - my.delayed(x, sigma)})
    call = dict(start={x: 1}, time=(0, 40), method="runge_kutta_4", step=0.01, interpreted=True)
    studied = my.study(both, axes, keep=[x], **call).run()
    np.testing.assert_array_equal(studied["x_end"].ravel(), my.solve(both, axes, **call)["x"].ravel())
    assert (studied["status"] == "success").all()
    drawn = my.study(of_table("linear", np.array([-2.0, 0.0])), {tau: my.uniform(2.5, 3)}, draws=8,
                     **{**call, "start": {}})
    assert drawn.run().by_status == {"not_finite": 8}


def test_a_state_may_begin_elsewhere_than_its_history_ends():
    """x' = x(t - 1), which was k t, and begins with 3."""
    model = my.model({x: my.delayed(x, 1)}, history={x: k * t})
    run = my.solve(model, {k: [1.0, 2.0]}, start={x: 3}, time=(0, 2), **exact)
    first = 3 + np.array([1.0, 2.0]) * (1 / 2 - 1)  # at t = 1
    np.testing.assert_allclose(run["x"], first + 3 + np.array([1.0, 2.0]) * (1 / 6 - 1 / 2), atol=1e-8)


def test_one_of_two_states_has_a_history():
    """x' = x(t - 1), which was t, and y' = y(t - 1), which was 2."""
    model = my.model({x: my.delayed(x, 1), y: my.delayed(y, 1)}, history={x: t})
    run = my.solve(model, start={x: 0, y: 2}, time=(0, 1), **exact)
    np.testing.assert_allclose([run["x"][0], run["y"][0]], [-0.5, 4.0], atol=1e-9)


def test_a_delayed_expression():
    """x' is (k t x)(t - 1), and x was 1."""
    run = my.solve(my.model({x: my.delayed(k * t * x, 1)}), {k: [1.0, 3.0]}, start={x: 1}, time=(0, 1), **exact)
    np.testing.assert_allclose(run["x"], 1 + np.array([1.0, 3.0]) * (1 / 2 - 1), atol=1e-9)


def test_a_lag_that_depends_on_the_state():
    """x' = x x(log x) / t, which was 1 before t = 1: t, and exp(t / e) from e on (Neves, ACM TOMS 1 (1975) 357)."""
    model = my.model({x: x * my.delayed(x, t - my.log(x)) / t})
    run = my.solve(model, start={x: 1}, time=(1, 7), samples=25, **exact)
    times = run["t_sample"]
    np.testing.assert_allclose(run["x_sample"], np.where(times < np.e, times, np.exp(times / np.e)), rtol=1e-7)


def test_a_jump_is_located_where_the_time_that_is_seen_runs_much_faster_than_t():
    """y' = x(z), where x jumps from 1 to 2 at 150 and z runs from 0 at t = 200."""
    z, speed = my.state("z"), my.state("speed")
    model = my.model({x: 0, y: my.delayed(x, t - z), z: speed, speed: 0},
                     stops=[my.stop(150, do={x: 2}), my.stop(200, do={speed: k})])
    rates = np.geomspace(1e4, 1e6, 256)
    ends = 200 + 180 / rates
    run = my.solve(model, {k: rates}, start={x: 1, y: 0, z: 0, speed: 0}, time=(0, ends), rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(run["y"], ends + (ends - 200 - 150 / rates), atol=1e-10, rtol=0)


def test_events_on_delayed_values_and_actions_that_read_them():
    model = my.model({x: 1, y: 0}, events=[
        my.event(my.delayed(x, tau) - 0.5, name="late", direction="rising", stop_after=1)])
    lags = np.array([0.25, 1.0, 1.75])
    run = my.solve(model, {tau: lags}, start={x: 0, y: 0}, time=(0, 10), **exact)
    np.testing.assert_allclose(run["t_last"], 0.5 + lags, atol=1e-9)
    model = my.model({x: 1, y: 0}, events=my.event(x - 2, do={y: my.delayed(x, tau)}))
    run = my.solve(model, {tau: lags}, start={x: 0, y: 0}, time=(0, 3), **exact)
    np.testing.assert_allclose(run["y"], 2 - lags, atol=1e-9)


def test_events_are_found_where_a_delay_is_shorter_than_the_step_and_where_it_vanishes():
    """u' = -u(t / 2) has the solution sum of (-t)^n / (n! 2^(n (n - 1) / 2))."""
    u, = my.states("u")
    past = my.delayed(u, t / 2)
    model = my.model({u: -past}, events=[my.event(u - 0.5), my.event(past - 0.5, stop_after=1)])
    run = my.solve(model, start={u: 1}, time=(0, 3), **exact)
    series = np.polynomial.Polynomial([(-1)**n / (math.factorial(n) * 2**(n * (n - 1) / 2)) for n in range(20)])
    assert run["status"] == "stopped_by_event" and series(run["t_last"][0] / 2) == pytest.approx(0.5, abs=1e-8)
    np.testing.assert_allclose(run["u_end"], series(run["t_last"]), atol=1e-8)


def test_the_start_of_a_phase_reads_the_past():
    seen = my.accessory("seen")
    equation, end = {x: my.delayed(x, 0.5)}, dict(method="dormand_prince_5", **exact)
    for before, at_begin in ((None, 2.0), ({x: 2 + t}, 1.75)):
        model = my.model(equation, initialise={seen: my.delayed(x, 0.25)}, history=before)
        at = my.solve(my.model(equation, history=before), start={x: 2}, time=(0, 3), samples=[0.75, 1.75], **end)
        expected = [[at_begin, *at["x_sample"][0]]]
        for phases in (dict(time=(0, 1)), dict(time=(0, 3), carry_on=True, phase_length=1)):
            run = my.solve(model, start={x: 2}, phases=3, record=[seen], **phases, **end)
            np.testing.assert_allclose(run[seen], expected, atol=1e-8)


def test_a_trigger_on_a_delayed_value():
    model = my.model({x: 1, y: 0}, triggers=my.trigger((my.delayed(x, tau) > 0.5) & (y < 1), do={y: y + 1}))
    run = my.solve(model, {tau: [0.25, 1.0]}, start={x: 0, y: 0}, time=(0, 2), samples=[0.7, 0.8, 1.4, 1.6])
    np.testing.assert_array_equal(run["y_sample"], [[0, 1, 1, 1], [0, 0, 0, 1]])


def test_a_jump_by_an_action_comes_again_after_the_lag():
    """y' = x(t - tau), where a stop changes x from 1 to 2 at t = 1."""
    model = my.model({x: 0, y: my.delayed(x, tau)}, stops=my.stop(1, do={x: 2}))
    lags = np.array([0.25, 0.5, 1.5])
    run = my.solve(model, {tau: lags}, start={x: 1, y: 0}, time=(0, 3), **exact)
    np.testing.assert_allclose(run["y"], 3 + (2 - lags), atol=1e-9)


def test_a_summary_of_a_delayed_value():
    peak = my.accessory("peak")
    model = my.model({x: 1}, accessories={peak: my.integral(my.delayed(x, tau))})
    run = my.solve(model, {tau: [0.5, 1.0]}, start={x: 0}, time=(0, 2), **exact)
    np.testing.assert_allclose(run["peak"], [1.5**2 / 2, 0.5], atol=1e-9)


def test_phases_go_on_in_the_past_of_those_before():
    model = my.model({x: -my.delayed(x, 1)})
    whole = my.solve(model, start={x: 1}, time=(0, 4), **exact)
    parts = my.solve(model, start={x: 1}, time=(0, np.inf), phases=8, phase_length=0.5, record=[x], **exact)
    np.testing.assert_allclose(parts["x"][0, -1], whole["x"][0], atol=1e-9)


def test_single_precision_and_fixed_steps():
    model = my.model({x: -my.delayed(x, tau)})
    wanted = 1 - powers(np.array(3.0), [((-1)**i, i, i + 1) for i in range(4)])
    single = my.solve(model, {tau: 1.0}, start={x: 1}, time=(0, 3), precision="float", rtol=1e-5, atol=1e-5)
    np.testing.assert_allclose(single["x"], wanted, atol=1e-4)
    fixed = my.solve(model, {tau: 1.0}, start={x: 1}, time=(0, 3), method="runge_kutta_4", step=1 / 64)
    np.testing.assert_allclose(fixed["x"], wanted, atol=1e-7)


@pytest.mark.parametrize("method", ["rodas_5p", "rosenbrock_23"])
def test_stiff_methods(method):
    """Of eight states, so that the derivatives by the present state are written. Seven follow x(t - tau), behind by a
    thousandth of its slope, which is -x(t - tau - 1)."""
    states = my.states("a b c d e f g x")
    model = my.model({s: -1000 * (s - my.delayed(x, tau)) for s in states[:-1]} | {x: -my.delayed(x, 1)})
    run = my.solve(model, {tau: [0.25, 0.5]}, start={s: 1 for s in states}, time=(0, 3), method=method, rtol=1e-7,
                   atol=1e-8, history_steps=4096)
    assert run.report.failed == 0
    solution = [1 - powers(3 - run["tau"] - i, [((-1)**j, j, j + 1) for j in range(4)]) for i in range(2)]
    np.testing.assert_allclose(run["x"], 1 - powers(np.array(3.0), [((-1)**j, j, j + 1) for j in range(4)]), atol=1e-5)
    np.testing.assert_allclose(run["a"], solution[0] + 1e-3 * solution[1], atol=1e-5)


def saw_integral(times):
    """The integral of a saw tooth that begins at 0 and falls from 1 to 0 at whole numbers."""
    whole = np.floor(np.maximum(times, 0))
    return whole / 2 + (np.maximum(times, 0) - whole)**2 / 2


def test_an_event_at_the_instant_where_a_jump_of_a_derivative_arrives_is_seen():
    """x is a saw tooth, seen a lag later, where it passes a half at multiples of the lag."""
    model = my.model({x: 1, y: my.delayed(x, tau), k_seen: 0}, events=[
        my.event(x - 1, direction="rising", do={x: 0}),
        my.event(my.delayed(x, tau) - 0.5, direction="rising", do={k_seen: k_seen + 1})])
    lags = np.array([1.0, 0.25, 0.125, 0.3])
    run = my.solve(model, {tau: lags}, start={x: 0, y: 0, k_seen: 0}, time=(0, 5.2), **exact)
    np.testing.assert_array_equal(run["k_seen"], np.floor(5.2 - lags - 0.5) + 1)
    np.testing.assert_allclose(run["y"], saw_integral(5.2 - lags), atol=1e-12)


def test_a_state_that_is_set_after_a_step_is_seen_so():
    """Of a method whose steps share what is kept of their ends. x is a saw tooth, and y what it was before the step."""
    model = my.model({x: 1, y: 0}, after_step={x: my.where(x > 0.93, x - 1, x), y: my.delayed(x, 0.55)})
    run = my.solve(model, start={x: 0, y: 0}, time=(0, [1.57, 1.6, 1.7, 2.57]), method="runge_kutta_4", step=0.1)
    np.testing.assert_allclose(run["y"], [0.02, 0.05, 0.15, 0.02], atol=1e-12)


def test_where_time_begins_again_slopes_may_jump_and_the_history_goes_on():
    """x' = t and y' = x(t - 1 / 2) over four phases; z' = -z(t - 2.5), of which z was t."""
    z = my.state("z")
    model = my.model({x: t, y: my.delayed(x, 0.5), z: -my.delayed(z, 2.5)}, history={z: t})
    run = my.solve(model, start={x: 0, y: 0}, time=(0, 1), phases=4, record=[y, z], method="cash_karp", rtol=1e-8,
                   atol=1e-8)
    assert run["x"] == pytest.approx(2)
    until = np.array([0.5, 1.5, 2.5, 3.5])  # x is n / 2 + s^2 / 2 in phase n
    whole = until - 0.5
    np.testing.assert_allclose(run["y"][0], whole * (whole - 1) / 4 + whole / 6 + whole / 4 + 1 / 48, atol=1e-7)
    np.testing.assert_allclose(run["z"][0, :2], [2.0, 3.0], atol=1e-7)


def test_time_that_an_action_turns_back_is_refused_with_delays():
    model = my.model({x: my.delayed(x, 1)}, events=my.event(t - 1.5, do={my.t_end: 1}))
    assert my.solve(model, start={x: 1}, time=(0, 3))["status"] == "invalid_delay"


def test_a_study_of_delays():
    model = my.model({x: -my.delayed(x, tau)})
    study = my.study(model, my.grid({tau: my.linspace(0.5, 1.5, 5)}), start={x: 1}, time=(0, 3), keep=[x], **exact)
    found = study.run()["x_end"]
    np.testing.assert_allclose(found, [with_two_lags(3.0, -1.0, 0.0, lag, 1.0) for lag in np.linspace(0.5, 1.5, 5)],
                               atol=1e-8)


# A relay that is set by what x was tau ago, in rings that are full after a few time units; and the same with a lag that
# vanishes at the begin, so that steps are iterated.
relay = my.model({x: y - 0.3 * x, y: 0}, events=my.event(my.delayed(x, tau) - y / 2, direction="rising", do={y: -y}),
                 after_step={y: my.where(my.delayed(x, tau) < -0.6, abs(y), y)})
vanishing = my.model({x: -2 * my.delayed(x, k * t) * (1 - x * x) + 0.5 * y, y: -my.delayed(x, tau * t / (1 + t))})
in_short_rings = dict(start={x: 0.5, y: 1}, time=(0, 20), rtol=1e-6, atol=1e-6, maximum_step=1 / 16)


def sweep_of(model):
    return {tau: np.linspace(0.3, 1.5, 101)} | ({k: np.linspace(0.05, 0.3, 101)} if model is vanishing else {})


def study_of(model, **more):
    return my.study(model, sweep_of(model), keep=[x, y], **{**in_short_rings, "history_steps": 128, **more})


@pytest.mark.parametrize("model, method", [
    (relay, "dormand_prince_5"), pytest.param(vanishing, "cash_karp"),
    pytest.param(vanishing, "verner_7", marks=pytest.mark.long)])
def test_order_threads_and_chunks_change_no_bit(model, method):
    whole = my.solve(model, sweep_of(model), history_steps=128, method=method, device="cpu:1", **in_short_rings)
    assert whole.report.failed == 0 and whole.accepted_steps.min() > 300
    back = my.solve(model, {name: values[::-1] for name, values in sweep_of(model).items()}, history_steps=128,
                    method=method, device="cpu:2", **in_short_rings)
    one = my.solve(model, {name: values[57] for name, values in sweep_of(model).items()}, history_steps=128,
                   method=method, **in_short_rings)
    studied = study_of(model, method=method).run(chunk=7, device="cpu:2")
    for state in "xy":
        np.testing.assert_array_equal(back[state][::-1], whole[state])
        assert one[state][0] == whole[state][57]
        np.testing.assert_array_equal(studied[f"{state}_end"], whole[state])


SLOW = f"""
import sys
sys.path.insert(0, {str(pathlib.Path(__file__).parent)!r})
from test_delays import long_study
begun = lambda done, total: done > 20 and print("begun", flush=True)
long_study().run(sys.argv[1], chunk=5, device="cpu:1", progress=begun)
"""


def long_study():
    return study_of(relay, maximum_step=1 / 1024, history_steps=2048, time=(0, 60))


def test_a_study_that_was_killed_in_the_middle_of_rings_goes_on_to_the_same_bits(tmp_path):
    study_of(relay).run(device="cpu:1")  # so that the other process finds the kernel
    child = subprocess.Popen([sys.executable, "-c", SLOW, str(tmp_path / "store")], stdout=subprocess.PIPE, text=True)
    assert child.stdout.readline() == "begun\n"
    child.send_signal(signal.SIGKILL)
    child.communicate(timeout=60)
    before = my.open_study(tmp_path / "store").done
    assert 0 < before < 101
    result = long_study().run(tmp_path / "store", device="cpu:2")
    assert result.complete and result.instances == 101 - before
    expected = long_study().run(device="cpu:2")
    np.testing.assert_array_equal(result["x_end"], expected["x_end"])
    np.testing.assert_array_equal(result["y_end"], expected["y_end"])


def test_a_ring_that_is_too_short_and_lags_that_cannot_be_are_statuses():
    model = my.model({x: -my.delayed(x, tau)})
    run = my.solve(model, {tau: [1.0, -1.0, np.nan]}, start={x: 1}, time=(0, 5), invalid="mark")
    assert list(run.status[:2]) == ["success", "invalid_delay"] and run.failed[2]
    short = my.solve(model, {tau: 1.0}, start={x: 1}, time=(0, 5), maximum_step=1 / 64, history_steps=16)
    assert list(short.status) == ["history_overflow"]
    enough = my.solve(model, {tau: 1.0}, start={x: 1}, time=(0, 5), maximum_step=1 / 64, history_steps=128)
    assert list(enough.status) == ["success"]


def test_slopes_after_a_hook_see_the_history_as_the_hook_has_left_it():
    model = my.model({x: my.delayed(y, 10), y: 0}, after_step={k: k + 1}, history={y: k})
    run = my.solve(model, {k: [1.0, 2.0]}, start={x: 0, y: 0}, time=(0, 4), method="runge_kutta_4", step=0.25)
    np.testing.assert_array_equal(run["x"], [0.25 * (16 * first + 120) for first in (1, 2)])


# -- Outputs of files --------------------------------------------------------------------------------------------------

def test_an_output_of_a_file_reads_the_past_of_its_samples():
    model = my.read_xpp("x'=-x\nx(0)=exp(-t)\npar d=1\naux past=delay(x,d)\naux later=delay(x,t/2)\ndone\n")
    lags = np.array([0.5, 1.0, 3.0])
    run = my.solve(model, {"d": lags}, time=(0, 2), samples=9, **exact)
    np.testing.assert_allclose(run["past_sample"], np.exp(lags[:, None] - run["t_sample"]), rtol=1e-9)
    np.testing.assert_allclose(run["later"], np.exp(-run["t_sample"] / 2), rtol=1e-9)
    np.testing.assert_allclose(run["past_end"], np.exp(lags - 2), rtol=1e-9)
    assert "past" not in my.solve(model, {"d": 1.0}, time=(0, 2), phases=2, record=["x"])


def test_xppauts_history_is_zero_where_the_file_has_none():
    text = "x'=-delay(x,1)\ny'=-del_shft(x,1,1)\ninit x=2\ny(0)=1+t\ndone\n"
    run = my.solve(my.read_xpp(text), time=(0, 0.5), **exact)
    np.testing.assert_allclose([run["x"][0], run["y"][0]], [2.0, 1 - 0.125], atol=1e-9)


def test_an_event_of_xppaut_sets_what_a_state_was():
    """Where there is no delay in the equations, and x was 3 t."""
    text = "x'=3\nlate'=0\nx(0)=3*t\nglobal 1 {x-3} {late=delay(x,2)}\nglobal 1 {x-6} {late=delay(x,0.5)}\ndone\n"
    run = my.solve(my.read_xpp(text), time=(0, 3), samples=[0.5, 1.5, 2.5], **exact)
    np.testing.assert_allclose(run["late_sample"][0], [0.0, -3.0, 4.5], atol=1e-9)


# -- Slopes of the past ------------------------------------------------------------------------------------------------

def test_slopes_of_the_past_are_delayed_values_of_their_own():
    slope = my.delayed_slope(x, tau)
    assert slope is my.delayed_slope(x, tau) and slope is not my.delayed(x, tau)
    assert my.delayed(slope, 2) is my.delayed_slope(x, tau + 2) and repr(slope) == "delayed_slope(x, tau)"
    assert pickle.loads(pickle.dumps(my.model({x: slope}))).delays[0].is_slope
    model = my.model({x: slope + my.delayed(x, tau), y: my.delayed(x, 2 * tau)})
    assert [one.name for one in model.delays] == ["x_slope", "x_past", "x_past_2"]
    assert "return number == x_slope;" in model.cpp() and r"\dot{x}\left(t - \tau\right)" in model.latex()
    both = my.delayed_slope([x, y], [tau, 1.0])
    assert both[0] is slope and both[1] is my.delayed_slope(y, 1.0)
    assert my.model("x' = k * delayed_slope(x, tau)", parameters="k tau").cpp("m") == my.model({x: k * slope}).cpp("m")
    with pytest.raises(my.Error, match=r"delayed_slope\(x \* y, ...\).*only the slopes of states"):
        my.delayed_slope(x * y, tau)


def test_a_neutral_equation_against_its_closed_solution():
    # x' + x = k (x'(t - tau) + x(t - tau)): the left side is k^n in the n-th interval of length tau.
    model = my.model({x: k * (my.delayed_slope(x, tau) + my.delayed(x, tau)) - x})
    factors, lags = np.array([-0.7, 0.3, 0.9]), np.array([1.0, 0.6, 1.7])
    run = my.solve(model, {k: factors, tau: lags}, start={x: 1}, time=(0, 4.5), **exact)
    for i, (factor, lag) in enumerate(zip(factors, lags)):
        expected, power, begin = 1.0, 1.0, 0.0
        while begin < 4.5:
            power *= factor
            expected = power + (expected - power) * math.exp(-min(lag, 4.5 - begin))
            begin += lag
        assert run["x_end"][i] == pytest.approx(expected, abs=1e-8)


# -- Derivatives -------------------------------------------------------------------------------------------------------

jumping = my.model({x: x / 10 - k * my.delayed(x, tau)}, history={x: 2 + my.sin(k * t)})


def test_sensitivities_by_parameters_delays_and_initial_values_equal_differences():
    options = dict(time=(0, 5.5), rtol=1e-11, atol=1e-11, history_steps=1024)
    sweep = {tau: np.linspace(0.9, 1.6, 5), k: 1.1}
    run = my.solve(jumping, sweep, start={x: 0.7}, free=[tau, k, x], **options)
    assert (run.status == "success").all()
    h = 1e-3
    for name in (tau, k, x):
        ends = {}
        for step in (-2, -1, 1, 2):
            changed = {key: value + step * h * (key is name) for key, value in sweep.items()}
            ends[step] = my.solve(jumping, changed, start={x: 0.7 + step * h * (name is x)}, **options)["x_end"]
        expected = (8 * (ends[1] - ends[-1]) - (ends[2] - ends[-2])) / (12 * h)
        np.testing.assert_allclose(run[f"x_by_{name}_end"], expected, rtol=1e-6, atol=1e-6)


def test_a_delay_is_found_by_a_fit():
    at = np.linspace(0.5, 12, 24)
    truth = my.solve(jumping, {tau: 1.2, k: 0.8}, start={x: 0.7}, time=(0, 12), samples=at, **exact)
    fit = my.fit(jumping, {"t": at, x: truth["x_sample"][0]}, free={tau: (0.8, 1.8), k: (0.4, 1.2)}, start={x: 0.7},
                 rtol=1e-8, atol=1e-8)
    assert fit.best["tau"] == pytest.approx(1.2, abs=1e-5) and fit.best["k"] == pytest.approx(0.8, abs=1e-5)


def test_the_largest_exponent_of_a_delayed_equation():
    # x' = k x(t - 1): the real part of Lambert's W at k, the solution w of w exp(w) = k with the largest.
    grown = my.with_tangents(my.model({x: k * my.delayed(x, 1)}), transient_phases=20)
    run = my.solve(grown, {k: [1.0, -0.3]}, start={x: 0}, time=(0, np.inf), phases=220, phase_length=2.0, **exact)
    np.testing.assert_allclose(my.exponents(run)[:, 0], [0.5671432904097838, -0.4894022271802149], atol=1e-6)


# -- Refused -----------------------------------------------------------------------------------------------------------

delaying = my.model({x: -my.delayed(x, tau)})
neutral = my.model({x: k * my.delayed_slope(x, tau) - x})
bent = my.model({x: -my.delayed(x, tau + x**2)})


@pytest.mark.parametrize("lag, said", [
    (0, "positive and finite"), (-1.5, "positive and finite"), (math.inf, "positive and finite"),
    (x > 1, "a condition"), (my.accessory("a"), "a lag is made of"), (my.step, "a lag is made of")])
def test_a_lag_that_cannot_be_is_refused(lag, said):
    with pytest.raises(my.Error, match=said):
        my.delayed(x, lag)


@pytest.mark.parametrize("value", [my.accessory("a"), my.integer_accessory("n"), my.step, my.event_count("e")])
def test_what_has_no_past_is_refused(value):
    with pytest.raises(my.Error, match="is not kept"):
        my.delayed(value * x, tau)


@pytest.mark.parametrize("make, said", [
    (lambda: my.model({x: my.delayed(y, 1)}), "the state y .* has no equation"),
    (lambda: my.model({x: my.delayed(x, my.delayed(x, 1))}), "reads the past itself"),
    (lambda: my.model({x: -x}, history={x: 1}), "the model has no delays"),
    (lambda: my.model({x: my.delayed(x, 1)}, history={k: 1}), "'k'.* which is no state"),
    (lambda: my.model({x: my.delayed(x, 1)}, history={x: y}), "the history of x .* reads y"),
    (lambda: my.model({x: my.delayed(x, 1)}, history={x: my.delayed(x, 2)}), "the history of x .* reads delayed"),
    (lambda: my.model({x: my.delayed(x, 1)}, noise={x: 1}), "with noise has no delays yet"),
    (lambda: my.model({x: 0}, noise={x: my.delayed(x, 1)}), "with noise has no delays yet"),
    (lambda: my.model({x: my.delayed(x, 1), y: x - y}, mass_matrix={y: 0}), "mass matrix has no delays yet"),
    (lambda: my.model({x: my.delayed(x, 1)}, generate={k: my.delayed(x, 1)}), "before there is any past"),
    (lambda: my.model({x: my.delayed(x, 1)}, stops=my.stop(my.delayed(x, 1))), "stands in the time of stop"),
    (lambda: my.model({x: my.delayed(x, tau)}, events=my.event(x, do={tau: 2 * tau})), "which an action assigns")])
def test_what_a_model_with_delays_may_not_have_is_refused(make, said):
    with pytest.raises(my.Error, match=said):
        make()


@pytest.mark.parametrize("call, said", [
    (lambda: my.with_sensitivities(delaying, [my.t_begin]), "no derivatives by t_begin"),
    (lambda: my.with_sensitivities(my.model({x: -my.delayed(x, tau)}, triggers=my.trigger(x < 0, do={x: 1})), [tau]),
     "delays and triggers"),
    (lambda: my.with_sensitivities(neutral, [tau]), "derivatives of models that read slopes"),
    (lambda: my.with_tangents(neutral), "tangents of models that read slopes"),
    (lambda: my.with_tangents(my.model({x: my.delayed(x, tau), y: -y}), 2), "a model with delays has one"),
    (lambda: my.solve(bent, {tau: 1.0}, start={x: 1}, time=(0, 1), free=[tau], method="runge_kutta_4", step=0.1),
     "those of runge_kutta_4 do not"),
    (lambda: my.steady_states(delaying, {tau: 1.0}, start={x: 1}), "steady states of such models"),
    (lambda: my.attractors(delaying, {tau: 1.0}, start={x: [1, 2]}, time=(0, 1)), "attractors of such models"),
    (lambda: my.hysteresis(delaying, {tau: np.linspace(1, 2, 3)}, start={x: 1}, time=(0, 1)), "attractors of such"),
    (lambda: my.continuation(delaying, {tau: np.linspace(1, 2, 3)}, start={x: [1]}, time=(0, 1)), "attractors of such"),
    (lambda: my.batched(delaying, free=[tau], of=[x], start={x: 1}, time=(0, 1), adjoint=True),
     "derivatives of such models"),
    (lambda: delaying.derivatives(0, [1.0], tau=1.0), "their slopes by NumPy"),
    *((lambda method=method: my.solve(delaying, {tau: 1.0}, start={x: 1}, time=(0, 1), method=method),
       f"which {method} does not take") for method in ("euler_maruyama", "sra1")),
    (lambda: my.study(delaying, {tau: 1.0}, start={x: 1}, time=(0, 1), keep=[x], method="milstein"),
     "which milstein does not take"),
    (lambda: my.solve(my.model({x: -x}), start={x: 1}, time=(0, 1), history_steps=64), "history_steps is 64")])
def test_what_takes_no_delays_says_so(call, said):
    with pytest.raises(my.Error, match=said):
        call()
