#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Times ensembles of models in files of SBML, and compares them with libRoadRunner and AMICI where they are installed.

FOLDER has the files. An instance has each parameter of its file, but for those of kinetic laws, multiplied by a random
number, the largest `--spread` times the smallest, and is integrated to the end with 100 equidistant outputs.
libRoadRunner (CVODE, the same tolerances) solves the first instances of the same ensemble, one after the other on one
core, and only its calls of `simulate` are timed; so does AMICI (CVODES), whose model is compiled first. Times are the
fastest of several calls: of a core on CPUs, where other work then matters less, and by the clock on GPUs. Errors are
relative to the largest value of each species in each instance, against libRoadRunner, or else Myriad, with a relative
tolerance of 1e-11; the median and the largest of the instances are told.

Writes rows "model,species,instances,device,program,milliseconds per instance,median error,largest error,kernel ms";
AMICI has there, for all its instances, the milliseconds of its solver. It needs SWIG on the PATH.
Nothing is downloaded: benchmarks/README.md says where the published models are from."""

import argparse
import importlib.util
import multiprocessing
import sys
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np

import myriad_ode as my
from myriad_ode.formats.sbml.document import read


def swept(model):
    """The constants that differ between instances, which libRoadRunner knows by the same ids, the species, those that
    are amounts, and those that rules set."""
    document, file = read(model)
    set_by_events = {file.getEvent(e).getEventAssignment(i).getVariable() for e in range(file.getNumEvents())
                     for i in range(file.getEvent(e).getNumEventAssignments())}
    varied = {}
    for i in range(file.getNumParameters()):
        p = file.getParameter(i)
        is_set = file.getRuleByVariable(p.getId()) or file.getInitialAssignmentBySymbol(p.getId())
        if p.isSetValue() and p.getValue() and not is_set and p.getId() not in set_by_events:
            varied[p.getId()] = p.getValue()
    names = [file.getSpecies(i).getId() for i in range(file.getNumSpecies())]
    amounts = {file.getSpecies(i).getId() for i in range(file.getNumSpecies())
               if file.getSpecies(i).getHasOnlySubstanceUnits()}
    return varied, names, amounts, {name for name in names if file.getAssignmentRuleByVariable(name)}


def by_roadrunner(path, ensemble, start, names, amounts, end, tolerance, count, calls=1):
    """(seconds, values) of the first instances: values[instance, output, species]."""
    import roadrunner

    roadrunner.Logger.setLevel(roadrunner.Logger.LOG_FATAL)
    runner = roadrunner.RoadRunner(str(path))
    runner.timeCourseSelections = [name if name in amounts else f"[{name}]" for name in names]
    integrator = runner.integrator
    integrator.relative_tolerance, integrator.absolute_tolerance = tolerance
    integrator.maximum_num_steps = 1_000_000
    floating = set(runner.model.getFloatingSpeciesIds())

    def start_of(i):
        runner.resetToOrigin()
        for name, column in ensemble.items():
            runner.model[name] = column[i]
        runner.reset()
        for name in names:  # those that follow from constants too
            if name in floating and name in start:
                runner.model[name if name in amounts else f"[{name}]"] = start[name][i]

    seconds, values = 0.0, []
    for i in range(count):
        fastest = np.inf
        for _ in range(calls):
            start_of(i)
            begin = time.process_time()
            found = np.array(runner.simulate(0, end, 100))
            fastest = min(fastest, time.process_time() - begin)
        seconds += fastest
        values.append(found)
    return seconds, np.array(values)


def by_amici(path, ensemble, names, end, tolerance, count, calls=1):
    """The same by AMICI, and the milliseconds that its solver says it took for all of them. Species are its states."""
    import amici
    import amici.sim.sundials
    from amici.importers.sbml import SbmlImporter

    with tempfile.TemporaryDirectory() as folder:
        SbmlImporter(str(path)).sbml2amici(f"amici_{path.stem}", folder, generate_sensitivity_code=False)
        model = amici.import_model_module(f"amici_{path.stem}", folder).get_model()
    solver = model.create_solver()
    solver.set_relative_tolerance(tolerance[0])
    solver.set_absolute_tolerance(tolerance[1])
    solver.set_max_steps(1_000_000)
    model.set_timepoints(np.linspace(0, end, 100))
    states = list(model.get_state_ids())
    parameters, usual = list(model.get_free_parameter_ids()), np.array(model.get_free_parameters())
    seconds, in_solver, values = 0.0, 0.0, []
    for i in range(count):
        model.set_free_parameters([ensemble[p][i] if p in ensemble else value for p, value in zip(parameters, usual)])
        fastest = fastest_solver = np.inf
        for _ in range(calls):
            begin = time.process_time()
            found = amici.sim.sundials.run_simulation(model, solver)
            fastest, fastest_solver = min(fastest, time.process_time() - begin), min(fastest_solver, found.cpu_time)
        seconds, in_solver = seconds + fastest, in_solver + fastest_solver
        values.append(np.array(found.x)[:, [states.index(n) for n in names]])
    return seconds, np.array(values), in_solver


def errors(values, reference):
    """(median, largest) over instances of the largest error of any species."""
    scale = np.abs(reference).max(axis=1, keepdims=True)
    with np.errstate(invalid="ignore", divide="ignore"):
        relative = np.where(scale > 0, np.abs(values - reference) / scale, 0.0)
    of_instances = relative.max(axis=(1, 2))
    return float(np.median(of_instances)), float(of_instances.max())


def measure(path, options):
    """The rows of one model."""
    end = dict(options.ends).get(path.stem, 100.0)
    model = my.read_sbml(path)
    constants, names, amounts, by_rule = swept(path)
    constants = {n: v for n, v in constants.items() if model.aliases.get(n, n) in model.parameters}
    random = np.random.default_rng(1)
    ensemble = {n: v * options.spread ** random.uniform(-0.5, 0.5, options.instances) for n, v in constants.items()}
    tolerance = options.rtol, options.atol
    accurate = 1e-11, 1e-11 * options.atol / options.rtol

    def solve(count, rtol, atol):
        return my.solve(model, {n: v[:count] for n, v in ensemble.items()}, time=(0, end),
                        samples=np.linspace(0, end, 100), method=options.method, device=options.device, advice=False,
                        rtol=rtol, atol=atol, size=None if ensemble else count)

    begin = time.perf_counter()
    solve(2, *tolerance)
    print(f"{path.stem}: compiled in {time.perf_counter() - begin:.1f} s", file=sys.stderr)
    clock = time.perf_counter if options.device.startswith("cuda") else time.process_time
    best, kernel, run = np.inf, np.inf, None
    for _ in range(options.calls):
        begin = clock()
        run = solve(options.instances, *tolerance)
        best = min(best, clock() - begin)
        kernel = min(kernel, run.report.kernel_seconds or run.report.seconds)
    compared = min(options.compared, options.instances)
    names = [n for n in names if n in run and np.ndim(run[n]) == 2]

    def of_species(run):
        return np.stack([run[n][:compared] for n in names], axis=2)

    has_peer = importlib.util.find_spec("roadrunner") is not None
    if has_peer:
        start = {n: run[n][:compared, 0] for n in names if n not in by_rule}
        arguments = path, ensemble, start, names, amounts, end
        _, reference = by_roadrunner(*arguments, accurate, compared)
        seconds, theirs = by_roadrunner(*arguments, tolerance, compared, options.calls)
    else:
        reference = of_species(solve(compared, *accurate))
    rows = [("Myriad", options.device, options.instances, best, errors(of_species(run), reference), 1e3 * kernel)]
    if has_peer:
        rows.append(("libRoadRunner", "cpu:1", compared, seconds, errors(theirs, reference), ""))
        print(f"{path.stem}: {seconds / compared * options.instances / best:.1f} times as fast as libRoadRunner; "
              f"{run.report}", file=sys.stderr)
    if importlib.util.find_spec("amici") is not None:
        # in a process of its own, as its bindings and libRoadRunner's are mixed up in one
        with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as pool:
            seconds, theirs, in_solver = pool.submit(by_amici, path, ensemble, names, end, tolerance, compared,
                                                     options.calls).result()
        rows.append(("AMICI", "cpu:1", compared, seconds, errors(theirs, reference), in_solver))
        factor = options.instances / best / compared
        print(f"{path.stem}: {seconds * factor:.1f} times as fast as AMICI, {1e-3 * in_solver * factor:.1f} times as "
              "its solver alone", file=sys.stderr)
    for program, device, count, seconds, error, in_kernel in rows:
        yield path.stem, len(names), count, device, program, 1e3 * seconds / count, *error, in_kernel
    if run.failed.any():
        print(f"{path.stem}: {int(run.failed.sum())} instances failed", file=sys.stderr)


def named_number(text):
    """NAME=NUMBER."""
    name, _, number = text.partition("=")
    return name, float(number)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, metavar="FOLDER")
    parser.add_argument("--models", help="some files alone, by their names without .xml, separated by commas")
    parser.add_argument("--end", dest="ends", type=named_number, action="append", default=[], metavar="MODEL=TIME",
                        help="when a model ends (100); may be repeated")
    parser.add_argument("--instances", type=int, default=1000)
    parser.add_argument("--spread", type=float, default=2.0, help="largest factor of a parameter over the smallest (2)")
    parser.add_argument("--compared", type=int, default=20, help="instances with known errors, libRoadRunner's (20)")
    parser.add_argument("--rtol", type=float, default=1e-6)
    parser.add_argument("--atol", type=float, default=1e-6)
    parser.add_argument("--method", default="rodas_5p")
    parser.add_argument("--device", default="cpu:1", help="as of my.solve (cpu:1: one core, as libRoadRunner has)")
    parser.add_argument("--calls", type=int, default=3, help="of which the fastest counts (3)")
    options = parser.parse_args()
    wanted = options.models.split(",") if options.models else None
    print("model,species,instances,device,program,milliseconds per instance,median error,largest error,kernel ms")
    for path in sorted(options.folder.glob("*.xml")):
        if wanted is None or path.stem in wanted:
            for row in measure(path, options):
                print(",".join(f"{v:.4g}" if isinstance(v, float) else str(v) for v in row), flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
