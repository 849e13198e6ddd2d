# SPDX-License-Identifier: MIT
# %% [markdown]
# # Where a Duffing oscillator is chaotic
#
# A particle in a potential with two wells is driven periodically, x'' + k x' - x + x³ = B cos t. Over damping k and
# forcing B, the largest Lyapunov exponent tells chaos from periodic motion: neighbouring orbits part where it is
# positive. Melnikov's method (Guckenheimer and Holmes, *Nonlinear Oscillations, Dynamical Systems, and Bifurcations of
# Vector Fields*, section 4.5) says where chaos is impossible: the stable and unstable manifolds of the saddle between
# the wells meet only above B = 4 cosh(π/2) / (3 √2 π) k, to first order in k and B.

# %%
import numpy as np
from matplotlib import pyplot as plt

import myriad_ode as my

# snippet: model
x, v = my.states("x v")
k, B = my.parameters("k B")
duffing = my.model({x: v, v: x - x**3 - k * v + B * my.cos(my.time)}, name="duffing")
# end of snippet

# %% [markdown]
# One instance for each pair of values. With as many tangent vectors as states, the whole spectrum is found, and its sum
# has to be -k: that is how fast friction contracts areas. A phase is one period of the forcing; the first 40 are not
# counted.


# %%
# snippet: solve
def spectra(plane, vectors, transient, counted, **more):
    """The run of a plane of k and B, and as many exponents as there are vectors, the largest first."""
    model = my.with_tangents(duffing, vectors, transient_phases=transient)
    run = my.solve(model, plane, start={x: 1, v: 0.1}, time=(0, 2 * np.pi), phases=transient + counted,
                   carry_on_step=True, **{"rtol": 1e-6, "atol": 1e-6, "method": "tsitouras_5", **more})
    return run, my.exponents(run)
# end of snippet


plane = my.grid({k: np.linspace(0.05, 0.35, 64), B: np.linspace(0.0, 0.5, 56)})
run, exponents = spectra(plane, vectors=2, transient=40, counted=100)
largest = exponents[:, 0]
print(run.report)

# %% [markdown]
# A section through the plane at B = 0.3: where the oscillator is at the end of each of the last 60 periods, without
# tangents.

# %%
section = my.solve(duffing, {k: np.linspace(0.05, 0.35, 900), B: np.full(900, 0.3)}, start={x: 1, v: 0.1},
                   time=(0, 2 * np.pi), phases=200, record=dict(from_phase=140, states=[x]), rtol=1e-6, atol=1e-6,
                   method="tsitouras_5", carry_on_step=True)

# %%
threshold = 4 * np.cosh(np.pi / 2) / (3 * np.sqrt(2) * np.pi)
figure, (upper, lower) = plt.subplots(2, 1, figsize=(7, 7), sharex=True, layout="constrained", height_ratios=(3, 2))
axes = dict(plane.axes)
my.plots.parameter_map(axes["k"], axes["B"], plane.unstack(largest), axes=upper, cmap="RdBu_r", vmin=-0.25, vmax=0.25,
                       zlabel="largest Lyapunov exponent")
upper.plot(axes["k"], threshold * axes["k"], color="black", linewidth=1, linestyle="--")
upper.annotate("Melnikov's threshold", (0.21, 0.21 * threshold), xytext=(0.235, 0.1),
               arrowprops=dict(arrowstyle="-", linewidth=0.7))
upper.set_ylabel("forcing B")
upper.axhline(0.3, color="black", linewidth=0.6, linestyle=":")
section.plot.bifurcation(x=k, y=x, axes=lower, markersize=0.7)
lower.set_xlabel("damping k")
lower.set_ylabel("x at B = 0.3, once per period")
figure.savefig("chaos_over_a_plane.png", dpi=150)

# %% [markdown]
# The numbers behind the picture: areas contract as they must, and no point below the threshold is chaotic. (Beyond
# k = 0.38 some are: there the threshold's first order no longer holds.)

# %%
damping, forcing = plane.values("k"), plane.values("B")
assert run.report.failed == 0
assert np.allclose(exponents.sum(axis=1), -damping, atol=2e-4)
assert (largest[forcing < threshold * damping] < 0.01).all()
chaotic = (largest > 0.05) & (damping > 0.15)
assert 0.05 < chaotic.mean() < 0.5 and (forcing[chaotic] > threshold * damping[chaotic]).all()
