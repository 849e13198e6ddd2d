#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Reads problems in PEtab's format and compares their likelihoods at the nominal values with what is recorded of them.

FOLDER has a folder for each problem, as cases/v1.0.0/sbml or cases/v2.0.0/sbml of
https://github.com/PEtab-dev/petab_test_suite, with solutions, or Benchmark-Models of
https://github.com/Benchmarking-Initiative/Benchmark-Models-PEtab, with recorded
simulations, whose likelihood is computed as that of Myriad's own, with the same noise. A problem is "right" where both
logarithms agree within 1e-3, or within 1e-5 of their size, and all values of the suite's solutions within their
tolerances; "refused" where read_petab says that it does not support something; "copied" where the recorded simulation
is a copy of the measurements, and "not recorded" where there is none; "wrong" where they differ; and "failed" where
there is no solution or something else goes wrong. Nothing is fetched. Models are interpreted. The exit status is 1 if
a problem is wrong or failed.

With --gradients derivatives by all that is estimated are compared with differences instead.
"""

import argparse
import collections
import sys
import time
import warnings
from pathlib import Path

import numpy as np
import pandas as pd
import yaml

import myriad_ode as my
from myriad_ode.base.errors import CannotInterpret
from myriad_ode.formats.sbml.math import Refused
from myriad_ode.inference.measurements import losses

from sbml_suite import table

outcomes = ("right", "refused", "copied", "not recorded", "wrong", "failed")
keys = ("observableId", "preequilibrationConditionId", "simulationConditionId", "time", "observableParameters",
        "noiseParameters")


def problem_of(folder):
    """The file of a folder's problem, or None."""
    found = []
    for file in sorted(folder.glob("*.yaml")):
        content = yaml.safe_load(file.read_text())
        if isinstance(content, dict) and not content.keys().isdisjoint(("problems", "model_files")):
            found.append(file)
    return min(found, key=lambda file: file.stem.strip("_") != folder.name, default=None)


def cell(value):
    """A cell as a text that is the same in both tables: numbers by six digits."""
    if pd.isna(value):
        return ""
    try:
        return f"{float(value):.6g}"
    except ValueError:
        return ";".join(cell(part) for part in value.split(";")) if ";" in str(value) else str(value)


def matched(measured, recorded):
    """The recorded simulation at each measurement, NaN where there is none: by the columns that have cells in
    common, or where that leaves some without, by the order of the tables if these have the same times."""
    values = recorded["simulation"].to_numpy(float)
    ids = sorted(set(measured["observableId"]), key=len, reverse=True)
    recorded = recorded.assign(observableId=[  # a record may have more in them, as those of PEtab's flattened problems
        next((known for known in ids if one == known or one.startswith(f"{known}__")), one)
        for one in recorded["observableId"]])
    cells = [{key: list(map(cell, table[key])) for key in keys if key in table} for table in (measured, recorded)]
    by = [key for key in keys if all(key in of for of in cells) and set(cells[0][key]) & set(cells[1][key])]
    rows = [list(zip(*(of[key] for key in by))) for of in cells]
    known = dict(zip(rows[1], values))
    found = np.array([known.get(row, np.nan) for row in rows[0]])
    times = [table["time"].to_numpy(float) for table in (measured, recorded)]
    in_order = len(measured) == len(recorded) and np.allclose(*times, rtol=1e-3, atol=1e-2)
    return values if in_order and (rows[0] == rows[1] or np.isnan(found).any() or "observableId" not in by) else found


class Simulation:
    """The observables of a problem at its measurements by Myriad, at the nominal values."""

    def __init__(self, problem, likelihood):
        sets = np.array([list(problem.nominal.values())])
        solved, self._experiment = likelihood._solutions.of(sets, False), problem._experiment
        self.mean, self._deviation = (np.full(self._experiment.time.size, np.nan) for _ in range(2))
        for o in self._experiment.observables:
            known = likelihood._known(o, solved, sets)
            self.mean[o.rows], self._deviation[o.rows] = likelihood._distribution(o, known)

    def log_likelihood(self, mean):
        """That of a simulation with the noise of this one, of what is no NaN of it."""
        return -sum(np.nansum(losses[o.distribution](o.scale, self._experiment.measured[o.rows], mean[o.rows],
                                                     self._deviation[o.rows])) for o in self._experiment.observables)


