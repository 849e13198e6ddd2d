# SPDX-License-Identifier: MIT
"""The squid's axon from a file of CellML: how it fires, for currents from none to so much that it stops again."""

import pathlib

import matplotlib.pyplot as plt
import numpy as np

here = pathlib.Path(__file__).parent

# snippet: map
import myriad_ode as my  # noqa: E402

axon = my.read_cellml(here / "hodgkin_huxley.cellml")
print(axon.states, axon.parameters, axon.units["i_stim"])  # V m h n, C i_stim ..., µA/cm²

currents = np.linspace(0, 200, 400)
run = my.solve(axon, {"i_stim": currents}, time=(0, 60), samples=601, rtol=1e-7)

times = np.linspace(0, 60, 601)  # ms, as axon.time_unit says
plt.pcolormesh(times, currents, run["V"], shading="nearest", cmap="inferno")
plt.xlabel("t (ms)")
plt.ylabel("i_stim (µA/cm²)")
plt.colorbar(label="V (mV)")
plt.savefig("cellml.png")
# end of snippet

assert not run.failed.any()
V = np.asarray(run["V"])
late = V[:, 300:]  # after the first spike
swing = late.max(axis=1) - late.min(axis=1)
assert swing[0] < 1 and swing[20] > 90 and swing[-1] < 10  # at rest, firing, held by too much current
assert np.array_equal(run["membrane.V"], run["V"]) and run["sodium.i_Na"].shape == V.shape
assert run["m_gate_alpha"].shape == V.shape  # of three variables with the name alpha
