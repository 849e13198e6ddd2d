# SPDX-License-Identifier: MIT
"""Rates that hold in several experiments, and rates of each patient, fitted to the data of all of them at once."""

import numpy as np

import myriad_ode as my

# snippet: model
gut, blood = my.states("gut blood")
absorption, elimination = my.parameters("absorption elimination")
drug = my.model({gut: -absorption * gut, blood: absorption * gut - elimination * blood}, name="drug")
# end of snippet

random = np.random.default_rng(1)


def measured(dose, rate, hours):
    run = my.solve(drug, {absorption: 1.2, elimination: rate}, start={gut: dose, blood: 0}, time=(0, hours[-1]),
                   samples=hours)
    return run[blood][0] * (1 + 0.05 * random.standard_normal(len(hours)))


hours = np.array([0.5, 1, 2, 4, 8, 12, 24])
data = {25: (hours[:5], measured(25, 0.15, hours[:5])), 50: (hours, measured(50, 0.15, hours)),
        100: (hours, measured(100, 0.15, hours))}

# snippet: fit
experiments = [my.experiment({"t": times, blood: levels}, start={gut: dose}, name=f"{dose} mg")
               for dose, (times, levels) in data.items()]
fit = my.fit(drug, experiments, start={blood: 0},
             free={absorption: (0.1, 10, "log"), elimination: (0.01, 1, "log")})
print(fit)
fit.plot()[0].figure.savefig("experiments.png")
# end of snippet

for name, true in (("absorption", 1.2), ("elimination", 0.15)):
    assert abs(fit.best[name] - true) < 4 * fit.standard_errors[name]

rates = {"P1": 0.1, "P2": 0.15, "P3": 0.25, "P4": 0.4}
table = {"patient": np.repeat(list(rates), hours.size), "hours": np.tile(hours, len(rates)),
         "dose": np.repeat([50, 50, 100, 100], hours.size),
         "level": np.concatenate([measured(d, r, hours) for d, r in zip([50, 50, 100, 100], rates.values())])}
table["level"] = np.maximum(table["level"], 1.0)

# snippet: table
patients = my.experiments_from_table(table, id="patient", t="hours", value="level", of=blood, start={gut: "dose"})
fit = my.fit(drug, patients, start={blood: 0}, own=elimination, sigma=my.noise_models.proportional("error"),
             limits={blood: (1.0, None)}, priors={absorption: my.priors.log_normal(1.0, 0.5)},
             free={absorption: (0.1, 10, "log"), elimination: (0.01, 1, "log"), "error": (0.01, 1, "log")})
print(fit)
fit.plot()[0].figure.savefig("patients.png")
# end of snippet

assert fit.best["error"] < 0.1 and (table["level"] == 1.0).sum() > 1
for name, true in rates.items():
    of = f"elimination[{name}]"
    assert abs(fit.best[of] - true) < 4 * fit.standard_errors[of]
