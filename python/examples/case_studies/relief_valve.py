# SPDX-License-Identifier: MIT
# %% [markdown]
# # When a pressure relief valve chatters
#
# A valve on a spring is lifted by the pressure of a vessel into which gas flows. Displacement y, velocity v and
# pressure u are dimensionless (Hős and Champneys, Physica D 241 (2012) 2068). The valve hits its seat at y = 0 and
# rebounds: an event with an action. At which flows q does it chatter?

# %%
import numpy as np
from matplotlib import pyplot as plt

import myriad_ode as my

# snippet: model
y, v, u = my.states("y v u")
q = my.parameter("q")
kappa, delta, beta, restitution = 1.25, 10.0, 20.0, 0.8
impacts, speed = my.integer_accessory("impacts"), my.accessory("speed")
y_min, y_max = my.accessory("y_min"), my.accessory("y_max")
# end of snippet

# %% [markdown]
# A phase ends at a maximum of y, so that phases have no fixed length, and records say how far the valve opened and
# closed in each.

# %%
# snippet: model
valve = my.model(
    {y: v, v: u - kappa * v - (y + delta), u: beta * (q - y * my.sqrt(u))}, name="valve",
    accessories={y_min: my.phase_minimum(y), y_max: my.phase_maximum(y), impacts: 0, speed: 0},
    events=[my.event(v, name="top", direction="falling", stop_after=1),
            my.event(y, name="seat", direction="falling", tolerance=1e-10, do={
                v: -restitution * v, impacts: impacts + 1, speed: my.maximum(speed, -v)})])
# end of snippet


# snippet: solve
def oscillations(flows, transient, kept, **more):
    """The run of flows, with what happens in each oscillation after transient ones."""
    return my.solve(valve, {q: flows}, start={y: 0.2, v: 0, u: 0}, time=(0, 1000), phases=transient + kept,
                    carry_on=True, record=dict(from_phase=transient, accessories=[y_min, y_max, impacts, speed]),
                    **{"rtol": 1e-9, "atol": 1e-9, "method": "tsitouras_5", **more})
# end of snippet


flows = np.linspace(0.5, 10, 600)
run = oscillations(flows, transient=104, kept=24)
print(run.report)

# %% [markdown]
# The valve's equilibrium is where the flow through it is that into the vessel, y √u = q, and spring and pressure
# balance, u = y + δ. It is stable where all eigenvalues of the linearised equations have negative real parts.

# %%
rest = np.array([np.roots([1, delta, 0, -flow**2]).real.max() for flow in flows])
growth = np.array([np.linalg.eigvals(np.array([[0, 1, 0], [-1, -kappa, 1], [
    -beta * np.sqrt(level + delta), 0, -beta * level / (2 * np.sqrt(level + delta))]])).real.max() for level in rest])
hopf = flows[growth > 0].max()
hits = run["impacts"].max(axis=1) > 0
grazing = flows[hits].max()

# %%
figure, (upper, lower) = plt.subplots(2, 1, figsize=(7, 6.4), sharex=True, layout="constrained", height_ratios=(3, 1.6))
my.plots.bifurcation(flows, run["y_max"], axes=upper, color="#0072B2", markersize=1.2)
my.plots.bifurcation(flows, run["y_min"], axes=upper, color="#E69F00", markersize=1.2)
upper.plot(flows, np.where(growth < 0, rest, np.nan), color="black", linewidth=1)
upper.plot(flows, np.where(growth < 0, np.nan, rest), color="black", linewidth=1, linestyle="--")
for name, at, level, colour in (("largest opening", 2.2, 3.6, "#0072B2"), ("smallest opening", 3.4, 0.2, "#E69F00"),
                                ("equilibrium", 4.7, 0.95, "black")):
    upper.annotate(name, (at, level), color=colour)
upper.set_ylabel("displacement y")
my.plots.bifurcation(flows, np.where(run["impacts"] > 0, run["speed"], np.nan), axes=lower, color="#D55E00",
                     markersize=1.2)
lower.set_ylabel("hardest impact\nper oscillation")
lower.set_xlabel("flow q")
for axes in (upper, lower):
    axes.axvline(hopf, color="0.6", linewidth=0.8, linestyle=":")
    axes.axvline(grazing, color="0.6", linewidth=0.8, linestyle=":")
upper.annotate("hits its seat", (grazing, 1), xycoords=("data", "axes fraction"), xytext=(-4, -12), ha="right",
               textcoords="offset points", color="0.4")
upper.annotate("rests", (hopf, 1), xycoords=("data", "axes fraction"), xytext=(4, -12), textcoords="offset points",
               color="0.4")
figure.savefig("relief_valve.png", dpi=150)

# %% [markdown]
# Above the Hopf bifurcation the valve comes to rest where it should; below it oscillates about an unstable equilibrium,
# and where its oscillation is as large as its opening, it chatters.

# %%
assert run.report.failed == 0
openings = np.where(np.isnan(run["y_max"]), -np.inf, run["y_max"]).max(axis=1)
assert np.allclose(np.array(run["y"])[growth < -0.05], rest[growth < -0.05], atol=1e-3)
assert (openings[growth > 0.05] > 1.02 * rest[growth > 0.05]).all()
assert grazing < hopf and not hits[flows > grazing].any()
assert (np.nanmin(run["y_min"][~hits], axis=1) > -1e-9).all()
