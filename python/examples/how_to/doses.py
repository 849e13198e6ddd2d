# SPDX-License-Identifier: MIT
"""Doses at known times: the same for all, a regimen for each instance, a loading dose, infusions."""

import numpy as np

# snippet: doses
import myriad_ode as my

gut, blood = my.states("gut blood")
dose, interval = my.parameters("dose interval")
absorption, elimination = my.shared("absorption elimination")

swallowed = my.model({gut: -absorption * gut, blood: absorption * gut - elimination * blood}, name="swallowed",
                     stops=my.stop(0, every=interval, count=10, do={gut: gut + dose}))

regimens = my.grid({dose: [50, 100], interval: [8, 12, 24], absorption: 1.0, elimination: 0.2})  # hours
run = my.solve(swallowed, regimens, start={gut: 0, blood: 0}, time=(0, 72), samples=400)
run.plot.time_series("blood").figure.savefig("doses.png")
# end of snippet

# snippet: listed
listed = my.model({gut: -absorption * gut, blood: absorption * gut - elimination * blood}, name="listed", stops=[
    my.stop(0, do={gut: gut + 2 * dose}),              # a loading dose
    my.stop([12, 24, 30, 48], do={gut: gut + dose}),   # and doses at any times
])
# end of snippet

# snippet: infusion
rate, hours = my.parameters("rate hours")
infused = my.model({blood: my.where(my.time % 24 < hours, rate, 0) - elimination * blood}, name="infused")
# end of snippet


def amount_in_blood(t, times, doses):
    """By Bateman's function, of doses at some times."""
    since = np.maximum(t - np.asarray(times, float)[:, None], 0)
    return np.sum(np.asarray(doses)[:, None] / 0.8 * (np.exp(-0.2 * since) - np.exp(-since)), axis=0)


for i in range(6):
    every = run[interval][i]
    expected = amount_in_blood(run.t_sample[i], every * np.arange(10), np.full(10, run[dose][i]))
    np.testing.assert_allclose(run[blood][i], expected, atol=1e-5)

body = {absorption: 1.0, elimination: 0.2}
run = my.solve(listed, {dose: [50], **body}, start={gut: 0, blood: 0}, time=(0, 72), samples=100)
np.testing.assert_allclose(run[blood][0], amount_in_blood(run.t_sample[0], [0, 12, 24, 30, 48], [100, 50, 50, 50, 50]),
                           atol=1e-5)
run = my.solve(infused, {rate: [10], hours: [2], elimination: 0.2}, start={blood: 0}, time=(0, 24))
np.testing.assert_allclose(run[blood], 10 / 0.2 * (1 - np.exp(-0.4)) * np.exp(-0.2 * 22), rtol=1e-6)
