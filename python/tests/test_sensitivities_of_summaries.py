# SPDX-License-Identifier: MIT
"""Derivatives of integrals and extrema over a phase, by the ends of the time domain and by thresholds, compared with
closed forms."""

import numpy as np
import pytest

import myriad_ode as my

x, v = my.states("x v")
k, r, g = my.parameters("k r g")
tight = {"rtol": 1e-11, "atol": 1e-11}
peak, dip, when, area, level = (my.accessory(name) for name in ("peak", "dip", "when", "area", "level"))


def by_differences(f, at, d=1e-3):
    """Central differences of fourth order, relative to each component."""
    found = []
    for i in range(len(at)):
        step = np.zeros(len(at))
        step[i] = d * abs(at[i])
        found.append((8 * (f(*(at + step)) - f(*(at - step))) - (f(*(at + 2 * step)) - f(*(at - 2 * step))))
                     / (12 * step[i]))
    return np.stack(found, axis=-1)


@pytest.mark.parametrize("method", ["tsitouras_5", pytest.param("rodas_5p", marks=pytest.mark.long)])
def test_extrema_and_integrals_of_smooth_solutions_have_derivatives(method):
    # x = x0 cos(w t) + v0 / w sin(w t), w = sqrt(k): the largest value inside, the smallest at the end.
    spring = my.model({x: v, v: -k * x}, accessories={
        peak: my.phase_maximum(k * x), when: my.time_of_maximum(k * x), dip: my.phase_minimum(x),
        area: my.integral(x * x + my.time)}, name="spring_summaries")
    at, end = np.array([2.0, 1.0, 0.5]), 1.2  # k, x0, v0
    run = my.solve(spring, {k: at[0]}, start={x: at[1], v: at[2]}, time=(0, end), method=method,
                   free=[k, x, v], **tight)
    t, weight = np.polynomial.legendre.leggauss(40)
    t, weight = end * (t + 1) / 2, end * weight / 2

    def position(t, k, x0, v0):
        return x0 * np.cos(np.sqrt(k) * t) + v0 / np.sqrt(k) * np.sin(np.sqrt(k) * t)

    expected = {peak: lambda k, x0, v0: k * np.sqrt(x0**2 + v0**2 / k), dip: lambda *at: position(end, *at),
                area: lambda *at: weight @ (position(t, *at)**2 + t)}
    for accessory, f in expected.items():
        np.testing.assert_allclose(run[accessory], f(*at), rtol=1e-8)
        np.testing.assert_allclose(run.sensitivity[accessory][0], by_differences(f, at), rtol=1e-7, atol=1e-9)
    assert np.isnan(run.sensitivity[when]).all()


# A ball that falls from x and bounces with the restitution r.
bounce = my.event(x, direction="falling", do={v: -r * v}, name="bounce")
summaries = {peak: my.phase_maximum(v), dip: my.phase_minimum(v), level: my.phase_minimum(x), area: my.integral(x)}


def test_extrema_and_integrals_that_events_cut_have_derivatives():
    ball = my.model({x: v, v: -g}, accessories={**summaries, when: my.integral(v)}, events=bounce, name="ball_sums")
    at, end = np.array([0.8, 9.81, 1.0]), 0.9  # r, g, x0; up in the second flight
    run = my.solve(ball, {r: at[0], g: at[1]}, start={x: at[2], v: 0}, time=(0, end), free=[r, g, x], **tight)

    def first(g, x0):
        return np.sqrt(2 * x0 / g)

    def whole(r, g, x0):
        t1, v1 = first(g, x0), r * np.sqrt(2 * g * x0)
        t = end - t1
        return x0 * t1 - g * t1**3 / 6 + v1 * t**2 / 2 - g * t**3 / 6

    def height(r, g, x0):
        t = end - first(g, x0)
        return r * np.sqrt(2 * g * x0) * t - g * t**2 / 2 - x0

    expected = {peak: lambda r, g, x0: r * np.sqrt(2 * g * x0), dip: lambda r, g, x0: -np.sqrt(2 * g * x0),
                area: whole, when: height}
    for accessory, f in expected.items():
        np.testing.assert_allclose(run[accessory], f(*at), rtol=1e-8)
        np.testing.assert_allclose(run.sensitivity[accessory][0], by_differences(f, at), rtol=1e-7, atol=1e-8)
    np.testing.assert_allclose(run.sensitivity[level][0], 0, atol=1e-8)  # at the ground, whenever that is
    alone = my.solve(ball, {r: at[0], g: at[1]}, start={x: at[2], v: 0}, time=(0, end), **tight)
    for accessory in expected:
        np.testing.assert_allclose(run[accessory], alone[accessory], rtol=1e-9)


