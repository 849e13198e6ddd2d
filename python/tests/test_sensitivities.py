# SPDX-License-Identifier: MIT
"""Sensitivities of compiled models, compared with closed forms; the C++ library's tests have events and phases."""

import numpy as np
import pytest
from conftest import OSCILLATOR

import myriad_ode as my

x, v = my.states("x v")
k = my.parameter("k")
B = my.shared("B")
spring = my.model({x: v, v: B - k * x}, name="spring")
tight = {"rtol": 1e-10, "atol": 1e-10}
K = np.array([1.0, 2.0, 3.0])


def position(k, x0, B, t):
    return (x0 - B / k) * np.cos(np.sqrt(k) * t) + B / k


def by_differences(f, at, d=1e-4):
    """Central differences of fourth order, whose error is d^4 and rounding over d."""
    return (8 * (f(at + d) - f(at - d)) - (f(at + 2 * d) - f(at - 2 * d))) / (12 * d)


def test_sensitivities_of_a_spring_are_those_of_its_closed_form():
    run = my.solve(spring, {k: K, B: 0.5}, start={x: 1, v: 0}, time=(0, 2), samples=[0.5, 1, 2], record=[x],
                   free=[k, x, B], **tight)
    t = np.array([0.5, 1, 2])
    expected = np.stack([by_differences(lambda k: position(k, 1, 0.5, t), K[:, None]),
                         np.cos(np.sqrt(K[:, None]) * t), (1 - np.cos(np.sqrt(K[:, None]) * t)) / K[:, None]], axis=-1)
    assert run.sensitivity.free == ["k", "x", "B"]
    assert list(run.sensitivity) == ["x", "v"]
    np.testing.assert_allclose(run.sensitivity["x_sample"], expected, rtol=1e-7, atol=1e-9)
    np.testing.assert_array_equal(run.sensitivity[x], run.sensitivity["x_sample"][:, -1:])  # at the recorded phase
    np.testing.assert_array_equal(run.sensitivity["x_end"], run.sensitivity["x_sample"][:, -1])
    np.testing.assert_array_equal(run.sensitivity["x", k], run.sensitivity[x][..., 0])
    np.testing.assert_allclose(run.records["x_by_k"][:, 0], expected[:, -1, 0], rtol=1e-7, atol=1e-9)
    np.testing.assert_array_equal(run.states["x_by_k"], run.records["x_by_k"][:, 0])
    np.testing.assert_array_equal(run.sensitivity[my.time], np.zeros((3, 3)))


def test_without_error_control_the_solution_is_that_without_sensitivities():
    call = {"start": {x: 1, v: 0}, "time": (0, 2), "step": 1e-3, "rtol": [1e-6, 1e-7], "atol": {v: 1e-5}}
    alone = my.solve(spring, {k: K, B: 0.5}, **call)
    run = my.solve(spring, {k: K, B: 0.5}, free=[k], sensitivity_control=False, **call)
    np.testing.assert_array_equal(run[x], alone[x])
    assert (my.solve(spring, {k: K, B: 0.5}, free=[k], **call)[x] != alone[x]).any()


def test_sensitivities_may_have_tolerances_of_their_own():
    call = {"start": {x: 1, v: 0}, "time": (0, 2), "free": [k, x, B]}
    loose = my.solve(spring, {k: K, B: 0.5}, atol={v: 1e-8}, **call)
    strict = my.solve(spring, {k: K, B: 0.5}, atol={v: 1e-8, "x_by_k": 1e-13}, rtol={"x_by_k": 1e-13}, **call)
    assert (strict.accepted_steps > loose.accepted_steps).all()
    alone = my.solve(spring, {k: K[1], B: 0.5}, atol={v: 1e-8}, **call)
    np.testing.assert_array_equal(alone.sensitivity[x][0], loose.sensitivity[x][1])  # whatever else is in the call
    with pytest.raises(my.Error, match="'x_by_z' is no state"):
        my.solve(spring, {k: K, B: 0.5}, atol={"x_by_z": 1e-8}, **call)


