#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Reads and simulates a collection of models in SBML, such as the curated BioModels, beside libRoadRunner.

FOLDER has files of SBML, or folders with one each; nothing is fetched. Smaller files come first. Each model is read by
read_sbml, interpreted, and compared at the samples with libRoadRunner (`pip install libroadrunner`): amounts of
species, parameters and compartments. A model is "right" where all values are within 1e-4 of libRoadRunner's, plus 1e-7
of the largest value of the variable; "refused" where Myriad says that it does not support something; "wrong" where a
value is not within that even with smaller tolerances; "undecided" where libRoadRunner's own values with those differ by
more than that from its first ones; "failed" where it ends otherwise; "neither" where libRoadRunner does so too; "time
limit" where it takes too long; "no reference" where it is solved and libRoadRunner has no values; and "skipped" where
it was not begun. Species without an initial value get 0, as libRoadRunner has it, and the line says so. Both
programs run in processes of their own. The exit status is 1 if a model is wrong or failed.
"""

import argparse
import hashlib
import pickle
import sys
from pathlib import Path

import libsbml
import numpy as np

import myriad_ode as my
from myriad_ode.base.errors import quoted
from myriad_ode.models.any_model import names_of
from myriad_ode.symbolic.symbols import symbol

from model_files import add_options, chosen, difference_of, first_that_ends, tried, within

outcomes = ("right", "refused", "wrong", "undecided", "failed", "neither", "time limit", "no reference", "skipped")


def files_of(folder):
    """The files of a collection, the smallest first."""
    return sorted((f for f in folder.glob("**/*.xml") if f.name != "manifest.xml"),
                  key=lambda f: (f.stat().st_size, f.name))


def times_of(options):
    """The times at which both programs have a sample, of which those with odd numbers are compared: each is a little
    after one before it, at which libRoadRunner sees whether `time == 20` holds, and where a value may be from before or
    after an event; no round part of a time, at which models with events every 0.001 would have one there too."""
    times = np.linspace(0.0, options.end, options.samples)
    return np.column_stack([times, times + times[1] / (100 * np.pi)]).ravel()


def roadrunners(file, options):
    """libRoadRunner's values at the samples by name: of species their amounts."""
    import roadrunner
    roadrunner.Logger.setLevel(roadrunner.Logger.LOG_CRITICAL)
    runner = roadrunner.RoadRunner(str(file))
    solver = runner.getIntegrator()
    solver.relative_tolerance, solver.absolute_tolerance = 0.1 * options.rtol, options.atol
    solver.maximum_time_step, solver.maximum_num_steps = options.end / (options.samples - 1), 1_000_000
    names = [name for of in ("FloatingSpecies", "BoundarySpecies", "GlobalParameter", "Compartment")
             for name in getattr(runner.model, f"get{of}Ids")()]
    runner.timeCourseSelections = ["time", *names]
    values = np.array(runner.simulate(times=times_of(options).tolist()))
    return {name: values[1::2, i + 1] for i, name in enumerate(names)}


def myriads(file, options, names):
    """Myriad's values at the samples, by the same names, and what was given beside the file."""
    model, times = my.read_sbml(file), times_of(options)
    unset = without_value(file, model)
    run = first_that_ends(model, options.methods, time=(0.0, times[-1]), samples=times, rtol=options.rtol,
                          atol=options.atol, maximum_step=options.end / (options.samples - 1),
                          time_limit=options.time_limit, start=dict.fromkeys(unset, 0.0))
    return ({name: values for name in names if (values := values_of(run, model, name, names)) is not None},
            f"with 0 for {quoted(unset)}, which the file has no value of" if unset else "")


def without_value(file, model):
    """The species of a file that are states of the model without an initial value."""
    document = libsbml.readSBML(str(file))  # which owns the species
    species = {s.getId() for s in document.getModel().getListOfSpecies()}
    return [name for name in model.states if name.removesuffix("_amount") in species and name not in model.defaults]


