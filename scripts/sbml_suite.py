#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs the semantic test suite of SBML, or models in its format, and says which cases are right.

FOLDER has a folder for each case, as cases/semantic of https://github.com/sbmlteam/sbml-test-suite: a model, the
settings of its simulation and the values expected. A case is "right" where all values are within the tolerances of its
settings, "refused" where read_sbml says that it does not support something, "wrong" where a value is not within them,
and "failed" where something else goes wrong. The exit status is 1 if a case is wrong or failed.

For a GPU the processes compile the models, and as many threads of one process integrate them: what several processes
run on a GPU takes turns there, each with one instance, and what one process runs does not.
"""

import argparse
import collections
import concurrent.futures
import contextlib
import csv
import math
import multiprocessing
import os
import re
import sys
import time
from pathlib import Path

import numpy as np

import myriad_ode as my
from myriad_ode.base import component_kinds as kinds
from myriad_ode.kernels import nvrtc
from myriad_ode.base.errors import CannotInterpret
from myriad_ode.models.any_model import names_of
from myriad_ode.models.methods import method_type
from myriad_ode.models.once_per_phase import prepared
from myriad_ode.formats.sbml.math import Refused

outcomes = ("right", "refused", "wrong", "failed")


def settings_of(folder):
    """The settings of a case, as lists of words."""
    text = next(folder.glob("*-settings.txt")).read_text()
    pairs = (line.partition(":") for line in text.splitlines() if ":" in line)
    return {key.strip(): [w for w in re.split(r"[,\s]+", value.strip()) if w] for key, _, value in pairs}


def description_of(folder, *keys):
    """The entries of a case's description under some keys, each once."""
    found = []
    for description in folder.glob("*-model.m"):
        for line in description.read_text(errors="replace").splitlines():
            if line.partition(":")[0].strip() in keys:
                found += [w.strip() for w in line.partition(":")[2].split(",") if w.strip()]
    return sorted(set(found))


def models_of(folder, every):
    """The models of a case, that of the highest level first: the same model in each level and version in which it means
    the same."""
    files = sorted(folder.glob("*-sbml-l?v?.xml"), key=lambda p: p.name, reverse=True)
    levels = description_of(folder, "levels")
    files = [f for f in files if not levels or re.sub(r".*-l(\d)v(\d).xml", r"\1.\2", f.name) in levels]
    return files if every else files[:1]


def expected_of(folder):
    """The columns of the expected results."""
    with open(next(folder.glob("*-results.csv")), newline="") as file:
        rows = [[cell.strip() for cell in row] for row in csv.reader(file) if any(cell.strip() for cell in row)]
    return rows[0], np.array([[float(cell) for cell in row] for row in rows[1:]])


def values_of(run, name, settings):
    """A variable's values at the samples."""
    for kind in ("amount", "concentration"):
        if name in settings.get(kind, ()):
            name = next((n for n in (f"{name}_{kind}",) if n in run), name)
    values = run[name]
    return values[0] if values.ndim == 2 else np.full(run.t_sample.shape[1], values[0])


def largest_error(expected, got, absolute, relative):
    """The largest error in units of what the settings allow; not above 1 if all is right."""
    with np.errstate(all="ignore"):
        errors = np.abs(expected - got) / (absolute + relative * np.abs(expected))
    same = (expected == got) | (np.isnan(expected) & np.isnan(got))
    return float(np.max(np.where(same, 0.0, np.where(np.isfinite(errors), errors, np.inf)), initial=0.0))


def solved(model, settings, times, options):
    """The run of a model to the times of its results."""
    absolute, relative = (float(settings[key][0]) for key in ("absolute", "relative"))
    arguments = dict(time=(0.0, float(times[-1])), samples=times, rtol=1e-5 * relative, atol=1e-4 * absolute,
                     maximum_step=float(times[1] - times[0]), max_steps=10_000_000, device=options.device, advice=False,
                     time_limit=options.time_limit, method=options.method)
    if options.device.startswith("cpu") and not options.compiled:
        try:
            return my.solve(model, interpreted=True, **arguments)
        except CannotInterpret:
            pass
    return my.solve(model, **arguments)


def outcome_of(folder, file, options):
    """(outcome, why) of a case."""
    settings = settings_of(folder)
    if not settings.get("duration"):
        return "refused", "a steady state of flux balance"
    try:
        model = my.read_sbml(file)
        header, expected = expected_of(folder)
        run = solved(model, settings, expected[:, 0], options)
        if run.failed.any():
            return "failed", f"ended as {run.status[0]}"
        absolute, relative = (float(settings[key][0]) for key in ("absolute", "relative"))
        errors = {name: largest_error(expected[:, column], values_of(run, name, settings), absolute, relative)
                  for column, name in enumerate(header) if column}
    except Refused as error:
        return "refused", str(error)
    except Exception as error:
        return "failed", f"{type(error).__name__}: {error}"
    wrong = {name: error for name, error in errors.items() if not error <= 1}
    if wrong:
        return "wrong", ", ".join(f"{name}: {error:.3g} times what is allowed" for name, error in wrong.items())
    return "right", f"{max(errors.values(), default=0.0):.2g} of what is allowed"


@contextlib.contextmanager
def without_libsbmls_messages():
    """libsbml writes to the standard error."""
    kept, nothing = os.dup(2), os.open(os.devnull, os.O_WRONLY)
    os.dup2(nothing, 2)
    try:
        yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)
        os.close(nothing)


