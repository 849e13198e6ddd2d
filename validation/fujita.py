#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The likelihood of problem Fujita_SciSignal2010 of PEtab's benchmark collection at its nominal values, by SciPy from
equations written by hand, and of the collection's own simulation, which is of other values: docs/fits.md.

Usage: fujita.py FOLDER, the problem's folder in the collection"""

import csv
import math
import pathlib
import sys

import numpy as np
from scipy.integrate import solve_ivp


def table(folder, name):
    with open(folder / f"{name}_Fujita_SciSignal2010.tsv", newline="") as file:
        return list(csv.DictReader(file, delimiter="\t"))


def slopes(k, egf):
    """The equations for a constant input."""
    def f(_, y):
        egfr, bound, active, with_akt, akt, p_akt, s6, with_s6, p_s6 = y
        binding = egf * egfr * k["reaction_1_k1"] - bound * k["reaction_1_k2"]
        activation, loss = bound * k["reaction_9_k1"], active * k["reaction_4_k1"]
        akt_binds = akt * active * k["reaction_2_k1"] - with_akt * k["reaction_2_k2"]
        s6_binds = s6 * p_akt * k["reaction_5_k1"] - with_s6 * k["reaction_5_k2"]
        akt_on, akt_off = with_akt * k["reaction_3_k1"], p_akt * k["reaction_7_k1"]
        s6_on, s6_off = with_s6 * k["reaction_6_k1"], p_s6 * k["reaction_8_k1"]
        return [(68190 - egfr) * k["EGFR_turnover"] - binding, binding - activation,
                activation - akt_binds + akt_on - loss, akt_binds - akt_on, akt_off - akt_binds,
                akt_on - s6_binds + s6_on - akt_off, s6_off - s6_binds, s6_binds - s6_on, s6_on - s6_off]
    return f


def main():
    folder = pathlib.Path(sys.argv[1])
    k = {row["parameterId"]: float(row["nominalValue"]) for row in table(folder, "parameters")}
    doses = {row["conditionId"]: float(row["EGF_0"]) for row in table(folder, "experimentalCondition")}
    measured, theirs = table(folder, "measurementData_step"), table(folder, "simulatedData")
    times = sorted({float(row["time"]) for row in measured})
    found = {}
    for condition in dict.fromkeys(row["simulationConditionId"] for row in measured):
        start = [k["init_EGFR"], 0, 0, 0, k["init_AKT"], 0, k["init_S6"], 0, 0]
        y, other = (solve_ivp(slopes(k, doses[condition]), (0, times[-1]), start, method, times, rtol=1e-10,
                              atol=1e-14).y for method in ("LSODA", "Radau"))
        print(f"{condition}: LSODA and Radau differ by {np.max(np.abs(y - other) / (np.abs(y) + 1e-12)):.1e}")
        found |= {(condition, name): k[f"scaling_{name}"] * value for name, value in (
            ("pEGFR_tot", y[2] + y[3]), ("pAkt_tot", y[5] + y[7]), ("pS6_tot", y[8]))}

    def likelihood(simulated):
        return sum(-0.5 * ((float(row["measurement"]) - value) / float(row["noiseParameters"]))**2
                   - math.log(float(row["noiseParameters"]) * math.sqrt(2 * math.pi))
                   for row, value in zip(measured, simulated))

    ours = [found[row["simulationConditionId"], row["observableId"]][times.index(float(row["time"]))]
            for row in measured]
    collection = [float(row["simulation"]) for row in theirs]
    assert all(a["time"] == b["time"] and a["observableId"] == b["observableId"] for a, b in zip(measured, theirs))
    apart = max(abs(a / b - 1) for a, b in zip(ours, collection) if b)
    print(f"log-likelihood: {likelihood(ours):.6f}; of the collection's simulation {likelihood(collection):.6f}, "
          f"of which a value differs by {apart:.0%}")


if __name__ == "__main__":
    main()