def values_of(run, model, name, names):
    """A variable's values at the samples that are compared; None where Myriad has no such variable, as the parameters
    that libRoadRunner makes of stoichiometries, or the file has no value of it and nothing reads it."""
    if f"{name}_amount" in run and f"{name}_amount" not in names:
        name = f"{name}_amount"
    kind = next((kind for kind in ("state", "parameter") if name in names_of(model)[kind]), None)
    if kind is None and name not in run:
        return None
    values = run[symbol(kind, name) if kind else name]
    if np.isnan(values).all() and any(c.value[1] in (name, name.removesuffix("_amount")) and np.isnan(v)
                                      for c, v in model.constants.items()):
        return None
    return (values[0] if values.ndim == 2 else np.full(run.t_sample.shape[1], values[0]))[1::2]


def reference_of(file, options):
    """libRoadRunner's values, or those that are kept of an earlier run with the same file and options."""
    kept = None
    if options.keep:
        key = (file.read_bytes(), times_of(options).tobytes(), repr((options.rtol, options.atol)).encode())
        name = hashlib.sha256(b"".join(key)).hexdigest()
        kept = options.keep / f"{name[:32]}.pickle"
        if kept.exists():
            return pickle.loads(kept.read_bytes())
    found = within(options.time_limit, roadrunners, file, options)
    if kept:
        kept.write_bytes(pickle.dumps(found))
    return found


def outcome_of(file, options):
    """(outcome, why) of a model."""
    what, reference = reference_of(file, options)
    if what == "value" and not any(np.isfinite(values).any() for values in reference.values()):
        what, reference = "failed", "NaN"
    names = [*reference] if what == "value" else []
    longest = (len(options.methods.split(",")) + 1) * options.time_limit
    ended, found = within(longest, myriads, file, options, names)
    if ended != "value":
        ended = "neither" if ended == what == "failed" else ended
        return ended, found + ("" if names else f" (libRoadRunner: {' '.join(reference.split())[:100]})")
    if not names:
        return "no reference", f"libRoadRunner: {' '.join(reference.split())[:300]}"
    found, given = found
    difference = difference_of(reference, found, times_of(options)[1::2])
    if not difference:
        return "right", given
    finer = argparse.Namespace(**vars(options))
    finer.rtol, finer.atol = 1e-3 * options.rtol, 1e-4 * options.atol
    what, finer_reference = reference_of(file, finer)
    ended, finer_found = within(longest, myriads, file, finer, names)
    if what == ended == "value" and not difference_of(finer_reference, finer_found[0], times_of(options)[1::2]):
        return "right", f"with smaller tolerances; else {difference}" + (given and f"; {given}")
    if what != "value" or difference_of(finer_reference, reference, times_of(options)[1::2]):
        return "undecided", difference
    return "wrong", difference


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0], epilog=__doc__.split("\n\n", 1)[1],
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, metavar="FOLDER")
    add_options(parser, time_limit=20.0)
    parser.add_argument("--end", type=float, default=100.0, help="of the time (100)")
    parser.add_argument("--samples", type=int, default=101, help="at equal distances (101)")
    parser.add_argument("--rtol", type=float, default=1e-8, help="of Myriad; libRoadRunner's is a tenth (1e-8)")
    parser.add_argument("--atol", type=float, default=1e-14, help="of both (1e-14)")
    parser.add_argument("--methods", default="rodas_5p,dormand_prince_5,cash_karp",
                        help="of integration, each where those before it fail (rodas_5p,dormand_prince_5,cash_karp)")
    parser.add_argument("--keep", type=Path, metavar="FOLDER", help="keeps libRoadRunner's values for further runs")
    options = parser.parse_args()
    if options.keep:
        options.keep.mkdir(parents=True, exist_ok=True)
    files = chosen(files_of(options.folder), options)
    if not files:
        parser.error(f"{options.folder} has no such models")
    counts = tried(files, options, outcomes, outcome_of)
    return 1 if counts["wrong"] + counts["failed"] else 0


if __name__ == "__main__":
    sys.exit(main())
