# SPDX-License-Identifier: MIT
"""Arrays that all instances share."""

import os
import subprocess
import sys

import numpy as np
import pytest

import myriad_ode as my

matrix = np.random.default_rng(1).normal(size=(12, 12)) - 4 * np.eye(12)
states = my.states([f"y{i}" for i in range(12)])


@pytest.mark.parametrize("size", [3, 12])  # term by term, and as a loop
def test_a_table_times_the_state_is_the_product(size):
    y = np.arange(1.0, size + 1)
    product = my.table("W", matrix[:size, :size]) @ states[:size]
    model = my.model(dict(zip(states, product)))
    np.testing.assert_allclose(model.derivatives(0.0, y), matrix[:size, :size] @ y, rtol=1e-14)
    assert ("for (int" in model.cpp()) == (size == 12)
    assert model.shared[:2] == ["W[0,0]", "W[0,1]"] and len(model.shared) == size * size
    assert list(model.shared_values.values()) == matrix[:size, :size].ravel().tolist()


def test_elements_and_rows_of_tables_are_expressions():
    x, W = my.state("x"), my.table("W", [[1.0, 2.0], [3.0, 4.0]])
    row = W[1]
    model = my.model({x: W[0, 1] * x + row[0] - W[-1, -1]})
    assert model.derivatives(0.0, [10.0])[0] == 19
    assert "p.shared[W + 1] * y[x] + p.shared[W + 2] - p.shared[W + 3]" in model.cpp()
    assert (my.table("r", [1.0, 2.0]) @ [x, 3]) is not None


def test_models_that_differ_in_the_values_of_tables_have_the_same_code():
    def model(values):
        return my.model({states[0]: my.table("c", values)[0]})

    assert model([1.0]).hash == model([2.0]).hash
    assert model([1.0]).shared_values != model([2.0]).shared_values


def test_integrated_with_a_table_linear_equations_have_their_closed_form():
    scale, total = my.parameter("scale"), my.accessory("total")
    W, ones = my.table("W", matrix), my.table("ones", np.ones(12))
    model = my.model({y: scale * slope for y, slope in zip(states, W @ states)}, finalise={total: ones @ states})
    start = np.linspace(-1, 1, 12)
    run = my.solve(model, {scale: [0.5, 1.0]}, start=dict(zip(states, start)), time=(0, 1), rtol=1e-11, atol=1e-13)
    values, vectors = np.linalg.eig(matrix)
    for i, factor in enumerate((0.5, 1.0)):
        expected = (vectors * np.exp(factor * values) @ np.linalg.solve(vectors, start)).real
        np.testing.assert_allclose([run[y][i] for y in states], expected, atol=1e-10)
        assert run[total][i] == pytest.approx(expected.sum(), abs=1e-9)


INTERPRETED = """
import numpy as np, myriad_ode as my
x, y = my.states("x y")
W = my.table("W", np.linspace(-1, 1, 18).reshape(2, 9))
slopes = W @ [x, y, x * y, x - y, 1, x, y, x + y, 2] - W[0, 1] * np.array([x, y])
run = my.solve(my.model(dict(zip((x, y), slopes))), start={x: 1, y: 0.5}, time=(0, 1))
print("interpreted" in run.report.kernel, *run["x"], *run["y"])
"""


def test_tables_are_interpreted_where_there_is_no_compiler():
    printed = []
    for changed in ({}, {"PATH": "/nonexistent", "MYRIAD_CXX": ""}):
        done = subprocess.run([sys.executable, "-c", INTERPRETED], env={**os.environ, **changed}, capture_output=True,
                              text=True)
        assert done.returncode == 0, done.stderr
        printed.append(done.stdout.split())
    assert [first for first, *_ in printed] == ["False", "True"]
    np.testing.assert_allclose(*(np.array(values, float) for _, *values in printed), rtol=1e-13)


@pytest.mark.parametrize("make, message", [
    (lambda: my.table("W", np.ones((2, 2, 2))), r"shape \(2, 2, 2\)"),
    (lambda: my.table("W", [np.nan]), "contains NaN"),
    (lambda: my.table("W", [1j]), "give real numbers"),
    (lambda: my.table("for", [1.0]), "keyword"),
    (lambda: my.table("W", np.ones((2, 3))) @ states[:2], "each of its 3 columns"),
    (lambda: np.array(states[:2]) @ my.table("W", np.ones((2, 2))), "from the left"),
    (lambda: my.table("W", np.ones(3))[3], "no element of a table"),
    (lambda: my.model({states[0]: my.table("W", [1.0])[0] + my.table("W", [2.0])[0]}), "'W' is the name of two"),
    (lambda: my.model({states[0]: my.table("y0", [1.0])[0]}), "'y0' names both a state and a shared"),
])
def test_wrong_tables_are_refused(make, message):
    with pytest.raises(my.Error, match=message):
        make()
