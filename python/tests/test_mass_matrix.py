# SPDX-License-Identifier: MIT
"""Models M y' = f with a constant mass matrix, singular ones of index one among them."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import myriad_ode as my

tight = dict(method="rodas_5p", rtol=1e-8, atol=1e-10)


def robertson(**more):
    a, b, c = my.states("a b c")
    slow, back, fast = 0.04 * a, 1e4 * b * c, 3e7 * b * b
    return my.model({a: back - slow, b: slow - back - fast, c: a + b + c - 1}, **more)


def test_robertson_as_a_dae_ends_at_the_published_values():
    """t = 40: Hindmarsh's LSODE report (also in CVODE's manual) has 0.7158, 9.185e-6, 0.2842; more digits from the
    three slopes at tolerances of 1e-12."""
    model = robertson(mass_matrix=[1, 1, 0])
    run = my.solve(model, start=dict(a=1, b=0, c=0), time=(0, 40), method="rodas_5p", rtol=1e-9,
                   atol=[1e-12, 1e-16, 1e-12], size=3)
    np.testing.assert_allclose([run["a"], run["b"], run["c"]],
                               np.repeat([[0.71582706872], [9.185534764557e-6], [0.28416374575]], 3, 1), rtol=1e-7)
    assert abs(run["a"] + run["b"] + run["c"] - 1).max() < 1e-14


def transistor_amplifier(**more):
    """Problem TRANSAMP of the Test Set for IVP Solvers."""
    u = my.states("u1 u2 u3 u4 u5 u6 u7 u8")
    u1, u2, u3, u4, u5, u6, u7, u8 = u

    def through(voltage):
        return 1e-6 * (my.exp(voltage / 0.026) - 1)

    first, second, r = through(u2 - u3), through(u5 - u6), 9000
    capacities = np.zeros((8, 8))
    for i, j, c in [(0, 1, 1e-6), (3, 4, 3e-6), (6, 7, 5e-6)]:
        capacities[[i, j], [i, j]] -= c
        capacities[[i, j], [j, i]] += c
    capacities[2, 2], capacities[5, 5] = -2e-6, -4e-6
    return my.model(dict(zip(u, [
        (u1 - 0.1 * my.sin(200 * my.pi * my.time)) / 1000, u2 / r + (u2 - 6) / r + 0.01 * first, u3 / r - first,
        (u4 - 6) / r + 0.99 * first, u5 / r + (u5 - 6) / r + 0.01 * second, u6 / r - second,
        (u7 - 6) / r + 0.99 * second, u8 / r])), mass_matrix=capacities, **more)


def test_the_transistor_amplifier_ends_at_the_published_voltages():
    start = dict(zip(["u1", "u2", "u3", "u4", "u5", "u6", "u7", "u8"], [0, 3, 3, 6, 3, 3, 6, 0]))
    run = my.solve(transistor_amplifier(), start=start, time=(0, 0.2), method="rodas_5p", rtol=1e-7, atol=1e-7)
    published = [-0.5562145012262709e-2, 0.3006522471903042e1, 0.2849958788608128e1, 0.2926422536206241e1,
                 0.2704617865010554e1, 0.2761837778393145e1, 0.4770927631616772e1, 0.1236995868091548e1]
    assert abs(np.ravel(list(run.states.values())) - published).max() < 2e-6


def test_a_pendulum_of_index_one_swings_as_its_equation_of_second_order():
    """Cartesian coordinates, with the force of the rod by the twice differentiated constraint."""
    x, y, u, v, force = my.states("x y u v force")
    gravity = my.parameter("gravity")
    model = my.model({x: u, y: v, u: -force * x, v: -force * y - gravity,
                      force: u * u + v * v - force * (x * x + y * y) - gravity * y}, mass_matrix={force: 0})
    given = np.array([1.0, 9.81])
    run = my.solve(model, {gravity: given}, start={x: 1, y: 0, u: 0, v: 0, force: 0}, time=(0, 2), **tight)
    for i, g in enumerate(given):
        angle = solve_ivp(lambda t, s, g=g: [s[1], -g * np.sin(s[0])], (0, 2), [np.pi / 2, 0], rtol=1e-11,
                          atol=1e-11).y[0, -1]
        np.testing.assert_allclose([run["x"][i], run["y"][i]], [np.sin(angle), -np.cos(angle)], atol=2e-6)


def test_a_regular_mass_matrix_is_the_system_that_its_inverse_gives():
    x, v, w = my.states("x v w")
    mass = np.array([[2.0, 0, 0], [0, 3, 1], [0, 1, 3]])
    slopes = {x: v, v: -x - 0.1 * v, w: -w + x}
    run = my.solve(my.model(slopes, mass_matrix=mass), start=dict(x=1, v=0, w=0), time=(0, 5), **tight)
    inverse = np.linalg.inv(mass)
    matrix = inverse @ np.array([[0, 1, 0], [-1, -0.1, 0], [1, 0, -1.0]])
    expected = solve_ivp(lambda t, y: matrix @ y, (0, 5), [1, 0, 0], rtol=1e-11, atol=1e-12).y[:, -1]
    np.testing.assert_allclose(np.ravel(list(run.states.values())), expected, atol=1e-6)


def chain(n, **more):
    """Heat conduction in a rod of n cells whose ends have given temperatures: two algebraic equations."""
    u = my.states([f"u{i}" for i in range(n)])
    inner = [n * (u[i - 1] - 2 * u[i] + u[i + 1]) for i in range(1, n - 1)]
    left, right = u[0] - my.sin(my.time), u[-1] - 1 - u[-2] * u[-2] / 10
    return my.model(dict(zip(u, [left, *inner, right])), mass_matrix={u[0]: 0, u[-1]: 0}, **more)


@pytest.mark.parametrize("n", [5, 12])  # with dense and with sparse factors
def test_a_rod_with_algebraic_ends_is_the_rod_without_their_states(n):
    def slopes(t, inner):
        u = np.concatenate([[np.sin(t)], inner, [1 + inner[-1] ** 2 / 10]])
        return n * (u[:-2] - 2 * u[1:-1] + u[2:])

    run = my.solve(chain(n), start={f"u{i}": float(i == n - 1) for i in range(n)}, time=(0, 3), **tight)
    expected = solve_ivp(slopes, (0, 3), np.zeros(n - 2), method="Radau", rtol=1e-10, atol=1e-12).y[:, -1]
    got = np.ravel(list(run.states.values()))
    np.testing.assert_allclose(got[1:-1], expected, atol=1e-6)
    np.testing.assert_allclose(got[[0, -1]], [np.sin(3), 1 + got[-2] ** 2 / 10], atol=1e-7)


def test_what_stands_for_the_matrix_is_the_same_matrix():
    sparse = pytest.importorskip("scipy.sparse")
    texts = {robertson(mass_matrix=m).cpp("reactions") for m in (
        [1, 1, 0], np.diag([1.0, 1, 0]), sparse.csr_matrix(np.diag([1, 1, 0])), {"c": 0}, {my.state("c"): 0.0})}
    assert len(texts) == 1
    text, = texts
    assert "mass_matrix[] = {{a, a, 1.0}, {b, b, 1.0}};" in text
    assert "/// 0 = " in text
    assert robertson(mass_matrix=np.eye(3)).cpp("r") == robertson().cpp("r")
    assert robertson().mass_matrix is None


def test_equations_show_the_mass_matrix():
    x, v = my.states("x v")
    assert repr(my.model({x: v, v: -x}, mass_matrix=[[2, -1], [0, 0]])).startswith(
        "<myriad model model: 2 x' - v' = v; 0 = ")


def test_inconsistent_values_are_refused_with_the_equation_or_projected():
    model, start = robertson(mass_matrix=[1, 1, 0]), dict(a=1, b=0, c=[0, 0, 0.5])
    with pytest.raises(my.Error, match="instance 2 do not satisfy the algebraic equation 0 = f_c, whose right-hand "
                                       "side is 0.5 .*make_consistent=True"):
        my.solve(model, start=start, time=(0, 40), **tight)
    run = my.solve(model, start=start, time=(0, 40), make_consistent=True, **tight)
    assert run.report.failed == 0
    assert run["c"][2] == run["c"][0]
    with pytest.raises(my.Error, match="leave it out"):
        my.solve(robertson(), start=dict(a=1, b=0, c=0), time=(0, 40), make_consistent=True, **tight)


def test_a_projection_takes_times_and_parameters_of_each_instance():
    x, z = my.states("x z")
    k = my.parameter("k")
    model = my.model({x: -x, z: z * z - k - my.time}, mass_matrix={z: 0})
    run = my.solve(model, {k: [3.0, 8.0]}, start={x: 1, z: 1}, time=([1.0, 1.0], [1.0, 1.0]), make_consistent=True,
                   method="rodas_5p")
    np.testing.assert_allclose(run["z"], [2, 3], rtol=1e-14)


def test_algebraic_states_jump_where_their_equations_do_and_may_be_projected_at_the_start():
    """y jumps at t = 1, and x goes on from where it is."""
    x, y = my.states("x y")
    a = my.parameter("a")
    model = my.model({x: y, y: y**3 + y - my.where(my.time > 1, a, 0.0)}, mass_matrix={y: 0}, name="jumping")
    wanted = np.linspace(-3, 3, 32)
    run = my.solve(model, {a: wanted**3 + wanted}, start={x: 1, y: 0.5}, time=(0, 2), make_consistent=True, **tight)
    assert run.report.failed == 0
    np.testing.assert_allclose(run["y"], wanted, atol=1e-8)
    np.testing.assert_allclose(run["x"], 1 + wanted, atol=1e-7)


def test_studies_refuse_inconsistent_values():
    study = my.study(robertson(mass_matrix=[1, 1, 0]), start=dict(a=my.linspace(0.5, 1, 3), b=0, c=0), time=(0, 1),
                     **tight)
    with pytest.raises(my.Error, match="0 = f_c"):
        study.run()


def test_a_higher_index_is_refused():
    x, y, u, v, force = my.states("x y u v force")
    model = my.model({x: u, y: v, u: -force * x, v: -force * y - 9.81, force: x * x + y * y - 1},
                     mass_matrix=[1, 1, 1, 1, 0])
    start = dict(x=1, y=0, u=0, v=0, force=0)
    for more in ({}, {"make_consistent": True}):
        with pytest.raises(my.Error, match="an index above one"):
            my.solve(model, start=start, time=(0, 1), **more, **tight)


@pytest.mark.parametrize("given, message", [
    ([1, 1], r"has shape \(2,\).* give 3 by 3 numbers in the order of the states \(a, b, c\)"),
    (np.ones((3, 2)), r"has shape \(3, 2\)"),
    ([[1, 0, 0], [1]], "has shape"),
    ([0, 0, 0], "is zero"),
    ([1, float("nan"), 0], "entry 1 of mass_matrix is nan"),
    ({"a": my.parameter("k")}, "the factor of a' of mass_matrix is `k`.*constant matrix of numbers"),
    ({"d": 0}, "'d' is unknown"),
])
def test_a_matrix_that_is_none_is_refused(given, message):
    with pytest.raises(my.Error, match=message):
        robertson(mass_matrix=given)


@pytest.mark.parametrize("method", [None, "rosenbrock_23", "cash_karp"])
def test_other_methods_are_refused_before_anything_is_compiled(method):
    with pytest.raises(my.Error, match="has a mass matrix, which .* does not take: give method=\"rodas_5p\""):
        my.solve(robertson(mass_matrix=[1, 1, 0]), start=dict(a=1, b=0, c=0), time=(0, 1), method=method)


def test_the_interpreter_refuses_a_mass_matrix():
    with pytest.raises(my.Error, match="cannot be interpreted, as .*install a C"):
        my.solve(robertson(mass_matrix=[1, 1, 0]), start=dict(a=1, b=0, c=0), time=(0, 1), method="rodas_5p",
                 interpreted=True)
