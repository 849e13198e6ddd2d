# SPDX-License-Identifier: MIT
"""Virtual patients: correlated log-normal rates, a covariate, bands of percentiles over time for each dose group."""

import numpy as np

# snippet: patients
import matplotlib.pyplot as plt

import myriad_ode as my

gut, blood = my.states("gut blood")
dose, absorption, clearance, volume, weight = my.parameters("dose absorption clearance volume weight")
drug = my.model({gut: -absorption * gut, blood: absorption * gut - clearance / volume * blood}, name="drug"
                ).with_doses(my.doses(gut, dose, every=12))

of_clearance, of_volume = my.multivariate_normal([0, 0], [[0.09, 0.03], [0.03, 0.04]])
population = {absorption: my.lognormal(1.0, 0.3), weight: my.normal(70, 10),
              clearance: 5 * my.exp(of_clearance) * (weight / 70)**0.75,
              volume: 40 * my.exp(of_volume) * (weight / 70)}

times, percentiles, draws = np.linspace(0, 48, 97), [0.05, 0.5, 0.95], 2_000
bounds = my.reduce.confidence_levels(percentiles, draws)  # those of the whole population lie between, at 95 %
wanted = my.reduce.quantiles("blood_sample", [*percentiles, *bounds.ravel()], my.linspace(0, 400, 401))
_, axes = plt.subplots(figsize=(7, 3.6), layout="constrained")
for group in (50, 150):
    patients = my.study(drug, {dose: group, **population}, draws=draws, start={gut: 0, blood: 0}, time=(0, 48),
                        samples=times, keep=dict(end=[], samples=False, random=False), reduce=wanted)
    levels = patients.run()["blood_sample_quantiles"].reshape(3, 3, -1)  # the percentiles, and both bounds of each
    my.plots.bands(times, levels[0], percentiles, within=levels[1:], axes=axes, color=f"C{group // 100}",
                   label=f"90 % at {group} mg", xlabel="hours", ylabel="drug in the blood (mg)")
plt.savefig("patients.png")
# end of snippet

assert np.isfinite(patients.run()["blood_sample_quantiles"]).all()
drawn = my.study(drug, {dose: 1, **population}, draws=20_000, start={gut: 0, blood: 0}, time=(0, 0.1),
                 keep=[clearance, volume, weight]).run()
logarithms = np.log([drawn["clearance_end"] / 5 / (drawn["weight"] / 70)**0.75,
                     drawn["volume_end"] / 40 / (drawn["weight"] / 70)])
np.testing.assert_allclose(np.cov(logarithms), [[0.09, 0.03], [0.03, 0.04]], atol=0.003)
