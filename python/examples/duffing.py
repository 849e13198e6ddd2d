# SPDX-License-Identifier: MIT
"""The Duffing oscillator in ten lines: a bifurcation diagram of 4608 values of its damping."""

# snippet: duffing
import numpy as np
import myriad_ode as my

x, v = my.states("x v")
k, B, t = my.parameter("k"), my.shared("B"), my.time
duffing = my.model({x: v, v: x - x**3 - k * v + B * my.cos(t)}, name="duffing")

run = my.solve(duffing, {k: np.linspace(0.2, 0.3, 4608), B: 0.3}, start={x: -0.5, v: -0.1},
               time=(0, 2 * np.pi), phases=288, record=dict(from_phase=256, states=[x]), rtol=1e-9)
print(run.report)
run.plot.bifurcation(x="k", y="x").figure.savefig("duffing.png")
# end of snippet
