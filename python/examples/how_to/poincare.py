# SPDX-License-Identifier: MIT
"""Points of a Poincaré section: where orbits of Rössler's equations pass through a surface."""

import numpy as np

import myriad_ode as my

# snippet: section
x, y, z = my.states("x y z")
c = my.parameter("c")
roessler = my.model({x: -y - z, y: x + 0.1 * y, z: 0.1 + z * (x - c)}, name="roessler",
                    events=my.event(y, direction="falling", stop_after=1))  # the surface y = 0: it ends the phase

run = my.solve(roessler, {c: np.linspace(4, 12, 200)}, start={x: -5, y: 0, z: 0}, time=(0, np.inf), phases=240,
               record=dict(from_phase=200, states=[x, z], time=True), rtol=1e-9, atol=1e-9, carry_on_step=True)
points = run["x"], run["z"]  # a row for each c, a column for each return
run.plot.bifurcation(x="c", y="x").figure.savefig("poincare.png")
# end of snippet

assert run.report.failed == 0 and run["x"].shape == (200, 40)
simple = run[c] < 5.3  # the period doubles at c = 5.376
assert np.ptp(run["x"][simple], axis=1).max() < 1e-2 and np.ptp(run["x"][run[c] > 5.6], axis=1).min() > 0.1
