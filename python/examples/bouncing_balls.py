# SPDX-License-Identifier: MIT
"""Balls that bounce, each with a loss of its own, up to their fifth impact: an event with an action, accessories, a
hook, and a grid."""

import numpy as np

import myriad_ode as my

# snippet: ball
x, v = my.states("x v")
r, g = my.parameter("r"), my.shared("g")
bounces, t_impact = my.integer_accessory("bounces"), my.accessory("t_impact")
highest, lost = my.accessory("highest"), my.accessory("lost")

impact = my.event(x, name="impact", direction="falling", tolerance=1e-10, do={
    x: 0, v: -r * v, bounces: bounces + 1, t_impact: my.time,
    lost: lost + (1 - r**2) * v**2 / 2,
    my.end_phase: bounces == 4,           # four before this one
})
ball = my.model({x: v, v: -g}, name="ball", events=[impact],
                accessories={bounces: 0, t_impact: my.time, lost: 0,  # what they start with in every phase
                             highest: my.phase_maximum(x)})           # along the solution, not only at steps
# end of snippet

# snippet: grid
sweep = my.grid({r: np.linspace(0.5, 0.9, 5), x: [1.0, 2.0], g: 9.81})  # 10 balls, from two heights
run = my.solve(ball, sweep, start={v: 0}, time=(0, 100), method="dormand_prince_5", rtol=1e-10, atol=1e-12)
table = run.to_xarray()                   # with the axes r and x_start
# end of snippet

# Five impacts at the times of the closed form, and the energy that is left.
loss, height = sweep.values("r"), sweep.values("x")
speed = np.sqrt(2 * 9.81 * height)
expected = speed / 9.81 * (1 + 2 * sum(loss**n for n in range(1, 5)))
assert (run["bounces"] == 5).all() and set(run.report.by_status) == {"stopped_by_user"}
assert np.allclose(run["t_impact"], expected, rtol=1e-8)
assert np.allclose(run["lost"], (1 - loss**10) * speed**2 / 2, rtol=1e-8)
assert np.allclose(run["highest"], height, rtol=1e-10)
assert table["t_impact_end"].sizes["r"] == 5
assert np.allclose(table["t_impact_end"].sel(x_start=2.0), expected[1::2], rtol=1e-8)
