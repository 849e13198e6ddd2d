# SPDX-License-Identifier: MIT
"""A genetic toggle switch from a file of SBML: for which strengths of its two genes it keeps what it was set to."""

import pathlib

import matplotlib.pyplot as plt
import numpy as np

here = pathlib.Path(__file__).parent

# snippet: sweep
import myriad_ode as my  # noqa: E402

switch = my.read_sbml(here / "toggle_switch.xml", parameters="alpha_u alpha_v")
strengths = np.geomspace(0.5, 50, 120)
sweep = my.grid(alpha_u=strengths, alpha_v=strengths)

set_to_u = my.solve(switch, sweep, time=(0, 200), rtol=1e-8)  # starts with 5 of u and none of v, as in the file
set_to_v = my.solve(switch, sweep, start={"u": 0, "v": 5}, time=(0, 200), rtol=1e-8)

table = set_to_u.to_xarray()  # with the axes alpha_u and alpha_v; "state", a rule of the file: (u - v) / (u + v)
table["remembers"] = table["state_end"] - set_to_v.to_xarray()["state_end"] > 0.1
my.plots.parameter_map(strengths, strengths, table["remembers"], xlabel="alpha_u", ylabel="alpha_v")
plt.savefig("sbml.png")
# end of snippet

remembers = table["remembers"].values
assert not set_to_u.failed.any() and not set_to_v.failed.any()
assert (remembers == remembers.T).all()  # the genes can change places
# With n = 2 and equal strengths alpha there are two stable states from the pitchfork at alpha = 2 on.
pitchfork = strengths[np.flatnonzero(np.diagonal(remembers))[0]]
assert 1.9 < pitchfork < 2.2, pitchfork
