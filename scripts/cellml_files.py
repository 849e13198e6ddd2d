#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Reads all files of CellML in a folder, compares their equations with Myokit's, and integrates them.

FOLDER has files *.cellml, in folders below too; nothing is fetched. A file is "same" where the derivatives at six
states near the initial one, and the computed variables at the start, are those of Myokit's own importer and evaluation,
to 1e-10 or to what a rounding of states and constants changes; "differs" where they are not; "alone" where Myokit does
not read or evaluate it; "refused" where read_cellml says that it does not support something; "failed" where the
integration does not end. Needs libcellml, and myokit to compare.

    scripts/cellml_files.py FOLDER [--seconds 1] [--method rodas_5p]
"""

from __future__ import annotations

import argparse
import collections
import time
import warnings
from pathlib import Path

import numpy as np

import myriad_ode as my
from myriad_ode.symbolic import symbols as sym
from myriad_ode.symbolic.evaluate import evaluate

try:
    import myokit.formats
except ImportError:
    myokit = None

rounding = 3e-16


def values_near(model, start, t):
    """The derivatives and outputs by name at some values."""
    known = {sym.time: t, **{sym.symbol("state", n): start[n] for n in model.states},
             **{sym.symbol("parameter", n): start[n] for n in model.parameters}}
    wanted = [*model.equations.values(), *model.outputs.values()]
    names = [*(f"{s.value[1]}'" for s in model.equations), *model.outputs]
    return dict(zip(names, evaluate(wanted, known)))


def differing(model, path):
    """What differs from Myokit's values; None if it has none."""
    other = myokit.formats.importer("cellml").model(str(path))
    random, start = np.random.default_rng(1), model.start()
    called = {v.qname(): model.aliases[v.qname()] for v in other.variables() if v.qname() in model.aliases}
    found = [n for n, v in zip(other.states(), other.initial_values(as_floats=True))
             if not np.isclose(start[called[n.qname()]], v, rtol=1e-13, atol=0)]
    for i, t in enumerate([0, 0.3, 2.5, 101, 17.3, 250.7]):
        near = {n: v * (1 + (0.02 * random.standard_normal() if i and n in model.states else 0))
                for n, v in start.items()}
        state = [near[called[s.qname()]] for s in other.states()]
        theirs = dict(zip((f"{called[s.qname()]}'" for s in other.states()), other.evaluate_derivatives(
            state=state, inputs={"time": t}, ignore_errors=True)))
        if other.binding("time") is not None and i == 0:
            other.binding("time").set_rhs(0)
            theirs |= {called[v.qname()]: v.eval() for v in other.variables(const=False, state=False, deep=True)
                       if v.qname() in called and v.binding() is None}
        ours, change = values_near(model, near, t), collections.Counter()
        for _ in range(4):
            moved = values_near(model, {n: v * (1 + rounding * random.integers(-1, 2)) for n, v in near.items()}, t)
            change = {n: np.fmax(change[n] if n in change else 0, abs(v - ours[n])) for n, v in moved.items()}
        scale = np.nanmax([abs(v) for v in theirs.values()] or [1])
        found += [f"{n} at t={t}: {ours[n]:g} and {v:g}" for n, v in theirs.items() if n in ours and not (
            abs(ours[n] - v) <= max(1e-10 * abs(v), 30 * change[n], 1e-22 * scale))]
    return found


def result(path, options):
    """(verdict, model, what there is to say)"""
    try:
        model = my.read_cellml(path)
    except my.Error as why:
        return "refused", None, str(why)
    length = options.seconds / {"ms": 1e-3, "µs": 1e-6, "min": 60, "h": 3600, "d": 86400}.get(model.time_unit, 1)
    run = my.solve(model, time=(0, length), method=options.method, rtol=1e-6, atol=1e-9, interpreted=True)
    if set(run.report.by_status) != {"success"}:
        return "failed", model, str(run.report)
    if myokit is None:
        return "alone", model, "Myokit is not installed"
    try:
        found = differing(model, path)
    except Exception as why:
        return "alone", model, f"Myokit: {type(why).__name__}: {why}"
    return ("differs" if found else "same"), model, "; ".join(map(str, found[:3]))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--seconds", type=float, default=1, help="how long to integrate, in the file's time (1)")
    parser.add_argument("--method", default="rodas_5p")
    options, count = parser.parse_args(), collections.Counter()
    warnings.simplefilter("ignore")
    np.seterr(all="ignore")
    print("| file | states | verdict | seconds | |\n|---|---|---|---|---|")
    for path in sorted(options.folder.rglob("*.cellml")):
        start = time.perf_counter()
        verdict, model, said = result(path, options)
        count[verdict] += 1
        states = "" if model is None else len(model.states)
        print(f"| {path.stem} | {states} | {verdict} | {time.perf_counter() - start:.2f} | {said[:300]} |", flush=True)
    print(", ".join(f"{n} {verdict}" for verdict, n in count.most_common()))


if __name__ == "__main__":
    main()
