# SPDX-License-Identifier: MIT
# %% [markdown]
# # Over which magnet does a pendulum come to rest?
#
# A magnetic bob hangs above three magnets at the corners of a triangle (Motter, Gruiz, Károlyi and Tél, Phys. Rev.
# Lett. 111 (2013) 194101). Each instance is released at rest from another place, and ends as soon as its energy keeps
# it at one magnet.

# %%
import numpy as np

import myriad_ode as my

# snippet: model
x, y, u, v = my.states("x y u v")
omega, damping, height = 0.5, 0.2, 0.3
magnets = np.array([[2, 0], [-1, np.sqrt(3)], [-1, -np.sqrt(3)]]) / np.sqrt(12)  # sides of length 1


def potential(x, y):
    return omega**2 / 2 * (x**2 + y**2) - sum(((a - x)**2 + (b - y)**2 + height**2)**-0.5 for a, b in magnets)


barrier = potential(-np.linspace(0, 0.5, 20_001), 0).min()  # of the saddle between two magnets
pull = [((a - x)**2 + (b - y)**2 + height**2)**-1.5 for a, b in magnets]
pendulum = my.model(
    {x: u, u: sum(p * (a - x) for p, (a, _) in zip(pull, magnets)) - omega**2 * x - damping * u,
     y: v, v: sum(p * (b - y) for p, (_, b) in zip(pull, magnets)) - omega**2 * y - damping * v},
    after_step={my.end_phase: (u**2 + v**2) / 2 + potential(x, y) < barrier}, name="pendulum")
# end of snippet

# %% [markdown]
# Those that still have the energy to leave after four periods of the string's have no magnet: 0.


# %%
# snippet: solve
def released(places, **more):
    """The run of pendulums that begin at all pairs of places, and the magnet of each, 1 to 3, or 0."""
    run = my.solve(pendulum, my.grid({x: places, y: places}), start={u: 0, v: 0}, time=(0, 8 * np.pi / omega),
                   rtol=1e-8, atol=1e-8, method="dormand_prince_8", **more)
    distance = np.hypot(run[x][:, None] - magnets[:, 0], run[y][:, None] - magnets[:, 1])
    return run, np.where(run.status == "stopped_by_user", 1 + distance.argmin(axis=1), 0)
# end of snippet


# %%
places = np.linspace(-1.5, 1.5, 300)  # none on an axis of symmetry, where the end is a saddle
run, magnet = released(places)
print(run.report)

# %%
axes = my.plots.parameter_map(places, places, run.sweep.unstack(magnet), xlabel="x at the start",
                              ylabel="y at the start", zlabel="magnet")
axes.plot(*magnets.T, "o", color="black", markersize=4)
axes.set_aspect("equal")
axes.figure.savefig("basins.png", dpi=150)

# %% [markdown]
# The picture has the symmetries of the triangle: a reflection exchanges two magnets, and each of the three has a third
# of a disc.

# %%
assert run.report.failed == 0
grid = run.sweep.unstack(magnet)
mirrored = np.array([0, 1, 3, 2])[grid[:, ::-1]]
assert (magnet > 0).all() and (grid == mirrored).mean() > 0.999
inside = np.hypot(run.sweep.values("x"), run.sweep.values("y")) < 1.5
shares = np.bincount(magnet[inside], minlength=4)[1:] / inside.sum()
assert np.allclose(shares, 1 / 3, atol=0.01), shares