def test_an_event_that_ends_a_phase_has_the_sensitivity_of_its_time():
    # A ball thrown up lands at T = (v0 + sqrt(v0^2 + 2 g x0)) / g with speed sqrt(v0^2 + 2 g x0).
    g, lands = my.parameter("g"), my.accessory("landed")
    ball = my.model({x: v, v: -g}, accessories={lands: 0},
                    events=my.event(x, direction="falling", do={lands: my.time, my.end_phase: True}), name="ball")
    G = np.array([1.0, 9.81])
    run = my.solve(ball, {g: G}, start={x: 2, v: 0.5}, time=(0, 100), free=[g, x], **tight)
    landing = lambda g, x0: (0.5 + np.sqrt(0.25 + 2 * g * x0)) / g  # noqa: E731
    np.testing.assert_allclose(run.t_last, landing(G, 2), rtol=1e-9)
    expected = [by_differences(lambda g: landing(g, 2), G), by_differences(lambda x0: landing(G, x0), 2.0)]
    np.testing.assert_allclose(run.sensitivity[my.time], np.stack(expected, axis=-1), rtol=1e-7)
    np.testing.assert_allclose(run.sensitivity[lands], np.stack(expected, axis=-1), rtol=1e-7)
    speed = lambda g: -np.sqrt(0.25 + 4 * g)  # noqa: E731
    np.testing.assert_allclose(run.sensitivity[v, g], by_differences(speed, G), rtol=1e-7)
    np.testing.assert_allclose(run.sensitivity[x, g], 0, atol=1e-9)


def test_a_model_in_cpp_has_sensitivities():
    model = my.CppModel(OSCILLATOR, "oscillator", "x v", "w")
    w = np.array([1.0, 2.0])
    run = my.solve(model, {"w": w}, start={"x": 1, "v": 0}, time=(0, 1), free="w", **tight)
    np.testing.assert_allclose(run.sensitivity["x", "w"], -np.sin(w), rtol=1e-7)


def test_a_derivative_that_does_not_exist_is_nan_and_noted():
    # A function that jumps has no slope by which its time would depend on c.
    c, seen = my.parameter("c"), my.accessory("seen")
    model = my.model({x: -k * x}, accessories={seen: 0}, parameters=[c],
                     events=my.event(my.where(my.time < c, -1.0, 1.0), do={seen: my.time}), name="jumping")
    run = my.solve(model, {k: 1, c: 1}, start={x: 1}, time=(0, 2), free=[c, k])
    assert run[seen][0] == pytest.approx(1)
    assert np.isnan(run.sensitivity[seen, c][0])
    np.testing.assert_allclose(run.sensitivity[x, k], -2 * np.exp(-2), rtol=1e-6)
    assert any("a derivative does not exist" in note for note in run.report.notes)


@pytest.mark.parametrize("by, message", [
    (["z"], "'z' is no component that sensitivities can be by"),
    ([], "no component is named"),
    ([k, "k"], "'k' is there twice"),
])
def test_wrong_components_are_refused(by, message):
    with pytest.raises(my.Error, match=message):
        my.solve(spring, {k: K, B: 0.5}, start={x: 1, v: 0}, time=(0, 2), free=by)


def test_a_model_that_assigns_parameters_is_refused():
    model = my.model({x: -k * x}, finalise={k: 2 * k})
    with pytest.raises(my.Error, match="the hooks of the model assign parameters"):
        my.with_sensitivities(model, [k])


def test_runs_without_sensitivities_say_how_to_get_them():
    run = my.solve(spring, {k: K, B: 0.5}, start={x: 1, v: 0}, time=(0, 2), interpreted=True)
    with pytest.raises(my.Error, match="give free= to solve"):
        run.sensitivity  # noqa: B018


def reactions():
    a, b, c = my.states("a b c")
    k1, k2, k3 = my.parameters("k1 k2 k3")
    return my.model({a: -k1 * a + k3 * b * c, b: k1 * a - k3 * b * c - k2 * b * b, c: k2 * b * b}, name="robertson")


def oscillators():
    y, w, pull = my.states("y1 y2 y3"), my.parameter("w"), my.shared("pull")
    slopes = {y[i]: w * (i + 1) + pull * sum(my.sin(y[j] - y[i]) for j in range(3)) for i in range(3)}
    return my.model(slopes, name="oscillators")