def outcome_of(folder, file, options):
    """(outcome, why, log-likelihood, that of the record) of a problem."""
    problem = my.read_petab(file)
    chosen = dict(method=options.method, rtol=options.rtol, atol=options.atol, device="cpu:1", advice=False,
                  time_limit=options.time_limit, max_steps=10_000_000)
    try:
        ours = Simulation(problem, problem.likelihood(interpreted=True, **chosen))
    except CannotInterpret:
        ours = Simulation(problem, problem.likelihood(**chosen))
    value = ours.log_likelihood(ours.mean)
    if not np.isfinite(ours.mean).all():
        return "failed", "no solution", np.nan, np.nan
    solutions = list(folder.glob("*_solution.yaml"))
    if solutions:
        solution = yaml.safe_load(solutions[0].read_text())
        recorded = pd.read_csv(folder / solution["simulation_files"][0], sep="\t")["simulation"].to_numpy(float)
        good = (abs(value - solution["llh"]) <= solution["tol_llh"]
                and np.abs(ours.mean - recorded).max() <= solution["tol_simulations"])
        if "unnorm_log_posterior" in solution:
            loss = problem.likelihood(interpreted=True, **chosen).loss(list(problem.nominal.values()))
            good = good and abs(loss + solution["unnorm_log_posterior"]) <= solution["tol_unnorm_log_posterior"]
        return "right" if good else "wrong", "", value, solution["llh"]
    recorded = sorted(folder.glob("simul*.tsv"))
    if options.roadrunner:
        return compared(ours, RoadRunner(file).simulate())
    if not recorded:
        return "not recorded", "", value, np.nan
    simulated = matched(problem.measurements, pd.read_csv(recorded[0], sep="\t"))
    if np.allclose(simulated, problem._experiment.measured, rtol=1e-6, equal_nan=True):
        return "copied", "the recorded simulation is a copy of the measurements", value, np.nan
    return compared(ours, simulated)


def gradient_of(file, options):
    """Whether the gradient of the likelihood is that of differences of fourth order: (outcome, why). Both are 3 %
    beside the nominal values, by the interpreter; a component counts times its parameter, in parts of the largest."""
    problem = my.read_petab(file)
    likelihood = problem.likelihood(interpreted=True, method=options.method, rtol=options.rtol, atol=options.atol,
                                    device="cpu:1", advice=False, time_limit=options.time_limit, max_steps=10_000_000)
    at, h = 1.03 * np.array(list(problem.nominal.values())), 1e-4
    gradient = likelihood.gradient(at) * at
    steps = 1 + h * np.array([1, -1, 2, -2])[:, None] * np.eye(at.size)[:, None, :]
    losses = likelihood.loss((steps * at).reshape(-1, at.size)).reshape(at.size, 4)
    differences = losses @ np.array([8, -8, -1, 1]) / (12 * h)
    error = np.abs(gradient - differences).max() / np.abs(gradient).max()
    return "right" if error < 1e-6 else "wrong", f"{at.size} free, {len(problem.model.states)} states: {error:.1e}"


class RoadRunner:
    """Simulates a problem by libRoadRunner, from petab's tables and the SBML as it is."""

    def __init__(self, file):
        from petab import v1

        self.problem = v1.Problem.from_yaml(str(file))
        self.nominal = self.problem.parameter_df["nominalValue"].to_dict()

    def _with(self, condition):
        """The SBML's model with the values of a condition, and the species that it sets."""
        import libsbml

        document = libsbml.readSBMLFromString(self.problem.model.to_sbml_str())
        model, values = document.getModel(), dict(self.nominal)
        for target, one in self.problem.condition_df.loc[condition].items():
            if target != "conditionName" and not pd.isna(one):
                values[target] = self._number(one, model)
        for name, value in values.items():
            species, parameter = model.getSpecies(name), model.getParameter(name)
            if model.getElementBySId(name) is not None:
                model.removeInitialAssignment(name)
            if species is not None and species.getHasOnlySubstanceUnits():
                species.setInitialAmount(value)
            elif species is not None:
                species.setInitialConcentration(value)
            elif parameter is not None:
                parameter.setValue(value)
            elif model.getCompartment(name) is not None:
                model.getCompartment(name).setSize(value)
        return document, [name for name in values if model.getSpecies(name) is not None]

    def _number(self, one, model=None):
        try:
            return float(one)
        except ValueError:
            return float(self.nominal[one] if one in self.nominal else model.getParameter(one).getValue())

    @staticmethod
    def _runner(document, rtol=1e-10, atol=1e-14):
        import libsbml
        import roadrunner

        made = roadrunner.RoadRunner(libsbml.writeSBMLToString(document))
        for name, value in (("relative_tolerance", rtol), ("absolute_tolerance", atol),
                            ("maximum_num_steps", 10_000_000)):
            made.integrator.setValue(name, value)
        return made

    def simulate(self):
        """The observables at the measurements."""
        table = self.problem.measurement_df.reset_index(drop=True)
        found = np.full(len(table), np.nan)
        by = [name for name in keys[1:3] if name in table]
        for condition, rows in table.groupby(by, dropna=False).groups.items():
            before, after = condition if len(by) == 2 else (None, *np.atleast_1d(condition))
            document, own = self._with(after)
            runner = self._runner(document)
            if isinstance(before, str) and before:
                rest = self._runner(self._with(before)[0])
                rest.simulate(0, 1e6, 2)
                for name in rest.model.getFloatingSpeciesIds():
                    if name not in own:
                        runner[f"[{name}]"] = rest[f"[{name}]"]
            found[rows] = self._observed(runner, document.getModel(), table.loc[rows])
        return found

    def _observed(self, runner, model, rows):
        from petab.v1.math import sympify_petab

        times = np.unique(np.append(0.0, rows["time"].replace(np.inf, 1e6).to_numpy(float)))
        formulas = {o: sympify_petab(self.problem.observable_df.loc[o, "observableFormula"])
                    for o in set(rows["observableId"])}
        wanted = sorted({str(s) for f in formulas.values() for s in f.free_symbols} & {
            e.getId() for e in model.getListOfAllElements() if e.isSetId()})
        is_concentration = {n: (s := model.getSpecies(n)) is not None and not s.getHasOnlySubstanceUnits()
                            for n in wanted}
        names = [f"[{n}]" if is_concentration[n] else n for n in wanted]
        samples = runner.simulate(times=list(times), selections=["time", *names]) if times.size > 1 else np.array(
            [[0.0, *(runner[n] for n in names)]])
        values = []
        for _, row in rows.iterrows():
            place = np.searchsorted(times, min(row["time"], 1e6))
            known = {**self.nominal, **dict(zip(wanted, map(float, np.asarray(samples)[place, 1:]))),
                     "time": float(times[place])}
            given = row.get("observableParameters")
            for i, part in enumerate(str(given).split(";") if not pd.isna(given) else (), 1):
                known[f"observableParameter{i}_{row['observableId']}"] = self._number(part, model)
            formula = formulas[row["observableId"]]
            values.append(float(formula.subs({s: known[str(s)] for s in formula.free_symbols})))
        return values


