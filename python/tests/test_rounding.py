# SPDX-License-Identifier: MIT
"""round, % and // mean what they mean in Python, bit for bit, in packs, in hooks, interpreted, and in text."""

import math

import numpy as np
import pytest

import myriad_ode as my

x, a, b = my.state("x"), my.parameter("a"), my.parameter("b")
r = my.accessory("r")


def values_of(expression, hook, interpreted, values):
    model = my.model({x: 0 * x}, accessories={r: 0}, **{hook: {r: expression}})
    return my.solve(model, values, start={x: 1}, time=(0, 1), method="runge_kutta_4", step=1, interpreted=interpreted,
                    device="cpu")["r"]


def same(got, wanted):
    np.testing.assert_array_equal(got, wanted)
    np.testing.assert_array_equal(np.signbit(got), np.signbit(wanted))


@pytest.fixture(scope="module")
def pairs():
    random = np.random.default_rng(3)
    one = np.concatenate([[0.5, 1.0, -1.0, -1e-20, 5.3, 7.5, -7.5, 6.0, -6.0, 0.0, -0.0, 1e300, 1e22],
                          random.normal(size=300) * 10.0 ** random.integers(-8, 18, 300)])
    other = np.concatenate([[1e-3, 0.1, 0.1, 1.0, -0.7, 2.0, 2.0, -2.0, 2.0, 3.0, 3.0, 3e-300, 0.1],
                            random.normal(size=300)])
    return {"a": one, "b": other}


@pytest.mark.parametrize("hook", ["after_step", "finalise"])
@pytest.mark.parametrize("interpreted", [None, True])
def test_a_half_in_a_thousandth_leaves_what_python_says(hook, interpreted, pairs):
    python = [[x % y for x, y in zip(*map(np.ndarray.tolist, pairs.values()))],
              [x // y for x, y in zip(*map(np.ndarray.tolist, pairs.values()))],
              [math.fmod(x, y) for x, y in zip(*map(np.ndarray.tolist, pairs.values()))]]
    for expression, wanted in zip((a % b, a // b, np.fmod(a, b)), python):
        used = values_of(expression + 0 * b if "b" not in repr(expression) else expression, hook, interpreted, pairs)
        same(used, wanted)


@pytest.mark.parametrize("hook", ["after_step", "finalise"])
@pytest.mark.parametrize("interpreted", [None, True])
def test_two_and_a_half_is_rounded_to_two(hook, interpreted):
    values = np.array([2.5, 3.5, -2.5, -0.5, 0.5, 1e17, -7.7, 0.49999999999999994, -0.0])
    assert all(made is round(a) for made in (my.round(a), np.rint(a), np.round(a), np.around(a)))
    assert math.ceil(a) is np.ceil(a) and math.floor(a) is np.floor(a) and np.fix(a) is np.trunc(a) is math.trunc(a)
    for expression, wanted in ((round(a), np.rint(values)), (np.ceil(a), np.ceil(values)),
                               (np.trunc(a), np.trunc(values)), (np.floor(a), np.floor(values))):
        same(values_of(expression, hook, interpreted, {a: values}), wanted)


def test_text_rounds_and_divides_as_python_does():
    for text, wanted in (("round(2.5*x)", 2), ("(0.5*x) % 1e-3", 0.5 % 1e-3), ("x // 0.1", 9), ("-7*x % 4", 1)):
        assert my.model(f"x' = {text}").derivatives(0, [1.0])[0] == wanted, text


def test_remainders_have_derivatives_for_tangents():
    v, w = my.states("v w")
    model = my.model({v: w, w: -((v + 0.3) % 0.7) - np.log1p(v * v) - np.expm1(w)}, name="teeth")
    run = my.solve(my.with_tangents(model, 1), start={v: 0.1, w: 0.0}, time=(0, 0.3), rtol=1e-11, atol=1e-12,
                   device="cpu")
    assert np.isfinite(my.exponents(run)).all()