@pytest.mark.long
def test_summaries_of_phases_that_events_begin_and_end_have_derivatives():
    ball = my.model({x: v, v: -g}, accessories={**summaries, when: my.phase_maximum(x)},
                    events=my.event(x, direction="falling", do={v: -r * v, my.end_phase: True}), name="ball_phases")
    at = np.array([0.8, 9.81, 1.0])
    run = my.solve(ball, {r: at[0], g: at[1]}, start={x: at[2], v: 0}, time=(0, 10), phases=2, carry_on=True,
                   record=dict(accessories=[peak, dip, level, area, when]), free=[r, g, x], **tight)

    def speed(r, g, x0):
        return r * np.sqrt(2 * g * x0)

    falls = {peak: lambda r, g, x0: 0 * x0, dip: lambda r, g, x0: -np.sqrt(2 * g * x0), when: lambda r, g, x0: x0,
             level: lambda r, g, x0: 0 * x0, area: lambda r, g, x0: 2 / 3 * x0 * np.sqrt(2 * x0 / g)}
    flies = {peak: speed, dip: lambda *at: -speed(*at), level: lambda r, g, x0: 0 * x0,
             area: lambda r, g, x0: 2 / 3 * speed(r, g, x0)**3 / g**2, when: lambda r, g, x0: r**2 * x0}
    for phase, expected in enumerate((falls, flies)):
        for accessory, f in expected.items():
            np.testing.assert_allclose(run.sensitivity[accessory][0, phase], by_differences(f, at), rtol=1e-7,
                                       atol=1e-8, err_msg=f"{accessory} in phase {phase}")


def test_a_threshold_is_a_parameter_of_an_event():
    # x = x0 exp(-k t) passes c at log(x0 / c) / k, after which it is made up to a: v, whose slope is x, has a corner.
    c = my.parameter("c")
    model = my.model({x: -k * x, v: x}, events=my.event(x - c, direction="falling", do={x: x + r}), name="threshold")
    at, end = np.array([0.5, 0.6, 2.0, 1.5]), 2.0  # k, c, x0, r

    def after(k, c, x0, r):
        t = np.log(x0 / c) / k
        left = end - t
        return np.array([(c + r) * np.exp(-k * left), (x0 - c) / k + (c + r) * (1 - np.exp(-k * left)) / k])

    end = 3.0
    run = my.solve(model, {k: at[0], c: at[1], r: at[3]}, start={x: at[2], v: 0}, time=(0, end),
                   free=[k, c, x, r], **tight)
    np.testing.assert_allclose([run[x][0], run[v][0]], after(*at), rtol=1e-9)
    np.testing.assert_allclose([run.sensitivity[x][0], run.sensitivity[v][0]], by_differences(after, at), rtol=1e-7)


def test_a_phase_that_a_stop_ends_has_the_derivative_of_its_time():
    model = my.model({x: -k * x}, stops=my.stop(r, do={my.end_phase: True}), name="stopped")
    run = my.solve(model, {k: 0.5, r: 1.5}, start={x: 2}, time=(0, 10), free=[k, r], **tight)
    assert run.t_last[0] == pytest.approx(1.5)
    np.testing.assert_allclose(run.sensitivity[my.time][0], [0, 1], atol=1e-12)
    value = 2 * np.exp(-0.75)
    np.testing.assert_allclose(run.sensitivity[x][0], [-1.5 * value, -0.5 * value], rtol=1e-8)