def compared(ours, simulated):
    """The same by a recorded simulation."""
    there = np.isfinite(simulated)
    value, theirs = (ours.log_likelihood(np.where(there, mean, np.nan)) for mean in (ours.mean, simulated))
    why = "" if there.all() else f"the record has {there.sum()} of {there.size} values"
    if there.any() and abs(value - theirs) <= max(1e-3, 1e-5 * abs(theirs)):
        return "right", why, value, theirs
    off = ~np.isclose(ours.mean, simulated, rtol=1e-3, atol=1e-3 * np.nanmax(np.abs(simulated), initial=0.0))
    return "wrong", f"{off.sum()} of {off.size} values differ by more than 1e-3", value, theirs


def check(folder, options):
    """A row of the table: name, outcome, both log-likelihoods, seconds and why."""
    begin, ours, theirs = time.perf_counter(), np.nan, np.nan
    file = problem_of(folder)
    try:
        if options.gradients:
            outcome, why = gradient_of(file, options)
        else:
            outcome, why, ours, theirs = outcome_of(folder, file, options)
    except Refused as error:
        outcome, why = "refused", str(error)
    except Exception as error:
        outcome, why = "failed", f"{type(error).__name__}: {error}"
    numbers = [f"{v:.9g}" if np.isfinite(v) else "" for v in (ours, theirs)]
    return folder.name, outcome, *numbers, f"{time.perf_counter() - begin:.1f}", why


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0], epilog=__doc__.split("\n\n", 1)[1],
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, metavar="FOLDER")
    parser.add_argument("--problems", help="some alone, as in 0001,0007 or Boehm: beginnings of names")
    parser.add_argument("--method", default="rodas_5p", help="of integration (rodas_5p)")
    parser.add_argument("--rtol", type=float, default=1e-8, help="relative tolerance (1e-8)")
    parser.add_argument("--atol", type=float, default=1e-10, help="absolute tolerance (1e-10)")
    parser.add_argument("--time-limit", type=float, default=60.0, help="seconds for each integration (60)")
    parser.add_argument("--roadrunner", action="store_true",
                        help="compare with simulations by libRoadRunner instead of recorded ones")
    parser.add_argument("--gradients", action="store_true",
                        help="compare gradients of the likelihood with differences instead")
    options = parser.parse_args()
    warnings.simplefilter("ignore")
    folders = [p for p in sorted(options.folder.iterdir()) if p.is_dir() and problem_of(p) is not None]
    if options.problems:
        folders = [p for p in folders if p.name.startswith(tuple(options.problems.split(",")))]
    if not folders:
        parser.error(f"{options.folder} has no such problems")
    rows = []
    for folder in folders:
        rows.append(check(folder, options))
        print(*rows[-1][:5], file=sys.stderr, flush=True)
    print(table([("problem", "outcome", "log-likelihood", "of the record", "seconds", ""), *rows]))
    counts = collections.Counter(row[1] for row in rows)
    print("\n" + ", ".join(f"{counts[outcome]} {outcome}" for outcome in outcomes if counts[outcome]))
    return 1 if counts["wrong"] + counts["failed"] else 0


if __name__ == "__main__":
    sys.exit(main())
