# SPDX-License-Identifier: MIT
"""Doses at known times: the same for all, a regimen for each instance, infusions, and those of a table."""

import numpy as np

# snippet: doses
import myriad_ode as my

gut, blood = my.states("gut blood")
dose, interval = my.parameters("dose interval")
absorption, elimination = my.shared("absorption elimination")

drug = my.model({gut: -absorption * gut, blood: absorption * gut - elimination * blood}, name="drug")
swallowed = drug.with_doses(my.doses(gut, dose, every=interval, count=10))

regimens = my.grid({dose: [50, 100], interval: [8, 12, 24], absorption: 1.0, elimination: 0.2})  # hours
run = my.solve(swallowed, regimens, start={gut: 0, blood: 0}, time=(0, 72), samples=400)
run.plot.time_series("blood").figure.savefig("doses.png")
# end of snippet

# snippet: listed
listed = drug.with_doses(my.doses(gut, 2 * dose),                    # a loading dose
                         my.doses(gut, dose, at=[12, 24, 30, 48]))   # and doses at any times
# end of snippet

# snippet: infusion
hours = my.parameter("hours")
infused = drug.with_doses(my.doses(blood, dose, every=24, duration=hours))
# end of snippet

# snippet: table
subjects = {"id": [1, 1, 1, 2, 2], "time": [0, 24, 30, 0, 4], "amt": [100, 50, ".", 80, "."],
            "cmt": [1, 1, ".", 1, "."], "dv": [".", ".", 70.3, ".", 39.1], "weight": [70, 70, 70, 81, 81]}
records = my.dose_table(subjects, {1: gut, 2: blood})
of_subjects = my.solve(drug.with_doses(records), {**records.sweep, absorption: 1.0, elimination: 0.2},
                       start={gut: 0, blood: 0}, time=records.time)
# end of snippet

# snippet: steady
weight = my.accessory("weight")
of_weight = my.model({gut: -absorption * gut, blood: absorption * gut - elimination * 70 / weight * blood},
                     name="drug_of_weight")
visits = {"id": [1, 1, 1], "time": [0, 6, 12], "amt": [100, 100, "."], "ss": [1, 0, 0], "ii": [8, 0, 0],
          "wt": [70, 70, 75], "dv": [".", ".", 88.1]}
at_visits = my.dose_table(visits, gut, over_time={weight: "wt"})
settled = my.solve(of_weight.with_doses(at_visits), {**at_visits.sweep, absorption: 1.0, elimination: 0.2},
                   start={gut: 0, blood: 0}, time=at_visits.time)
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
run = my.solve(infused, {dose: [20], hours: [2], **body}, start={gut: 0, blood: 0}, time=(0, 22))
np.testing.assert_allclose(run[blood], 10 / 0.2 * (1 - np.exp(-0.4)) * np.exp(-0.2 * 20), rtol=1e-6)
expected = [amount_in_blood(np.array([end]), times, amounts)[0] for end, times, amounts in
            ((30, [0, 24], [100, 50]), (4, [0], [80]))]
np.testing.assert_allclose(of_subjects[blood], expected, rtol=1e-5)
expected = amount_in_blood(np.array([12.0]), [*(-8 * np.arange(100)), 6], np.full(101, 100))
np.testing.assert_allclose(settled[blood], expected, rtol=1e-5)  # the weight changes at the end alone
