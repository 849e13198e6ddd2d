# SPDX-License-Identifier: MIT
"""Interpolated data against NumPy's and SciPy's, compiled and interpreted."""

import numpy as np
import pytest

import myriad_ode as my

numbers = np.random.default_rng(5)


def data(even, periodic, n=12):
    times = np.linspace(-1, 3, n) if even else np.sort(numbers.uniform(-1, 3, n))
    values = numbers.normal(size=n)
    if periodic:
        values[-1] = values[0]
    return times, values


def reference(times, values, kind, outside):
    interpolate = pytest.importorskip("scipy.interpolate")

    def at(x):
        if outside == "hold":
            x = np.clip(x, times[0], times[-1])
        if outside == "periodic":
            x = times[0] + np.mod(x - times[0], times[-1] - times[0])
        if kind == "cubic":
            ends = "periodic" if outside == "periodic" else "not-a-knot"
            return interpolate.CubicSpline(times, values, bc_type=ends)(x)
        return interpolate.interp1d(times, values, fill_value="extrapolate")(x)

    return at


@pytest.mark.parametrize("n", [2, 3, 4, 5, 60])
@pytest.mark.parametrize("kind", ["linear", "cubic"])
@pytest.mark.parametrize("outside", ["hold", "periodic", "extrapolate"])
@pytest.mark.parametrize("even", [False, True])
def test_numbers_are_scipys(kind, outside, even, n):
    times, values = data(even, outside == "periodic", n)
    y, = my.states("y")
    model = my.model({y: my.interpolate(my.time, times, values, kind, outside)})
    x = np.sort(np.concatenate([numbers.uniform(-2, 4, 200), times]))
    expected = reference(times, values, kind, outside)(x)
    if outside == "periodic":  # where the data begin again, either side is right
        x, expected = x[1:-1], expected[1:-1]
    np.testing.assert_allclose(model.derivatives(x, [0.0])[0], expected, atol=1e-9 * np.abs(expected).max(), rtol=1e-9)


@pytest.mark.parametrize("interpreted", [True, False])
def test_kernels_have_the_same_numbers(interpreted):
    """y = f at the begin, which a step of length 1e-6 does not change, for even and other times."""
    begin = my.parameter("begin")
    of_even, of_other = data(True, False, 60), data(False, True, 60)
    rhs, expected = {}, {}
    for kind in ("linear", "cubic"):
        even, other = my.states(f"{kind}_even {kind}_other")
        rhs[even] = my.interpolate(my.time, *of_even, kind, "hold", name=f"even_{kind}")
        rhs[other] = my.interpolate(my.time + 0 * begin, *of_other, kind, "periodic", name=f"other_{kind}")
        expected |= {even: reference(*of_even, kind, "hold"), other: reference(*of_other, kind, "periodic")}
    x = numbers.uniform(-2, 4, 101)
    run = my.solve(my.model(rhs), {"begin": x}, start=dict.fromkeys(rhs, 0), time=(x, x + 1e-6),
                   method="runge_kutta_4", step=1e-6, interpreted=interpreted)
    length = (x + 1e-6) - x
    middle = x + 0.5e-6
    for state, function in expected.items():
        np.testing.assert_allclose(run[state] / length, function(middle), atol=1e-4)


@pytest.mark.parametrize("change, message", [
    (dict(times=[0, 0, 1]), "do not increase after number 0"), (dict(values=[1, 2]), "of shape"),
    (dict(kind="square"), "give \"linear\" or \"cubic\""), (dict(outside="none"), "give one of hold"),
    (dict(outside="periodic"), "give the first value again"), (dict(values=[1, np.nan, 2]), "are not finite"),
    (dict(t=1.0), "at a constant")])
def test_messages(change, message):
    with pytest.raises(my.Error, match=message):
        my.interpolate(**{"t": my.time, "times": [0, 1, 2], "values": [1, 2, 3], **change})
