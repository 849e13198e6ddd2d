# SPDX-License-Identifier: MIT
"""From a file of SBML to a map over two parameters, and to bands of percentiles over time of many patients."""

import pathlib

import matplotlib.pyplot as plt
import numpy as np

here = pathlib.Path(__file__).parent

# snippet: model
import myriad_ode as my  # noqa: E402

model = my.read_sbml(here / "doses.xml")
one = my.solve(model, {"clearance": [3, 5, 8]}, time=(0, 72), samples=500)
one.plot.time_series("drug")  # with the file's units: t (h), drug (mg/l)
plt.savefig("doses_three.png")
# end of snippet

# snippet: map
sweep = my.grid(dose=np.linspace(20, 200, 60), interval=np.linspace(4, 24, 41))
run = my.solve(model, sweep, time=(0, 240), samples=np.linspace(192, 240, 200))
table = run.to_xarray()  # with the axes dose and interval
last_days = table["drug_sample"]
safe = (last_days.max("sample") < 4) & (last_days.min("sample") > 0.5)
my.plots.parameter_map(table["dose"], table["interval"], safe, zlabel="safe")
plt.savefig("doses.png")
# end of snippet

# snippet: bands
body = {"clearance": my.normal(5, 1), "body": my.normal(40, 6), "absorption": my.uniform(0.4, 1.2)}
times = np.linspace(0, 72, 145)
patients = my.study(model, body, draws=20_000, seed=1, time=(0, 72), samples=times,
                    keep=dict(end=[], samples=False, random=False),
                    reduce=[my.reduce.quantiles("drug_sample", [0.05, 0.5, 0.95], my.linspace(0, 8, 401))])
result = patients.run()

my.plots.bands(times, result["drug_sample_quantiles"], [0.05, 0.5, 0.95],
               xlabel=f"t ({model.time_unit})", ylabel=f"drug ({model.units['drug']})")
plt.savefig("doses_bands.png")
# end of snippet

assert not run.failed.any() and not one.failed.any()
doses, intervals = table["dose"].values, table["interval"].values
# In the long run as much is eliminated as is given: the mean concentration is dose / interval / clearance.
mean = last_days.sel(dose=100, interval=12, method="nearest")
expected = float(mean["dose"]) / float(mean["interval"]) / 5
assert abs(float(mean.mean()) / expected - 1) < 0.02, (float(mean.mean()), expected)
assert 0 < int(safe.sum()) < safe.size
low, median, high = result["drug_sample_quantiles"]
assert np.all(np.diff([low, median, high], axis=0) >= 0) and high[-1] > 1.5 * low[-1] > 0
