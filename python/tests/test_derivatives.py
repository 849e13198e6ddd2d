# SPDX-License-Identifier: MIT
"""Derivatives of traced models by symbols, and the pattern of the Jacobian, which stiff methods use."""

import re

import numpy as np
import pytest

import myriad_ode as my
from myriad_ode.symbolic.derivatives import dependencies, derivatives, directional, transposed
from myriad_ode.symbolic.evaluate import evaluate
from myriad_ode.symbolic.expression import constant
from myriad_ode.symbolic.operations import operations

x, y, z = my.states("x y z")
k = my.parameter("k")
at = {x: 0.6, y: -0.35, z: 1.7, k: 1.3}

smooth = {
    "sum": x + y - z, "product": x * y * k, "quotient": x / (z * y), "fma": my.fma(x, y, z), "negative": -(x * y),
    "reciprocal": my.reciprocal(x * z), "sqrt": my.sqrt(x * z), "rsqrt": my.rsqrt(x * z),
    "cbrt": my.cbrt(z * x), "abs": abs(x * y),
    "sin": my.sin(x * y), "cos": my.cos(x * y), "tan": my.tan(x * y), "asin": my.asin(x * y), "acos": my.acos(x * y),
    "atan": my.atan(x * y), "sinpi": my.sinpi(x * y), "cospi": my.cospi(x * y), "sinh": my.sinh(x * y),
    "cosh": my.cosh(x * y), "tanh": my.tanh(x * y), "exp": my.exp(x * y), "exp2": my.exp2(x * y),
    "log": my.log(x * z), "log2": my.log2(x * z), "log10": my.log10(x * z), "hypot": my.hypot(x, y * z),
    "atan2": my.atan2(x, y * z), "copysign": my.copysign(x * z, y), "pow": (x * z) ** (z + k), "power": (x * z) ** 1.7,
    "whole power": (x * y) ** 3, "powr": my.powr(x * z, y), "sincos": my.sincos(x * y)[0] + my.sincos(x * z)[1],
    "sincospi": my.sincospi(x * y)[0] + my.sincospi(x * z)[1],
    "where": my.where(x > y, x * x, y * z) + my.where(x < y, x * x, y * z),
    "extremes": my.minimum(x * x, y) + my.maximum(x * x, z),
    "expm1": my.expm1(x * y), "log1p": my.log1p(x * z), "fmod": my.fmod(x * z, y) + my.fmod(x * y, k),
    "remainder": (x * z) % y + (x * y) % z, "quotient rounded down": x * ((x * z) // y) + my.trunc(z) + my.ceil(z),
}


def by_differences(expression, symbol):
    """Fourth-order central differences: exact to about eps^(4/5)."""
    h = 1e-3
    value = [float(evaluate([expression], {**at, symbol: at[symbol] + j * h})[0]) for j in (-2, -1, 1, 2)]
    return (value[0] - 8 * value[1] + 8 * value[2] - value[3]) / (12 * h)


@pytest.mark.parametrize("name", smooth)
def test_derivatives_are_those_of_differences(name):
    (found,) = derivatives([smooth[name]], [x, y, z])
    for i, symbol in enumerate((x, y, z)):
        value = float(evaluate([my.sin(0.0) + found[i]], at)[0]) if i in found else 0.0
        assert value == pytest.approx(by_differences(smooth[name], symbol), rel=2e-9, abs=2e-9)


@pytest.mark.parametrize("name", smooth)
def test_reverse_and_directional_derivatives_are_sums_of_derivatives(name):
    roots, symbols = [smooth[name], z * smooth[name]], [x, y, z, k]
    matrix = np.array([[evaluate([row.get(i, constant(0.0))], at)[0] for i in range(4)]
                       for row in derivatives(roots, symbols)])
    weights, direction = [0.7, -1.3], [0.2, 1.1, -0.4, 0.9]
    backwards = evaluate(transposed(roots, list(map(constant, weights)), symbols), at)
    np.testing.assert_allclose(backwards, weights @ matrix, rtol=1e-12, atol=1e-13)
    along = evaluate(directional(roots, symbols, list(map(constant, direction))), at)
    np.testing.assert_allclose(along, matrix @ direction, rtol=1e-12, atol=1e-13)


# idioms whose slope is infinite or has no value at some point, that point, and their derivatives by x, y and k there
at_their_ends = {
    "root of what is cut off": (my.sqrt(my.maximum(x - k, 0)), {x: 1.0, k: 2.0}, (0, 0, 0)),
    "root at the cut": (my.sqrt(my.maximum(x - k, 0)), {x: 2.0, k: 2.0}, (0, 0, 0)),
    "root where there is one": (my.where(x > k, my.sqrt(x - k) * y, 0.0), {x: 1.0, k: 2.0}, (0, 0, 0)),
    "quotient where there is one": (my.where(x > 0, y / x, 0.0), {x: 0.0}, (0, 0, 0)),
    "exponential where it is small": (my.where(x > 0, my.exp(k / x) * y, y), {x: 0.0}, (0, 1, 0)),
    "entropy": (my.where(x > 0, x * my.log(x), 0.0), {x: 0.0}, (0, 0, 0)),
    "power of zero": (x**k, {x: 0.0, k: 1.5}, (0, 0, 0)), "first power of zero": (x**k, {x: 0.0, k: 1.0}, (1, 0, 0)),
    "constant power of zero": (x**2.5, {x: 0.0}, (0, 0, 0)),
    "power by a logarithm": (my.exp(k * my.log(x)), {x: 0.0, k: 1.5}, (0, 0, 0)),
    "power of a still zero": ((x * y)**0.3, {x: 0.0, y: 0.0}, (0, 0, 0)),
    "length of nothing": (my.hypot(x, y), {x: 0.0, y: 0.0}, (0, 0, 0)),
    "root of squares": (my.sqrt(x * x + y * y) * k, {x: 0.0, y: 0.0}, (0, 0, 0)),
    "angle of nothing": (my.atan2(x, y), {x: 0.0, y: 0.0}, (0, 0, 0)),
    "cube root of a square": (my.cbrt(x * x) + y, {x: 0.0}, (0, 1, 0)),
    "angle of what is cut off": (my.asin(my.minimum(x, 1.0)) + my.acos(my.maximum(y, -1.0)), {x: 2.0, y: -3.0},
                                 (0, 0, 0)),
    "size": (abs(x) + y, {x: 0.0}, (1, 1, 0)),
}


@pytest.mark.parametrize("name", at_their_ends)
def test_a_product_with_a_derivative_that_is_zero_is_zero(name):
    expression, there, expected = at_their_ends[name]
    there, symbols = {**at, **there}, [x, y, k]
    (row,) = derivatives([expression], symbols)
    forwards = [float(evaluate([my.sin(0.0) + row[i]], there)[0]) if i in row else 0.0 for i in range(3)]
    assert forwards == pytest.approx(expected)
    backwards = evaluate(transposed([expression], [constant(1.0)], symbols), there)
    assert [float(one) for one in backwards] == pytest.approx(expected)
    for i in range(3):
        direction = [constant(float(i == j)) for j in range(3)]
        assert float(evaluate(directional([expression], symbols, direction), there)[0]) == pytest.approx(expected[i])


def test_a_weight_that_is_zero_makes_a_derivative_zero():
    w = my.parameter("w")
    assert evaluate(transposed([my.sqrt(x) + y], [w], [x, y]), {**at, x: 0.0, w: 0.0}) == [0.0, 0.0]


@pytest.mark.parametrize("expression", [1 / (1 + my.exp(x)), y / (1 + my.exp(x)), x / (2 + my.exp(3 * x) * y * y),
                                        1 / my.cosh(x), 1 / (1 + my.exp2(x * x))])
def test_quotients_by_what_overflows_have_the_derivative_zero(expression):
    there = {**at, x: 800.0}
    with np.errstate(over="ignore", invalid="ignore"):
        row, = derivatives([expression], [x])
        assert float(evaluate([my.sin(0.0) + row[0]], there)[0]) == 0
        assert float(evaluate(transposed([expression], [constant(1.0)], [x]), there)[0]) == 0
        assert float(evaluate(directional([expression], [x], [constant(2.0)]), there)[0]) == 0
        assert np.isfinite(float(evaluate(transposed([expression], [constant(1.0)], [x]), at)[0]))


@pytest.mark.parametrize("expression", [
    (1 + my.exp(x))**-1.5, (1 + my.exp(x))**(-y * y), my.powr(1 + my.exp(x), -y * y), my.tanh(my.exp(x)),
    my.tanh(-y * my.exp(x)), my.atan(1 - my.exp2(2 * x)), my.rsqrt(1 + my.exp(x)), my.reciprocal(1 + my.cosh(x)),
    my.expm1(-my.exp(x)), y * my.tanh(my.exp(x) + y)])
@pytest.mark.parametrize("large", [800.0, 1e300])
def test_what_becomes_flat_has_the_derivative_zero_where_its_argument_overflows(expression, large):
    there = {**at, x: large}
    with np.errstate(over="ignore", invalid="ignore"):
        row, = derivatives([expression], [x])
        assert float(evaluate([my.sin(0.0) + row[0]], there)[0]) == 0
        assert float(evaluate(transposed([expression], [constant(1.0)], [x]), there)[0]) == 0
        assert float(evaluate(directional([expression], [x], [constant(2.0)]), there)[0]) == 0
        moderate = {**at, x: 1.1}
        d = 1e-5
        ends = [float(evaluate([expression], {**at, x: 1.1 + s})[0]) for s in (d, -d)]
        for found in (row[0], transposed([expression], [constant(1.0)], [x])[0]):
            slope = (ends[0] - ends[1]) / (2 * d)
            assert float(evaluate([found], moderate)[0]) == pytest.approx(slope, rel=1e-6, abs=1e-9)


def test_what_does_not_become_flat_keeps_its_infinite_derivative():
    """Nor does a power that is not next to zero where its base's derivative overflows."""
    with np.errstate(over="ignore", invalid="ignore"):
        for expression in ((1 + my.exp(x))**-0.01, my.sqrt(1 + my.exp(x)), my.log(1 + my.exp(x))):
            row, = directional([expression], [x], [constant(1000.0)])
            assert not np.isfinite(float(evaluate([row], {x: 709.0})[0]))


def test_second_derivatives_do_not_stop_where_a_first_one_is_zero():
    """Of (1 + x^2)^0.5 at 0, where x^2 has the slope 0: d/dx x (1 + x^2)^-0.5 = 1."""
    slope = directional([my.sqrt(1 + x * x)], [x], [constant(1.0)])
    assert float(evaluate(transposed(slope, [constant(1.0)], [x]), {x: 0.0})[0]) == 1.0


def test_steps_have_no_derivatives_and_linear_terms_constant_ones():
    found = derivatives([my.floor(x) + 2.0 * y, my.round(x), z], [x, y, z])
    assert [set(row) for row in found] == [{1}, set(), {2}]


def test_an_operation_without_a_rule_leaves_the_pattern(monkeypatch):
    monkeypatch.delitem(operations, "sin")
    assert derivatives([my.sin(x) * y, z], [x, y, z]) is None
    assert transposed([my.sin(x) * y], [z], [x]) is None and directional([my.sin(x) * y], [x], [z]) is None
    assert dependencies([my.sin(x) * y, z], [x, y, z]) == [[0, 1], [2]]


def test_interpolation_has_the_derivative_of_its_interval():
    forced = my.interpolate(x, np.array([0.0, 1.0, 2.0]), np.array([0.0, 3.0, 4.0]))
    (found,) = derivatives([forced], [x])
    assert float(evaluate([found[0]], at)[0]) == pytest.approx(3.0) and list(found) == [0]


def chain(n):
    """A chain of reactions, each state fed by the one before it."""
    states = my.states(" ".join(f"s{i}" for i in range(n)))
    rates = [10.0 ** (i % 5) for i in range(n)]
    flows = [r * s * (1 + s) for r, s in zip(rates, states)]
    return my.model({s: -flows[i] + (flows[i - 1] if i else k) for i, s in enumerate(states)}), states


def test_the_pattern_has_the_entries_that_may_differ_from_zero():
    model, states = chain(9)
    written = re.search(r"jacobian_pattern\[\] = \{(.*?)\};", model.cpp(), re.S)[1]
    entries = {tuple(e.split(", ")) for e in re.findall(r"\{(\w+,\s+\w+)\}", " ".join(written.split()))}
    assert entries == {(f"s{i}", f"s{j}") for i in range(9) for j in (i - 1, i) if j >= 0}
    assert "autonomous" in model.cpp()
    small, _ = chain(6)
    assert "jacobian" not in small.cpp()  # dense factors stay in registers


def test_the_entries_of_the_factors_are_those_of_the_kernel():
    """Of a ring they have more than the Jacobian."""
    states = my.states([f"s{i}" for i in range(12)])
    ring = my.model({s: states[i - 1] * states[(i + 1) % 12] - s for i, s in enumerate(states)})
    run = my.solve(ring, start={s: 1.0 for s in states}, time=(0, 1), method="rodas_5p")
    assert run.report.matrix.jacobian_entries == 36 < run.report.matrix.factor_entries < 144
    assert (f"36 of 144 entries of the Jacobian may differ from zero; the factors of stiff methods have "
            f"{run.report.matrix.factor_entries}\n") in ring.cpp()
    explicit = my.solve(my.model({x: -x}), start={x: 1.0}, time=(0, 1), interpreted=True)
    assert explicit.report.matrix.states == 0 and "Jacobian" not in str(explicit.report)


def test_a_sparse_network_takes_the_steps_of_the_dense_one():
    model, states = chain(9)
    text = model.cpp()
    dense = re.sub(r"    static constexpr myriad::jacobian_entry.*?;\n|    static constexpr bool autonomous = true;\n|"
                   r"    template <class R>\n    MYRIAD_FUNCTION static myriad::vec<R, \d+> jacobian\(.*?\n    }\n", "",
                   text, flags=re.S)
    assert "jacobian" in text and "jacobian" not in dense
    name = re.search(r"struct (\w+) \{", text)[1]
    names = " ".join(f"s{i}" for i in range(9))
    runs = [my.solve(my.CppModel(source, name, names, "k"), {"k": np.linspace(1.0, 3.0, 20)},
                     start={f"s{i}": 0.5 for i in range(9)}, time=(0.0, 10.0), method="rodas_5p", rtol=1e-7, atol=1e-9)
            for source in (text, dense)]
    assert runs[0].report.accepted_steps == runs[1].report.accepted_steps
    written, found = (run.report.matrix for run in runs)
    assert (written.states, written.jacobian_entries, written.factor_entries) == (9, 17, 17)
    assert (found.jacobian_entries, found.factor_entries) == (17, 17)
    assert written.jacobian_evaluations == 0 and found.jacobian_evaluations == 2
    assert "// 17 of 81 entries of the Jacobian may differ from zero; the factors of stiff methods have 17" in text
    assert "of 81 entries of the Jacobian 17 may differ from zero; its factors have 17" in str(runs[0].report)
    for i in range(9):
        # the Jacobians differ by rounding alone, and the chain damps all differences
        np.testing.assert_allclose(runs[0][f"s{i}"], runs[1][f"s{i}"], rtol=1e-9)


def test_stiff_methods_pass_states_at_which_a_slope_is_infinite():
    """Outflow over an edge, from above it, from it and from below."""
    u, v, w, edge = *my.states("u v w"), my.parameter("edge")
    model = my.model({u: -my.sqrt(my.maximum(u - edge, 0)), v: -my.where(v > edge, my.sqrt(v - edge), 0.0),
                      w: -my.hypot(w, w) - my.maximum(w - 1, 0)**0.3})
    run = my.solve(model, {edge: [0.5, 1.0, 2.0]}, start={u: 1, v: 1, w: 0}, time=(0, 1), method="rodas_5p",
                   rtol=1e-8, atol=1e-10)
    for state in (u, v):
        np.testing.assert_allclose(run[state], [0.5 + (np.sqrt(0.5) - 0.5)**2, 1, 1], rtol=1e-7)
    assert (run[w] == 0).all()


@pytest.mark.parametrize("gate", [  # whose derivatives overflow before what is flat does, on the way
    1 / (1 + my.exp(-1000 * x)), (1 + my.exp(-1000 * x))**-1.5, my.reciprocal(1 + my.exp(-1000 * x)),
    1 - my.tanh(my.exp(-1000 * x))], ids=["quotient", "power", "reciprocal", "tanh"])
@pytest.mark.parametrize("method", ["rodas_5p", "rosenbrock_23"])
def test_stiff_methods_pass_over_exponentials_that_overflow(method, gate):
    model = my.model({x: 1 + gate, y: k * y * gate - y})
    run = my.solve(model, {k: 1.0}, start={x: -1, y: 1}, time=(0, 0.9), method=method, rtol=1e-9, atol=1e-9,
                   interpreted=True)
    np.testing.assert_allclose([run[x][0], run[y][0]], [-0.1, np.exp(-0.9)], rtol=1e-6)  # the method of second order
