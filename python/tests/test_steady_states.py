# SPDX-License-Identifier: MIT
"""Steady states, hysteresis and continuation against closed forms."""

import numpy as np
import pytest

import myriad_ode as my

x, y, z = my.states("x y z")
a, b = my.parameters("a b")
cusp = my.model({x: a + x - x**3}, name="cusp")
fold = 2 / (3 * np.sqrt(3))  # where two of its three steady states meet


@pytest.mark.parametrize("matrix, kind", [
    ([[-1, 0], [0, -3]], "stable node"), ([[-1, 2], [-2, -1]], "stable focus"), ([[1, 0], [3, 2]], "unstable node"),
    ([[1, 5], [-5, 1]], "unstable focus"), ([[1, 2], [2, -1]], "saddle"), ([[0, 2], [-2, 0]], "centre"),
    ([[0, 1], [0, -1]], "non-hyperbolic"), ([[-1, 3, 0], [-3, -1, 0], [0, 0, 2]], "saddle-focus"),
    ([[-1, 3, 0], [-3, -1, 0], [0, 0, -0.5]], "stable node"), ([[-1, 3, 0], [-3, -1, 0], [0, 0, -2]], "stable focus"),
])
def test_linear_systems_have_the_eigenvalues_of_their_matrix(matrix, kind):
    matrix = np.array(matrix, float)
    states = (x, y, z)[:len(matrix)]
    model = my.model({s: sum(m * q for m, q in zip(row, states)) + 0 * x for s, row in zip(states, matrix)})
    found = my.steady_states(model, start={s: 1.5 for s in states})
    assert len(found) == 1 and found[0].kind == kind and found[0].is_stable == kind.startswith("stable")
    np.testing.assert_allclose(found[0].jacobian, matrix)
    wanted = np.linalg.eigvals(matrix)
    np.testing.assert_allclose(np.sort_complex(found[0].eigenvalues), np.sort_complex(wanted), atol=1e-12)
    assert (np.diff(found[0].eigenvalues.real) <= 1e-12).all()


def test_lorenz_has_three_steady_states():
    """At rho = 28 a saddle and two saddle-foci (Sparrow, The Lorenz Equations, 1982): x^2 = y^2 = beta (rho - 1)."""
    lorenz = my.model({x: 10 * (y - x), y: x * (a - z) - y, z: x * y - 8 / 3 * z})
    found = my.steady_states(lorenz, {a: 28}, start=my.grid({s: np.linspace(-20, 30, 5) for s in (x, y, z)}))
    assert [one.kind for one in found] == ["saddle-focus", "saddle", "saddle-focus"]
    np.testing.assert_allclose([one.state["x"] for one in found], [-np.sqrt(72), 0, np.sqrt(72)], atol=1e-9)
    np.testing.assert_allclose([one.state["z"] for one in found], [27, 0, 27], atol=1e-9)
    root = np.sqrt(121 + 4 * 10 * 27)
    np.testing.assert_allclose(found[1].eigenvalues, [(-11 + root) / 2, -8 / 3, (-11 - root) / 2])


def test_steady_states_of_functions_without_a_rule_are_found_by_differences():
    levels = np.linspace(-3, 3, 61)
    model = my.model({x: my.interpolate(x, levels, np.tanh(2 * levels), kind="cubic") - x})
    found = my.steady_states(model, start={x: np.linspace(-2, 2, 9)})
    assert [one.kind for one in found] == ["stable node", "unstable node", "stable node"]
    assert found[1].eigenvalues[0] == pytest.approx(1, abs=1e-3)  # 2 - 1


@pytest.mark.parametrize("size", [1e-15, 1.0, 1e8])
def test_steady_states_are_found_in_any_unit(size):
    found = my.steady_states(my.model({x: x - x**3 / size**2}), start={x: size * np.array([-2, -0.5, 0.01, 0.5, 2])})
    assert [one.kind for one in found] == ["stable node", "unstable node", "stable node"]
    np.testing.assert_allclose([one.state["x"] / size for one in found], [-1, 0, 1], atol=1e-9)
    spring = my.model({x: size * y, y: x / size - (x / size)**3 - y})  # with starts that do not tell the scale of y
    assert len(my.steady_states(spring, start={x: size * np.array([-2, -0.5, 0.01, 0.5, 2]), y: 0})) == 3
    assert f"x = {size:.6g}; eigenvalues -2" in repr(found[2]) and "x = 0;" in repr(found[1])