@pytest.mark.parametrize("model, given, start, free, more", [
    (spring, {k: K, B: 0.5}, {x: 1, v: 0}, [k, x, B], dict(samples=[0.5, 1, 2], record=[x])),
    (spring, {k: K, B: 0.5}, {x: 1, v: 0}, [k], dict(sensitivity_control=False, phases=3, carry_on=True,
                                                    phase_length=0.5)),
    (reactions(), {"k1": [0.03, 0.05], "k2": 3e7, "k3": 1e4}, {"a": 1, "b": 0, "c": 0}, ["k1", "a"],
     dict(method="rodas_5p", atol=1e-12)),
    (oscillators(), {"w": [0.5, 1.0], "pull": 0.3}, [0.1, 0.2, 0.5], ["pull", "w"], {}),
])
def test_interpreted_sensitivities_are_those_that_are_compiled(model, given, start, free, more):
    start = start if isinstance(start, dict) else dict(zip(model.states, start))
    call = dict(start=start, time=(0, 2), free=free, rtol=1e-9, atol=1e-11) | more
    compiled = my.solve(model, given, interpreted=False, device="cpu", **call)
    run = my.solve(model, given, interpreted=True, device="cpu", **call)
    assert set(run) == set(compiled)
    for name in run.sensitivity:
        np.testing.assert_allclose(run.sensitivity[name], compiled.sensitivity[name], rtol=1e-8, atol=1e-13)
    np.testing.assert_array_equal(run.accepted_steps, compiled.accepted_steps)
    np.testing.assert_array_equal(run.sensitivity[my.time], compiled.sensitivity[my.time])


def test_a_fit_needs_no_compiler():
    times = np.linspace(0, 3, 13)
    found = my.fit(my.model({x: -k * x}, name="decay"), {"t": times, x: 2.5 * np.exp(-0.7 * times)},
                   free={k: (0.1, 10), x: (0.1, 10)}, starts=4, interpreted=True, rtol=1e-9)
    assert [found.best["k"], found.best["x"]] == pytest.approx([0.7, 2.5], rel=1e-6)


def test_sensitivities_through_events_are_refused_by_the_interpreter():
    bouncing = my.model({x: v, v: -k}, events=[my.event(x, do={v: -v})], name="bouncing")
    with pytest.raises(my.Error, match="it has sensitivities, and events, .* or accessories: install"):
        my.solve(bouncing, {k: 1.0}, start={x: 1, v: 0}, time=(0, 1), free=[k], interpreted=True)


@pytest.mark.long
def test_stiff_methods_have_the_sensitivities_of_robertsons_reactions():
    a, b, c = my.states("a b c")
    rates = my.parameters("k1 k2 k3")
    k1, k2, k3 = rates
    robertson = my.model({a: -k1 * a + k3 * b * c, b: k1 * a - k3 * b * c - k2 * b * b, c: k2 * b * b},
                         name="robertson")
    at = {k1: 0.04, k2: 3e7, k3: 1e4}
    call = dict(start={a: 1, b: 0, c: 0}, time=(0, 40), method="rodas_5p", rtol=1e-10, atol=1e-14)
    run = my.solve(robertson, at, free=rates, **call)
    near = {k: np.array([-2, -1, 1, 2]) * 1e-4 * at[k] for k in rates}
    for k in rates:
        values = my.solve(robertson, {**at, k: at[k] + near[k]}, **call)
        for state in (a, b, c):
            f = values[state]
            expected = (8 * (f[2] - f[1]) - (f[3] - f[0])) / (12 * near[k][2])
            np.testing.assert_allclose(run.sensitivity[state, k], expected, rtol=5e-6)


