# SPDX-License-Identifier: MIT
"""On which of its parameters an epidemic depends, and when: Sobol's indices over time, Morris' screening, and rank
correlations."""

import matplotlib.pyplot as plt
import numpy as np

import myriad_ode as my

# snippet: model
susceptible, infected = my.states("susceptible infected")
contact, recovery, fading = my.parameters("contact recovery fading")  # per day
new = contact * my.exp(-fading * my.time) * susceptible * infected    # contacts become fewer
model = my.model({susceptible: -new, infected: new - recovery * infected}, name="epidemic")

bounds = {contact: (0.3, 0.6), recovery: (0.05, 0.2), fading: (0, 0.01), infected: (1e-5, 1e-3, "log")}
# end of snippet

# snippet: sobol
design = my.designs.sobol(bounds, 1024)  # 1024 (4 + 2) sets
days = np.arange(1, 101)
simulate = my.batched(model, free=design.names, of=infected, start={susceptible: 1}, time=(0, 100), samples=days)
indices = design.indices(simulate(design.points)[:, :, 0])  # of the share of infected on each day
my.plots.time_series(days, np.stack([indices["total"][name] for name in design.names]), labels=design.names,
                     xlabel="day", ylabel="total index")
plt.savefig("global_sensitivity.png")
# end of snippet

# snippet: screening
def worst(sets):
    """The largest share of infected at a time, of each set."""
    return simulate(sets).max(axis=(1, 2))

few = my.designs.morris(bounds, trajectories=20)  # 20 (4 + 1) sets
print(few.indices(worst(few.points)))
cube = my.designs.latin_hypercube(bounds, 500)
print(cube.indices(worst(cube.points)))
# end of snippet

# snippet: study
run = my.study(model, my.grid(design.sweep, {susceptible: 1}), time=(0, 100), keep=dict(end=[infected])).run()
at_the_end = design.indices(run[infected])
# end of snippet
print(indices.notes, at_the_end)
total, correlation = indices["total"], cube.indices(worst(cube.points))["rank_correlation"]
assert total["contact"][0] < total["infected"][0] and total["recovery"][-1] > total["infected"][-1]
assert correlation["contact"] > 0.5 and correlation["recovery"] < -0.5
np.testing.assert_allclose(at_the_end["total"]["recovery"], total["recovery"][-1], rtol=1e-3)
for measure in ("first", "total"):
    assert all(-0.2 < value.min() and value.max() < 1.2 for value in indices[measure].values())
