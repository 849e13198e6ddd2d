# SPDX-License-Identifier: MIT
"""Models with delays: how they are recorded and written, against solutions by the method of steps, and what is
refused."""

import math
import pickle

import numpy as np
import pytest

import myriad_ode as my
from myriad_ode.models.delays import own_names

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


def test_events_on_delayed_values_and_actions_that_read_them():
    model = my.model({x: 1, y: 0}, events=[
        my.event(my.delayed(x, tau) - 0.5, name="late", direction="rising", stop_after=1)])
    lags = np.array([0.25, 1.0, 1.75])
    run = my.solve(model, {tau: lags}, start={x: 0, y: 0}, time=(0, 10), **exact)
    np.testing.assert_allclose(run["t_last"], 0.5 + lags, atol=1e-9)
    model = my.model({x: 1, y: 0}, events=my.event(x - 2, do={y: my.delayed(x, tau)}))
    run = my.solve(model, {tau: lags}, start={x: 0, y: 0}, time=(0, 3), **exact)
    np.testing.assert_allclose(run["y"], 2 - lags, atol=1e-9)


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


def test_a_ring_that_is_too_short_and_lags_that_cannot_be_are_statuses():
    model = my.model({x: -my.delayed(x, tau)})
    run = my.solve(model, {tau: [1.0, -1.0, np.nan]}, start={x: 1}, time=(0, 5), invalid="mark")
    assert list(run.status[:2]) == ["success", "invalid_delay"] and run.failed[2]
    short = my.solve(model, {tau: 1.0}, start={x: 1}, time=(0, 5), maximum_step=1 / 64, history_steps=16)
    assert list(short.status) == ["history_overflow"]
    enough = my.solve(model, {tau: 1.0}, start={x: 1}, time=(0, 5), maximum_step=1 / 64, history_steps=128)
    assert list(enough.status) == ["success"]


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


# -- Refused -----------------------------------------------------------------------------------------------------------

delaying = my.model({x: -my.delayed(x, tau)})


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
    (lambda: my.with_sensitivities(delaying, [tau]), "derivatives of such models"),
    (lambda: my.solve(delaying, {tau: 1.0}, start={x: 1}, time=(0, 1), free=[tau]), "derivatives of such models"),
    (lambda: my.with_tangents(delaying), "tangents of such models"),
    (lambda: my.steady_states(delaying, {tau: 1.0}, start={x: 1}), "steady states of such models"),
    (lambda: my.attractors(delaying, {tau: 1.0}, start={x: [1, 2]}, time=(0, 1)), "attractors of such models"),
    (lambda: my.hysteresis(delaying, {tau: np.linspace(1, 2, 3)}, start={x: 1}, time=(0, 1)), "attractors of such"),
    (lambda: my.continuation(delaying, {tau: np.linspace(1, 2, 3)}, start={x: [1]}, time=(0, 1)), "attractors of such"),
    (lambda: my.fit(delaying, {"t": [1.0], x: [1.0]}, free={tau: (0.5, 2)}, start={x: 1}), "fits of such models"),
    (lambda: my.batched(delaying, free=[tau], of=[x], start={x: 1}, time=(0, 1), adjoint=True),
     "derivatives of such models"),
    (lambda: delaying.derivatives(0, [1.0], tau=1.0), "their slopes by NumPy"),
    *((lambda method=method: my.solve(delaying, {tau: 1.0}, start={x: 1}, time=(0, 1), method=method),
       f"which {method} does not take") for method in ("euler_maruyama", "sra1")),
    (lambda: my.study(delaying, {tau: 1.0}, start={x: 1}, time=(0, 1), keep=[x], method="milstein"),
     "which milstein does not take"),
    (lambda: my.solve(delaying, {tau: 1.0}, start={x: 1}, time=(0, 1), interpreted=True), "cannot be interpreted"),
    (lambda: my.solve(my.model({x: -x}), start={x: 1}, time=(0, 1), history_steps=64), "history_steps is 64")])
def test_what_takes_no_delays_says_so(call, said):
    with pytest.raises(my.Error, match=said):
        call()
