# SPDX-License-Identifier: MIT
"""Rates that hold in several experiments, fitted to the data of all of them at once."""

import numpy as np

import myriad_ode as my

# snippet: model
gut, blood = my.states("gut blood")
absorption, elimination = my.parameters("absorption elimination")
drug = my.model({gut: -absorption * gut, blood: absorption * gut - elimination * blood}, name="drug")
# end of snippet

# snippet: experiments
times, doses = np.array([0.5, 1, 2, 4, 8, 12, 24]), np.array([25.0, 50.0, 100.0])  # an experiment for each dose
simulate = my.batched(drug, free=[absorption, elimination, gut], of=blood, start={blood: 0}, time=(0, 24),
                      samples=times)


def sets(rates):
    """The values of `free` in rows, one for each experiment: rates that all have, and what differs."""
    return np.column_stack([np.tile(rates, (doses.size, 1)), doses])
# end of snippet


true = np.array([1.2, 0.15])
data = simulate(sets(true))[:, :, 0] + np.random.default_rng(1).normal(0, 0.2, (doses.size, times.size))
data[0, 5:] = np.nan  # the first experiment was shorter

# snippet: fit
from scipy import optimize  # noqa: E402

there = np.isfinite(data)  # data[experiment, time], NaN where nothing was measured


def residuals(rates):
    return (simulate(sets(rates))[:, :, 0] - data)[there]


def jacobian(rates):
    slopes = simulate.with_jacobian(sets(rates))[1]  # [experiment, time, quantity, component of free]
    return slopes[:, :, 0, :2][there]


found = optimize.least_squares(residuals, [0.5, 0.5], jacobian, bounds=(0.01, 10))
print(found.x)
# end of snippet

np.testing.assert_allclose(found.x, true, rtol=0.05)
errors = np.sqrt(np.diag(np.linalg.inv(found.jac.T @ found.jac))) * 0.2
assert (abs(found.x - true) < 4 * errors).all()