@pytest.mark.parametrize("slope", [x**2, -x**3, x**2 - 2 * x + 1, (x - 3)**2 * (x + 1)])
def test_multiple_roots_have_no_stability_by_eigenvalues(slope):
    found = my.steady_states(my.model({x: slope}), start={x: [0.5, 4.0]}, iterations=100)
    assert {one.kind for one in found} == {"non-hyperbolic"}


@pytest.mark.parametrize("model, sweep, message", [
    (my.model({x: my.cos(my.time) - x}), {}, "depend on time"),
    (my.model({x: x**2 + 1}), {}, "no start leads to a steady state"),
    (cusp, {}, "the value of 'a' is missing"),
    (cusp, {a: [1, 2]}, "2 values of a: give one"),
    (cusp, {a: 1, "q": 1}, "'q' is no parameter of the model"),
    (cusp, {a: "much"}, "'a' is 'much': give a number"),
    (my.model({x: -x, y: x - y}, mass_matrix={y: 0}), {}, "has a mass matrix"),
    (my.model({x: my.accessory("c") - x}, accessories={my.accessory("c"): 1}), {}, "depend on the accessory c"),
])
def test_models_without_steady_states_are_refused(model, sweep, message):
    with pytest.raises(my.Error, match=message):
        my.steady_states(model, sweep, start={x: 1.0, **({y: 1.0} if "y" in model.states else {})})


def test_states_carried_up_and_down_jump_at_the_folds():
    values = np.linspace(-1, 1, 81)
    result = my.hysteresis(cusp, {a: values}, start={x: [-2.0, 2.0]}, time=(0, 1), transient=150, phases=8,
                           interpreted=True)
    assert result["up", x].shape[:2] == (81, 2)
    low, high = result.interval()
    step = values[1] - values[0]
    assert high < fold < high + step and low - step < -fold < low
    # on the lower branch until the fold, and at a steady state everywhere
    up = result["up", x][:, :, -1]
    assert (up[values < fold - step] < 0).all() and (up[values > fold + step] > 0).all()
    np.testing.assert_allclose(values[:, None] + up - up**3, 0, atol=1e-6)
    down = result["down", x][:, 0, -1]
    assert (down[values > -fold + step] > 0).all() and (down[values < -fold - step] < 0).all()
    assert "up and down a from -1 to 1" in repr(result)


def test_one_direction_begins_at_its_own_end():
    down = my.hysteresis(cusp, {a: np.linspace(-0.2, 0.2, 5)}, start={x: -2.0}, time=(0, 1), transient=60, phases=4,
                         carry="down", interpreted=True)
    assert list(down.branches) == ["down"] and (down["down", x] < 0).all()
    assert down.values.tolist() == sorted(down.values)
    with pytest.raises(my.Error, match="one direction alone"):
        down.interval()
    with pytest.raises(KeyError, match="no way 'up'"):
        down["up", x]


def test_steady_states_of_parameters_that_are_not_finite_are_refused():
    for value in (np.nan, np.inf):
        with pytest.raises(my.Error, match=f"'a' is {value}: give a finite number"):
            my.steady_states(cusp, {a: value}, start={x: 1.0})


def test_orbits_that_fail_are_nan_from_there_on():
    result = my.hysteresis(my.model({x: a + x**2}), {a: [-1.0, -0.5, 0.5]}, start={x: -2.0}, time=(0, 1), transient=40,
                           phases=4, interpreted=True)
    assert np.isfinite(result["up", x][:2]).all() and np.isnan(result["up", x][2]).all()
    assert np.isnan(result["down", x]).all()
    lost = my.hysteresis(my.model({x: a + x**2}), {a: [1.0, 2.0]}, start={x: 0.0}, time=(0, 1), transient=40, phases=4,
                         interpreted=True)
    assert np.isnan(lost.interval()).all()
    with pytest.raises(my.Error, match="no points of y: there are those of x"):
        lost["up", y]
    with pytest.raises(my.Error, match=r'give direction and state, as in result\["up", x\]'):
        lost[x]


