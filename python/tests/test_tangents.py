# SPDX-License-Identifier: MIT
"""Models with tangent vectors; examples/lyapunov.py checks exponents."""

import numpy as np
import pytest

import myriad_ode as my

x, v = my.states("x v")
decay = my.model({x: -my.parameter("k") * x, v: -3 * v}, name="decay")


def test_tangents_are_states_that_start_orthonormal():
    model = my.with_tangents(decay, 2)
    tangents = ["x_tangent_1", "v_tangent_1", "x_tangent_2", "v_tangent_2"]
    assert model.states == ["x", "v", *tangents]
    start = np.array([model.defaults[name] for name in tangents]).reshape(2, 2)
    np.testing.assert_allclose(start @ start.T, np.eye(2), atol=1e-15)


def test_exponents_of_linear_equations_are_their_eigenvalues():
    # In the transient phases, ten units of time, tangents turn towards the eigenvectors up to e^-20 at the least.
    run = my.solve(my.with_tangents(decay, 2, transient_phases=20), {"k": [1.0, 2.0]}, start={x: 1, v: 1},
                   time=(0, 0.5), phases=50, rtol=1e-10, atol=1e-14)
    np.testing.assert_allclose(my.exponents(run), [[-1, -3], [-2, -3]], atol=1e-8)


def test_a_sweep_may_set_the_number_of_transient_phases():
    options = dict(start={x: 1, v: 1}, time=(0, 0.5), phases=4)
    model = my.with_tangents(decay, 1, transient_phases=1)
    one = my.exponents(my.solve(model, {"k": [1.0, 2.0]}, **options))
    two = my.exponents(my.solve(model, {"k": [1.0, 2.0], "transient_phases": 2}, **options))
    assert np.array_equal(two, my.exponents(my.solve(my.with_tangents(decay, 1, transient_phases=2), {"k": [1.0, 2.0]},
                                                     **options)))
    assert (one != two).all()


def test_stiff_methods_take_tangents_of_networks():
    """A chain of decays at rates of 1 to 1e5: the exponents of the two slowest ones. With eight states the model has a
    Jacobian and a pattern of its own, which hold for the states without tangents."""
    c = my.states([f"c{i}" for i in range(8)])
    rates = [1, 3, 10, 1e2, 1e3, 1e4, 1e4, 1e5]
    chain = my.model({s: -rate * s + (before * before if i else 0) for i, (s, before, rate) in
                      enumerate(zip(c, [c[0], *c[:-1]], rates))})
    run = my.solve(my.with_tangents(chain, 2, transient_phases=20), start={s: 1 for s in c}, time=(0, 0.5),
                   phases=50, method="rodas_5p", rtol=1e-7, atol=1e-9)
    np.testing.assert_allclose(my.exponents(run), [[-1, -3]], atol=1e-5)
    assert run.report.matrix.states == 24
    assert run.report.matrix.factor_entries < 24 * 24 / 3


@pytest.mark.parametrize("make, message", [
    (lambda: my.with_tangents(my.model({x: -x, v: x - v}, mass_matrix={v: 0})), "has a mass matrix"),
    (lambda: my.with_tangents(decay, 3), "a model of 2 states has from 1 to 2"),
    (lambda: my.with_tangents(decay, 0), "from 1 to 2"),
    (lambda: my.with_tangents(decay, transient_phases=-1), "transient_phases is -1.*0 or more"),
    (lambda: my.with_tangents(my.model({my.state("growth_1"): 1})), "component 'growth_1'"),
])
def test_wrong_tangents_are_refused(make, message):
    with pytest.raises(my.Error, match=message):
        make()


def test_runs_without_tangents_have_no_exponents():
    class ARun:
        accessories = {"growth_1": None}

    with pytest.raises(my.Error, match="has no tangents"):
        my.exponents(ARun())
