# SPDX-License-Identifier: MIT
"""Models given as text: what is too large or too deep is refused at once, and readably."""

import time

import pytest

import myriad_ode as my


@pytest.mark.parametrize("equation, message", [
    ("9**9**9**9*x", r"9 \*\* 387420489 is not a number of double precision \(test_text.py:\d+\)"),
    ("x**9**9**9", r"9 \*\* 387420489 is not a number"),
    ("2**1000*2**1000*x", "is too large for double precision"),
    ("10**400*x", r"10 \*\* 400 is not a number"),
    ("-" * 20000 + "x", "too many operations within each other: write it in parts"),
    ("(" * 5000 + "x" + ")" * 5000, "is no expression"),
    ("9" * 5000 + "*x", "is no expression"),
    ("x" + "**2" * 4000, "too many operations within each other"),
    ("x\0", "is no expression"),
])
def test_towers_of_powers_and_thousands_of_signs_are_refused_at_once(equation, message):
    begin = time.perf_counter()
    with pytest.raises(my.Error, match=message) as refused:
        my.model(f"x' = {equation}")
    assert time.perf_counter() - begin < 2
    assert len(str(refused.value)) < 500


def test_a_sum_of_two_thousand_terms_is_read():
    begin = time.perf_counter()
    model = my.model("x' = " + " + ".join(f"{i}*x" for i in range(2000)))
    assert model.derivatives(0, [1.0])[0] == 1999000
    assert time.perf_counter() - begin < 10