@pytest.mark.parametrize("method", ["tsitouras_5", pytest.param("rodas_5p", marks=pytest.mark.long)])
def test_the_ends_of_the_time_domain_have_derivatives_through_an_event(method):
    # x' = cos(t), which at c falls to r x + t / 10; v' = x.
    c = my.parameter("c")
    model = my.model({x: my.cos(my.time), v: x}, accessories={when: 0, area: my.integral(my.time * x)}, events=my.event(
        x - c, direction="rising", do={x: r * x + my.time / 10, when: my.time}), name="domain")
    at, call = np.array([0.3, 2.2]), {"start": {x: 0.5, v: 0.1}, "method": method, "rtol": 1e-10, "atol": 1e-10}
    run = my.solve(model, {c: 1.0, r: 0.2}, time=tuple(at), free=[my.t_begin, c, my.t_end], **call)

    def closed(begin, end, kind):
        up = np.arcsin(0.5 + np.sin(begin))  # where x is 1
        after = lambda t: 0.2 + up / 10 + np.sin(t) - np.sin(up)  # noqa: E731
        if kind is x:
            return after(end)
        if kind is when:
            return up
        t, weight = np.polynomial.legendre.leggauss(30)
        total = 0.1 if kind is v else 0.0
        for low, high, f in ((begin, up, lambda t: 0.5 + np.sin(t) - np.sin(begin)), (up, end, after)):
            s = (low + high + t * (high - low)) / 2
            total += (high - low) / 2 * (weight @ (f(s) * (1 if kind is v else s)))
        return total

    for kind in (x, v, when, area):
        np.testing.assert_allclose(run[kind][0], closed(*at, kind), rtol=1e-8)
        expected = by_differences(lambda begin, end, kind=kind: closed(begin, end, kind), at)
        found = [run.sensitivity[kind, my.t_begin][0], run.sensitivity[kind, "t_end"][0]]
        np.testing.assert_allclose(found, expected, rtol=1e-7, atol=1e-9)
    assert run.sensitivity.free == ["t_begin", "c", "t_end"]
    np.testing.assert_array_equal(run.sensitivity[my.time], [[0, 0, 1]])
    if method == "tsitouras_5":  # and against differences of the numerical solution
        d = 2e-3
        near = [-2 * d, -d, d, 2 * d]
        for of, times in ((my.t_begin, (at[0] + near, at[1])), (my.t_end, (at[0], at[1] + near))):
            f = my.solve(model, {c: 1.0, r: 0.2}, time=times, **{**call, "rtol": 1e-13, "atol": 1e-13})
            for kind in (x, v):
                far, back, ahead, further = f[kind]
                expected = (8 * (ahead - back) - (further - far)) / 12 / d
                np.testing.assert_allclose(run.sensitivity[kind, of][0], expected, rtol=1e-7)


def test_initial_values_that_follow_from_the_begin_have_its_derivative():
    pytest.importorskip("libsbml")
    import sbml_models as sbml

    model = my.read_sbml(sbml.document([
        sbml.compartment("c"), sbml.species("A", concentration=1.0), sbml.parameter("k", 0.5),
        sbml.initially("A", "k * (1 + time^2)"), sbml.reaction("loss", "A ->", "k * A * c")]))
    run = my.solve(model, {"k": 0.5}, time=(0.5, 2), free=[my.t_begin, "k"], **tight)
    decay = np.exp(-0.75)
    np.testing.assert_allclose(run.sensitivity["A"][0], [0.5 * decay * (1 + 0.5 * 1.25), 1.25 * decay * (1 - 0.75)],
                               rtol=1e-8)


def test_outputs_that_read_the_time_move_with_the_end_of_recorded_phases():
    pytest.importorskip("libsbml")
    import sbml_models as sbml

    model = my.read_sbml(sbml.document([sbml.variable("x", 1), sbml.parameter("k", 0.5), sbml.rate("x", "-k * x"),
                                        sbml.variable("r"), sbml.always("r", "x * time")]))
    call = {"time": (0, 2), "free": [my.t_end, "k"], **tight}
    expected = np.exp(-1) * np.array([1 - 0.5 * 2, -2 * 2])  # of x t = t exp(-k t)
    np.testing.assert_allclose(my.solve(model, **call).sensitivity["r"][0], expected, rtol=1e-8, atol=1e-9)
    run = my.solve(model, record={"states": ["x"], "time": True}, **call)
    np.testing.assert_allclose(run.sensitivity["r"][0, 0], expected, rtol=1e-8, atol=1e-9)


@pytest.mark.parametrize("by, message", [
    (my.time, "is no component of a model"),
    (my.step, "is no component of a model"),
    ("t_beginn", "'t_beginn' is no component that sensitivities can be by: did you mean 't_begin'?"),
    ([my.t_end, "t_end"], "'t_end' is there twice"),
])
def test_other_times_are_refused(by, message):
    with pytest.raises(my.Error, match=message):
        my.solve(my.model({x: -k * x}), {k: 1}, start={x: 1}, time=(0, 1), free=by)


def test_a_component_with_the_name_of_an_end_is_refused():
    begin = my.parameter("t_begin")
    with pytest.raises(my.Error, match="the model has a component 't_begin'.*rename it"):
        my.solve(my.model({x: -begin * x}), {begin: 1}, start={x: 1}, time=(0, 1), free=[my.t_begin])