def test_pictures_and_datasets_of_hysteresis():
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    result = my.hysteresis(cusp, {a: np.linspace(-1, 1, 11)}, start={x: -2.0}, time=(0, 1), transient=40, phases=4,
                           interpreted=True)
    up, down = result.plot(x).lines
    assert (up.get_label(), down.get_label()) == ("up", "down")
    assert up.get_markersize() > down.get_markersize()  # so that up shows around down
    dataset = pytest.importorskip("xarray") and result.to_xarray()
    assert dataset["x"].dims == ("direction", "a", "start", "phase")
    matplotlib.pyplot.close("all")


@pytest.mark.parametrize("call, message", [
    (dict(carry="sideways"), "give \"up\", \"down\" or \"both\""),
    (dict(sweep={a: 1.0}), "the sweep varies nothing"),
    (dict(sweep=my.grid({a: [0, 1], b: [0, 1]})), "the sweep varies a, b"),
    (dict(sweep={x: [0.0, 1.0]}), "'x' is no parameter of the model"),
    (dict(transient=-1), "transient is -1: give at least 0"),
    (dict(sweep={a: []}), "the sweep has no values of a"),
    (dict(start={x: my.uniform(0, 1)}), "x is drawn at random: give NumPy's random numbers"),
    (dict(model=3), "the model is a int"),
])
def test_wrong_calls_of_hysteresis_are_refused(call, message):
    with pytest.raises(my.Error, match=message):
        my.hysteresis(**{"model": cusp, "sweep": {a: [0.0, 1.0]}, "start": {x: 0.1}, "time": (0, 1), **call})


def test_attractors_have_one_number_over_a_parameter():
    values = np.linspace(-0.6, 0.6, 7)
    found = my.continuation(cusp, {a: values}, start={x: np.linspace(-2, 2, 20)}, time=(0, 1), transient=60, phases=16,
                            interpreted=True)
    assert found.shares.shape == (7, 2) and found.numbers[0] != found.numbers[-1]
    both = np.abs(values) < fold
    assert ((found.shares > 0).all(axis=1) == both).all()
    np.testing.assert_allclose(found.shares.sum(axis=1), 1)
    # starts below the steady state in the middle go down
    middle = [min(np.roots([-1, 0, 1, value]).real, key=abs) for value in values[both]]
    below = [(np.linspace(-2, 2, 20) < at).mean() for at in middle]
    np.testing.assert_allclose(found.shares[both, 0], below)
    assert found.kinds(0)[-1] == "" and found.kinds(0)[0] == "stable node"
    assert "2 attractors over 7 values of a" in repr(found)
    dataset = pytest.importorskip("xarray") and found.to_xarray()
    assert np.isnan(dataset["x_mean"].values[-1, 0]) and dataset["x_mean"].values[0, 0] < 0


def test_a_pitchfork_keeps_one_of_its_branches_and_has_a_new_one():
    pitchfork = my.model({x: a * x - x**3})
    found = my.continuation(pitchfork, {a: [-1.0, -0.5, 0.5, 1.0]}, start={x: np.linspace(-2, 2, 10)}, time=(0, 1),
                            transient=60, phases=16, interpreted=True, reach=5)
    assert (found.shares > 0).sum(axis=1).tolist() == [1, 1, 2, 2]
    for value, at in zip(found.values[2:], found[2:]):
        assert sorted(one.mean["x"] for one in at) == pytest.approx([-np.sqrt(value), np.sqrt(value)])
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    assert len(found.plot().collections) == 2
    matplotlib.pyplot.close("all")
    nothing = my.continuation(my.model({x: a + x**2}), {a: [1.0, 2.0]}, start={x: 0.1}, time=(0, 1), interpreted=True)
    with pytest.raises(my.Error, match="no attractor at any value of a"):
        nothing.plot()
    with pytest.raises(my.Error, match="reach is 0: give a positive"):
        my.continuation(pitchfork, {a: [0.0, 1.0]}, start={x: 0.1}, time=(0, 1), reach=0)
