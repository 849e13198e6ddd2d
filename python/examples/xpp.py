# SPDX-License-Identifier: MIT
"""A neuron from an .ode file of XPPAUT: how often it fires, for currents and strengths of its adaptation."""

import pathlib

import matplotlib.pyplot as plt
import numpy as np

here = pathlib.Path(__file__).parent

# snippet: map
import myriad_ode as my  # noqa: E402

neuron = my.read_xpp(here / "adaptive_neuron.ode")
sweep = my.grid(I=np.linspace(0.5, 2, 60), b=np.linspace(0, 0.5, 40))

run = my.solve(neuron, sweep, time=neuron.time, rtol=1e-6)  # the file's time, from 0 to `total`
spikes = run.to_xarray()["count_end"]  # with the axes i and b: names are in small letters, as XPPAUT knows no others
spikes.plot.pcolormesh(x="i", y="b")
plt.savefig("xpp.png")
# end of snippet

assert not run.failed.any()
count = np.asarray(run["count"]).reshape(60, 40)
assert (np.diff(count[:, 0]) >= 0).all() and count[0, 0] == 0 < count[-1, -1] < count[-1, 0]  # more by more current