def check(folder, options):
    """[(name of the file, outcome, why, seconds)] of a case."""
    def clock():  # seconds of a core, those of a compiler too
        return time.thread_time() if options.on_gpu else sum(os.times()[:4])

    found = []
    for file in models_of(folder, options.all_levels):
        begin = clock()
        late = time.time() > options.latest
        outcome, why = ("failed", "not begun in time") if late else outcome_of(folder, file, options)
        found.append((file.name, outcome, why, clock() - begin))
    return found


def check_quietly(folder, options):
    """The same in a process of its own."""
    with without_libsbmls_messages():
        return check(folder, options)


def compile_for_gpu(folder, options):
    """Compiles the models of a case into the cache, and returns the seconds of a core that it took. What fails does so
    again where the case is checked."""
    begin = time.process_time()
    with without_libsbmls_messages():
        for file in models_of(folder, options.all_levels):
            if time.time() > options.latest:
                break
            with contextlib.suppress(my.Error):
                model = prepared(my.read_sbml(file))
                names = names_of(model)
                nvrtc.prepare(*model.source(), method_type(options.method, (), True), "double",
                              tuple(len(names[kind]) for kind in kinds.shared),
                              int(options.device.partition(":")[2] or 0))
    return time.process_time() - begin


def check_on_gpu(folders, options):
    """What `check` finds of all cases: each is integrated as soon as it is compiled."""
    spawned = multiprocessing.get_context("spawn")  # a forked process cannot use the GPU
    with (without_libsbmls_messages(), concurrent.futures.ProcessPoolExecutor(options.processes, spawned) as compilers,
          concurrent.futures.ThreadPoolExecutor(options.processes) as threads):
        compiled = [compilers.submit(compile_for_gpu, folder, options) for folder in folders]

        def check_compiled(folder, seconds):
            took = seconds.result()
            return [(*found, of_check + took) for *found, of_check in check(folder, options)]

        return list(threads.map(check_compiled, folders, compiled))


def table(rows):
    """Text of rows of equal length, as a table of Markdown."""
    heading, *rest = rows
    lines = ["| " + " | ".join(map(str, heading)) + " |", "|" + "---|" * len(heading)]
    return "\n".join(lines + ["| " + " | ".join(map(str, row)) + " |" for row in rest])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0], epilog=__doc__.split("\n\n", 1)[1],
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, metavar="FOLDER")
    parser.add_argument("--device", default="cpu:1", help="as of my.solve (cpu:1)")
    parser.add_argument("--processes", type=int, default=os.cpu_count(), help="that work at the same time")
    parser.add_argument("--compiled", action="store_true", help="compile the models instead of interpreting them")
    parser.add_argument("--method", default="dormand_prince_5", help="of integration (dormand_prince_5)")
    parser.add_argument("--all-levels", action="store_true", help="check all levels and versions of each model")
    parser.add_argument("--cases", help="some cases alone, as in 00001,00007")
    parser.add_argument("--part", default="1/1", help="one part of several, as in 2/3: compiling all takes long")
    parser.add_argument("--without-tags", default="", help="leave out cases with one of these tags")
    parser.add_argument("--with-tags", default="", help="only cases with one of these tags")
    parser.add_argument("--time-limit", type=float, default=60.0, help="seconds for each model")
    parser.add_argument("--within", type=float, default=math.inf, metavar="SECONDS", help="begin no model after that")
    parser.add_argument("--details", action="store_true", help="say why cases are not right")
    options = parser.parse_args()
    options.on_gpu = options.device.startswith("cuda")
    folders = sorted(p for p in options.folder.iterdir() if p.is_dir() and any(p.glob("*-settings.txt")))
    if options.cases:
        folders = [p for p in folders if p.name in options.cases.split(",")]
    tags = {p.name: description_of(p, "componentTags", "testTags", "packagesPresent") for p in folders}
    only, without = (set(t for t in x.split(",") if t) for x in (options.with_tags, options.without_tags))
    folders = [p for p in folders if not without & set(tags[p.name]) and (not only or only & set(tags[p.name]))]
    part, parts = map(int, options.part.split("/"))
    folders = folders[part - 1::parts]
    if not folders:
        parser.error(f"{options.folder} has no such cases")
    begin, options.latest = time.perf_counter(), time.time() + options.within
    if options.on_gpu:
        found = check_on_gpu(folders, options)
    elif options.processes > 1:
        with concurrent.futures.ProcessPoolExecutor(options.processes) as pool:
            found = list(pool.map(check_quietly, folders, [options] * len(folders), chunksize=8))
    else:
        found = [check_quietly(folder, options) for folder in folders]
    seconds = time.perf_counter() - begin
    by_tag = collections.defaultdict(lambda: [0, 0, 0, 0, 0.0])
    for folder, files in zip(folders, found):
        for file, outcome, why, took in files:
            for tag in ("all", *tags[folder.name]):
                by_tag[tag][outcomes.index(outcome)] += 1
                by_tag[tag][4] += took
            if outcome in ("wrong", "failed") or options.details and outcome != "right":
                print(f"{file}: {outcome}: {why}", file=sys.stderr)
    rows = [(tag, *counts[:4], f"{counts[4]:.1f}") for tag, counts in
            sorted(by_tag.items(), key=lambda item: (item[0] != "all", item[0].lower()))]
    print(table([("tag", *outcomes, "seconds of a core"), *rows]))
    print(f"\n{seconds:.1f} s with {options.processes} processes")
    return 1 if by_tag["all"][2] + by_tag["all"][3] else 0


if __name__ == "__main__":
    sys.exit(main())
