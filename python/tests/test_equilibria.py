# SPDX-License-Identifier: MIT
"""Steady states that instances come to, against closed forms."""

import numpy as np
import pytest

import myriad_ode as my
from myriad_ode.dynamics.equilibria import Equilibria, conserved_sums
from myriad_ode.dynamics.equations import Equations

x, y, z = my.states("x y z")
a, b, k = my.parameters("a b k")
options = dict(interpreted=True, rtol=1e-9, atol=1e-11)


def reached(model, start, method="dormand_prince_5", **values):
    start = np.atleast_2d(np.asarray(start, float))
    return Equilibria(model, {name: np.broadcast_to(v, len(start)).astype(float) for name, v in values.items()}, start,
                      {**options, "method": method})


def test_each_instance_comes_to_the_stable_state_of_its_side():
    # x = 0 is unstable, and near the start of the first.
    found = reached(my.model({x: a * x - x**3}), [[1e-5], [-0.1], [3.0]], a=[0.25, 1.0, 4.0])
    assert found.status == ["steady state"] * 3
    np.testing.assert_allclose(found.states[:, 0], [0.5, -1, 2], rtol=1e-9)
    by = found.derivatives(["a"], np.ones((3, 1, 1)), np.ones((3, 1, 1)))
    np.testing.assert_allclose(by[:, 0, 0], [1, -0.5, 0.25], rtol=1e-9)


def test_conserved_sums_are_found_and_depend_on_what_is_zero():
    model = my.model({x: -a * x * y + b * z, y: -a * x * y + b * z, z: a * x * y - b * z - k * z})
    symbols = {s: 1.0 for s in (a, b, k)}
    equations = Equations(model, symbols)
    free_and_bound = conserved_sums(equations, symbols)
    assert len(free_and_bound) == 1  # x - y
    assert free_and_bound[0] == pytest.approx(free_and_bound[0, 0] * np.array([1, -1, 0]))
    assert len(conserved_sums(equations, {**symbols, k: 0.0})) == 2
    assert len(conserved_sums(equations, {**symbols, a: 0.0, b: 0.0})) == 2


def test_binding_comes_to_equilibrium_with_what_there_was():
    model = my.model({x: -a * x * y + b * z, y: -a * x * y + b * z, z: a * x * y - b * z})
    start = np.array([[1.0, 2.0, 0.0], [3.0, 0.5, 1e-3]])
    found = reached(model, start, a=[1e3, 1.0], b=[1.0, 1e-4], method="rodas_5p")
    free, bound = found.states[:, 0], found.states[:, 2]
    np.testing.assert_allclose(free + bound, start[:, 0] + start[:, 2], rtol=1e-12)
    np.testing.assert_allclose([1e3, 1.0] * free * found.states[:, 1], [1.0, 1e-4] * bound, rtol=1e-9)


def test_what_is_zero_all_the_time_is_no_hindrance():
    # Nothing binds z, and y binds what is not there.
    model = my.model({x: 1 - a * x + 1e-3 * z, y: b * z * x - 0.3 * y, z: 0.3 * y - b * z * x})
    found = reached(model, [[0.1, 0.0, 0.0]], a=3.0, b=0.7)
    assert found.is_regular.all() and found.ends[0] == 10
    np.testing.assert_allclose(found.states[0], [1 / 3, 0, 0], rtol=1e-12, atol=1e-15)


def test_what_depends_on_time_is_steady_when_that_has_ended():
    found = reached(my.model({x: a * my.exp(-my.time / 50) + 1 - x}), [[0.0]], a=1.0)
    assert found.status == ["steady state"]
    assert found.states[0, 0] == pytest.approx(1, rel=1e-6)


def test_oscillators_and_what_grows_have_no_steady_state():
    found = reached(my.model({x: y, y: -a * x}), [[1.0, 0.0]], a=1.0)
    assert found.status != ["steady state"] and np.isnan(found.states).all()
    assert reached(my.model({x: a + 0 * x}), [[1.0]], a=1.0).status == ["no steady state"]
    explosion = reached(my.model({x: a * x**2}), [[1.0]], a=1.0)
    assert explosion.status not in (["steady state"], ["no steady state"])
