# SPDX-License-Identifier: MIT
"""Whole numbers of models: their range and their division, the same compiled and interpreted."""

import numpy as np
import pytest

import myriad_ode as my

LARGEST, LEAST = 2**31 - 1, -2**31
x, k = my.state("x"), my.parameter("k")
n, m, r = my.integer_accessory("n"), my.integer_accessory("m"), my.integer_accessory("r")


def values_of(expressions, hook, start, interpreted):
    """What a hook stores in r of each expression, for one instance per pair of whole numbers n and m."""
    found = []
    for expression in expressions:
        model = my.model({x: -x}, accessories={n: None, m: None, r: 0}, **{hook: {r: expression}})
        run = my.solve(model, start={x: 1, n: start[0], m: start[1]}, time=(0, 1), method="runge_kutta_4", step=1,
                       interpreted=interpreted, device="cpu")
        found.append(run["r"].tolist())
    return found


@pytest.mark.parametrize("hook", ["after_step", "finalise"])  # in packs and instance by instance
def test_whole_numbers_that_overflow_go_round_as_numpys_do_compiled_and_interpreted(hook):
    a = np.array([LARGEST, LARGEST, 1 << 20, 65537, -7, LEAST + 1, 0], np.int32)
    b = np.array([1, LARGEST, 1 << 20, 65537, 5, 2, 0], np.int32)
    expressions = [n + m, n - m, -n, n - LARGEST - 5]
    with np.errstate(over="ignore"):
        wanted = [a + b, a - b, -a, a - np.int32(LARGEST) - np.int32(5)]
        if hook == "finalise":
            expressions += [n * m, n * n * n, abs(n - 1), n // m, n % m, n // -1, 7 // n, my.where(n + 1 < n, 1, 2)]
            with np.errstate(divide="ignore"):
                wanted += [a * b, a * a * a, np.abs(a - np.int32(1)), a // b, a % b, a // np.int32(-1),
                           np.int32(7) // a, np.where(a + np.int32(1) < a, 1, 2)]
    wanted = [list(map(int, w)) for w in wanted]
    assert values_of(expressions, hook, (a, b), None) == wanted
    assert values_of(expressions, hook, (a, b), True) == wanted


def test_half_of_a_whole_number_is_a_whole_number_and_rounded_down():
    for expression in (n // 2, n % 2, n // m, n % -3, -n // 2, abs(n), round(n), divmod(n, 4)[0]):
        my.model({x: -x}, finalise={r: expression})  # which refuses real numbers
    a = np.array([7, -7, 6, -6, 0])
    assert values_of([n // 2, n % 2, n // -2, n % -2], "finalise", (a, a), None) == [
        list(w) for w in (a // 2, a % 2, a // -2, a % -2)]


@pytest.mark.parametrize("make", [
    lambda: my.model({x: -x}, accessories={n: 3_000_000_000}),
    lambda: my.model({x: -x}, finalise={n: n + 2**31}),
    lambda: my.model({x: -x}, finalise={n: my.where(n > 2**40, 1, 2)}),
])
def test_whole_constants_out_of_range_are_refused_with_their_line(make):
    with pytest.raises(my.Error, match=r"whole number \d+ \(test_whole_numbers.py:\d+\) has more than 32 bits.*real"):
        make()


def test_whole_constants_beside_real_numbers_may_be_as_large_as_they_like():
    model = my.model({x: -x * 3_000_000_000 / 3_000_000_000})
    assert my.solve(model, start={x: 1}, time=(0, 1), interpreted=True, device="cpu")["x"][0] == pytest.approx(
        np.exp(-1))


def test_a_whole_number_divided_by_zero_is_refused_where_it_is_known():
    with pytest.raises(my.Error, match="`n` is divided by zero"):
        n // 0


def test_shared_whole_numbers_are_computed_with_in_equations():
    i, j = my.shared_integer("i"), my.shared_integer("j")
    model = my.model({x: my.where(my.minimum(i, j) // 2 + i % 3 == 5, 1.0, 0.0)})
    for interpreted in (None, True):
        run = my.solve(model, {i: 10, j: 8}, start={x: 0}, time=(0, 1), interpreted=interpreted, device="cpu")
        assert run["x"][0] == pytest.approx(1)
