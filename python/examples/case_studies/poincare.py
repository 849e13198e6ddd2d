# SPDX-License-Identifier: MIT
# %% [markdown]
# # Poincaré sections of Rössler's equations
#
# A system without forcing is sampled where its orbit passes through a surface (O. E. Rössler, Phys. Lett. A 57 (1976)
# 397), here y = 0 from above. An event ends the phase there, so that each instance has its own time between samples.

# %%
import numpy as np
from matplotlib import pyplot as plt

import myriad_ode as my

# snippet: model
x, y, z = my.states("x y z")
c, (a, b) = my.parameter("c"), my.shared("a b")
section = my.event(y, direction="falling", tolerance=1e-9, stop_after=1, name="section")
roessler = my.model({x: -y - z, y: x + a * y, z: b + z * (x - c)}, events=section, name="roessler")
# end of snippet


# %%
# snippet: solve
def returns(values, transient, kept, **more):
    """The run of values of c: points on the section and times from one to the next, after transient returns."""
    return my.solve(roessler, {c: values, a: 0.1, b: 0.1}, start={x: -5, y: 0, z: 0}, time=(0, np.inf),
                    phases=transient + kept, rtol=1e-9, atol=1e-9, carry_on_step=True, method="tsitouras_5",
                    record=dict(from_phase=transient, states=[x, z], time=True), **more)
# end of snippet


# %%
run = returns(np.linspace(4, 20, 1200), transient=300, kept=40)
print(run.report)

# %%
figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4.2), layout="constrained", width_ratios=(3, 2))
run.plot.bifurcation(c, x, axes=left)
chosen = [int(np.abs(run[c] - value).argmin()) for value in (9, 11, 18)]
my.plots.phase_portrait(run[x][chosen, :-1], run[x][chosen, 1:], points=True, axes=right, xlabel="x at a return",
                        ylabel="x at the next", labels=[f"c = {run[c][i]:.2f}" for i in chosen])
right.locator_params(nbins=5)
figure.savefig("poincare.png", dpi=150)

# %% [markdown]
# The period doubles at c = 5.37593 and at 7.77109, as Newton's method found with CVODE
# (validation/case_studies/poincare.cpp).

# %%
assert run.report.failed == 0
spread = np.ptp(run[x][:, ::2], axis=1), np.ptp(run[x], axis=1)  # of every second point, and of all
period_1, period_2 = (run[c] > 4.2) & (run[c] < 5.3), (run[c] > 5.5) & (run[c] < 7.6)
assert spread[1][period_1].max() < 1e-3 and spread[0][period_2].max() < 1e-3 and spread[1][period_2].min() > 0.5
assert abs(run["t"].max() / (2 * np.pi / np.sqrt(1 - 0.1**2 / 4)) - 1) < 1e-4  # a turn where z is 0 is the slowest