def test_an_output_by_a_parameter_that_it_has_as_a_factor_has_its_derivatives_at_samples():
    # As many instances as samples, which must not be taken for each other.
    pytest.importorskip("libsbml")
    import sbml_models as sbml

    model = my.read_sbml(sbml.document([
        sbml.compartment("c"), sbml.species("A", concentration=2.0), sbml.species("C", concentration=1.0),
        sbml.parameter("k", 0.5), sbml.parameter("scale", 3.0), sbml.variable("seen"), sbml.variable("both"),
        sbml.always("seen", "scale * A"), sbml.always("both", "scale * A * C"),
        sbml.reaction("loss", "A ->", "k * A * c"), sbml.reaction("other", "C ->", "0.1 * C * c")]))
    rates, scales, times = np.array([0.5, 0.7, 1.0]), np.array([3.0, 4.0, 5.0]), np.array([0.5, 1.0, 2.0])
    sweep = {"k": rates, "scale": scales}
    call = {"time": (0, 2), "free": ["k", "scale"], **tight}
    run = my.solve(model, sweep, samples=times, **call)
    decay = np.exp(-rates[:, None] * times)
    np.testing.assert_allclose(run.sensitivity["seen", "scale"], 2 * decay, rtol=1e-8)
    np.testing.assert_allclose(run.sensitivity["seen", "k"], -2 * scales[:, None] * times * decay, rtol=1e-8)
    both = my.solve(model, sweep, samples={"times": times, "states": ["A"]}, **call)  # C at the end alone
    np.testing.assert_allclose(both.sensitivity["both", "k"], -4 * scales * np.exp(-2 * rates - 0.2), rtol=1e-8)


def test_initial_values_that_follow_from_a_parameter_have_its_derivative():
    pytest.importorskip("libsbml")
    import sbml_models as sbml

    model = my.read_sbml(sbml.document([
        sbml.compartment("c"), sbml.species("A", concentration=1.0), sbml.species("C", concentration=1.0),
        sbml.parameter("k", 0.5), sbml.parameter("b", 9.0), sbml.initially("A", "k^2 + C"),
        sbml.initially("C", "3 * k"), sbml.initially("b", "k / 2"), sbml.reaction("loss", "A ->", "k * A * c"),
        sbml.reaction("other", "C ->", "b * C * c")]))
    call = {"time": (0, 2), "free": ["k"], **tight}
    rates = np.array([0.5, 0.7])
    run = my.solve(model, {"k": rates, "b": 0.1}, **call)
    decay = np.exp(-2 * rates)
    np.testing.assert_allclose(run.sensitivity["A", "k"], (2 * rates + 3 - 2 * (rates**2 + 3 * rates)) * decay,
                               rtol=1e-8)
    np.testing.assert_allclose(run.sensitivity["C", "k"], 3 * np.exp(-0.2), rtol=1e-8)
    given = my.solve(model, {"k": rates, "b": 0.1}, start={"C": 1.0}, **call)  # then A begins at k^2 + 1
    np.testing.assert_allclose(given.sensitivity["A", "k"], (2 * rates - 2 * (rates**2 + 1)) * decay, rtol=1e-8)
    with pytest.raises(my.Error, match="the value of 'b' follows from components that sensitivities are by"):
        my.solve(model, {"k": rates}, **call)


def test_an_event_in_place_of_a_jump_by_the_state_has_what_the_jump_leaves_out_and_a_note_says_so():
    """z falls by 2 above c and by 1 below it, as a jump and as an event."""
    z, w, q = my.states("z w q")
    c, n = my.parameters("c n")
    above = my.accessory("above")
    model = my.model({z: my.where(z > c, -2.0, -1.0), w: my.where(above > 0, -2.0, -1.0), q: (z - z + my.time)**n},
                     accessories={above: 1.0}, events=my.event(w - c, do={above: 1 - above}))
    run = my.solve(model, {c: 0.5, n: [1.0, 2.0]}, start={z: 1, w: 1, q: 0}, time=(0, 1), free=[c, n],
                   rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(run.sensitivity[w, c], 0.5, rtol=1e-6)
    assert (run.sensitivity[z, c] == 0).all()
    assert [note for note in run.report.notes if "the equations jump where `z > c` changes" in note]
    # of the integral of t^n, though t = 0 has no logarithm
    np.testing.assert_allclose(run.sensitivity[q, n], [-1 / 4, -1 / 9], rtol=1e-6)
