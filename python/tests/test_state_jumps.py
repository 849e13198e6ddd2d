# SPDX-License-Identifier: MIT
"""Jumps of equations where the state decides: which are found, and that derivatives without them are refused."""

import numpy as np
import pytest

import myriad_ode as my
from myriad_ode.models import state_jumps

x, y, clock = my.states("x y clock")
c, K = my.parameters("c K")
on = my.accessory("on")

jump = {
    "where": my.where(x > c, -2.0, -1.0), "a condition of two": my.where((x > c) & (y < K), 1.0, 0.0),
    "nested": my.where(y > c, my.where(x > K, 1.0, 2.0), 3.0), "sign": np.sign(x), "floor": my.floor(x),
    "ceil": my.ceil(x * y), "trunc": my.trunc(x), "round": my.round(x / c), "//": x // c, "%": x % c,
    "fmod": my.fmod(x, 2.0), "copysign": my.copysign(c, x - y), "a jump on a steep slope": my.where(
        x * y > c, 1e6 * (x * y - c) + 1.0, 0.0), "a small jump": my.where(x > c, 1e-12, 0.0) + y,
    "far away": my.where(x + 1e5 > c, 1.0, 2.0), "a time without a formula": my.where(
        my.sin(my.time * my.time) > c, 1.0, 0.0),
}
continuous = {
    "abs": abs(x - c), "maximum": my.maximum(x, c), "minimum": my.minimum(x * y, c),
    "ramp": my.where(x > c, x - c, 0.0), "root": my.where(x > K, my.sqrt(x - K), 0.0),
    "cube root": my.where(x > K, my.cbrt(x - K), 0.0),
    "root of a product": my.where(x * y > K, my.sqrt(x * y - K), 0.0), "a factor of zero": (x - c) * my.where(
        x > c, 1.0, 0.0), "size by sign": x * np.sign(x), "triangles": abs(x % c - c / 2),
    "square with a sign": my.copysign((x - y)**2, x - y), "one point": my.where(x == 0, 1.0, my.sin(x) / x),
    "a function in two pieces": np.arcsinh(x * y), "table": my.interpolate(x, [0.0, 1.0, 3.0], [0.0, 2.0, 1.0]),
    "by a parameter": my.where(c > K, x, 2 * x), "by an accessory": my.where(on > 0, x, 2 * x),
    "by time": my.where(my.time > c, x, 2 * x) + x * (my.time // c) + my.where(
        my.copysign(1.0, my.sin(my.time)) > 0, x, c),
    "by a clock": my.where(clock > c, x, 2 * x) + x * (clock % 1),
}


def model(expression):
    accessories = {on: 0.0} if "on" in repr(expression) else None
    return my.model({x: expression, y: 1.0 - y, clock: 1.0}, accessories=accessories)


@pytest.mark.parametrize("name", jump)
def test_equations_that_jump_where_the_state_decides_are_known(name):
    assert state_jumps.jumps(model(jump[name]))


@pytest.mark.parametrize("name", continuous)
def test_equations_that_are_continuous_or_jump_at_stops_have_all_their_derivatives(name):
    assert state_jumps.jumps(model(continuous[name])) == [] and state_jumps.note(model(continuous[name])) is None


def test_a_jump_in_the_quantity_of_a_summary_is_known():
    area = my.accessory("area")
    above = my.model({x: -x}, accessories={area: my.integral(my.where(x > c, 1.0, 0.0))})
    assert state_jumps.jumps(above) == ["x > c"]


def test_gradients_of_a_model_that_jumps_by_its_state_are_refused_with_a_cure():
    """They would leave out what the jump contributes: here all that depends on c."""
    falling = my.model({x: my.where(x > c, -2.0, -1.0)})
    why = r"as the equations jump where `x > c` changes.*give my.with_located_switches\(model\)"
    data = {"t": np.array([0.5, 1.0]), x: np.array([0.1, 0.2])}
    refused = [
        lambda: my.fit(falling, data, free={c: (0.1, 1.0)}, start={x: 1.0}, starts=2),
        lambda: my.least_squares(falling, data, free={c: (0.1, 1.0)}, start={x: 1.0}).gradient([0.5]),
        lambda: my.least_squares(falling, data, free={c: (0.1, 1.0)}, start={x: 1.0}).jacobian([0.5]),
        lambda: my.least_squares(falling, data, free={c: (0.1, 1.0)}, start={x: 1.0}, adjoint=True),
        lambda: my.batched(falling, free=[c], of=[x], start={x: 1.0}, time=(0, 1)).with_jacobian([0.5]),
        lambda: my.batched(falling, free=[c], of=[x], start={x: 1.0}, time=(0, 1)).vjp([0.5], [1.0]),
        lambda: my.batched(falling, free=[c], of=[x], start={x: 1.0}, time=(0, 1), adjoint=True),
    ]
    for call in refused:
        with pytest.raises(my.Error, match=why):
            call()


def test_jax_refuses_to_differentiate_what_jumps_by_its_state():
    jax = pytest.importorskip("jax")
    function = my.batched(my.model({x: my.where(x > c, -2.0, -1.0)}), free=[c], of=[x], start={x: 1.0},
                          time=(0, 1)).to_jax()
    with pytest.raises(my.Error, match="the equations jump where `x > c` changes"):
        jax.grad(lambda theta: function(theta)[0])(np.array([0.5]))
