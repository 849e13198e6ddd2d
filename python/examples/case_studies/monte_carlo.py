# SPDX-License-Identifier: MIT
# %% [markdown]
# # How many are ill at the peak of an epidemic?
#
# Kermack's and McKendrick's model (Proc. R. Soc. A 115 (1927) 700) of shares of a population that are susceptible and
# infectious. Each of 100 000 epidemics draws how many others one person infects at first, R0, and for how many days.
# The infectious are most where R0 s = 1, which is an event.

# %%
import statistics

import numpy as np
from matplotlib import pyplot as plt

import myriad_ode as my

# snippet: model
s, i = my.states("s i")
R0, duration = my.parameters("R0 duration")
peak, day = my.accessory("peak"), my.accessory("day")
turning_point = my.event(R0 * s - 1, direction="falling", tolerance=1e-9, stop_after=1, do={peak: i, day: my.time},
                         name="turning_point")
epidemic = my.model({s: -R0 * s * i / duration, i: (R0 * s * i - i) / duration}, name="epidemic", events=turning_point,
                    accessories={peak: i, day: my.time})
# end of snippet

# snippet: solve
draws = {R0: my.normal(2.5, 0.4), duration: my.uniform(4, 10)}
study = my.study(epidemic, draws, draws=100_000, seed=1, start={s: 1 - 1e-4, i: 1e-4}, time=(0, 20_000), rtol=1e-9,
                 atol=1e-9, method="tsitouras_5", keep=dict(end=[peak, day]))
# end of snippet

# %%
result = study.run()
peaks = np.asarray(result["peak_end"])
days = np.asarray(result["day_end"])

# %%
figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
left.hist(100 * peaks, bins=150, density=True, color="#0072B2")
left.set_xlabel("infectious at the peak (% of the population)")
left.set_ylabel("density")
right.hist2d(days, 100 * peaks, bins=150, range=[[0, 130], [0, 45]], cmap="Blues", norm="log")
right.set_xlabel("day of the peak")
right.set_ylabel("infectious at the peak (%)")
figure.savefig("monte_carlo.png", dpi=150)

# %% [markdown]
# s + i - log(s) / R0 is constant, so that the peak grows with R0 alone: its quantiles are the peaks at those of R0.

# %%
for share in (0.05, 0.5, 0.95):
    at = statistics.NormalDist(2.5, 0.4).inv_cdf(share)
    exact = 1 - (1 + np.log(at * (1 - 1e-4))) / at
    error = np.sqrt(share * (1 - share) / peaks.size)
    assert abs((peaks < exact).mean() - share) < 4 * error, (share, (peaks < exact).mean())
