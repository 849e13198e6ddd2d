#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Reads and simulates a collection of .ode files beside XPPAUT.

FOLDER has files *.ode, in folders below too; nothing is fetched. Each is read by read_xpp, interpreted to its own
`total`, or to --end where that is sooner, and states and auxiliary quantities are compared with XPPAUT's (`apt install
xppaut`), run with steps and tolerances so small that two of its runs agree. A file is "right" where all values are
within 1e-4 of XPPAUT's, plus 1e-5 of the largest value of the variable (XPPAUT stores values in single precision);
"right so far" where this holds as long as XPPAUT agrees with itself, at least for a tenth of the time, as in chaos
(models with algebraic equations are compiled, and compared after the start, where XPPAUT has not solved them yet);
"refused" where Myriad says that it does not support something; "wrong" where a value is not within that; "undecided"
where XPPAUT does not agree with itself; "not compared" where it has noise, or delays without --delays; "failed"
where it ends otherwise; "time limit" where it takes too long; and "no reference" where XPPAUT does not end. Both
programs run in processes of their own. The exit status is 1 if a model is wrong or failed.
"""

import argparse
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

import myriad_ode as my
from myriad_ode.formats.xpp.ode_file import OdeFile
from myriad_ode.symbolic.symbols import symbol

from model_files import add_options, chosen, difference_of, errors_of, first_that_ends, tried, within

outcomes = ("right", "right so far", "refused", "wrong", "undecided", "not compared", "failed", "time limit",
            "no reference")
samples = 197

# XPPAUT's runs, method, parts of a step of the file's `dt`, and tolerance: two beside each other are to agree
fixed = [("rk4", 8, 1e-6), ("rk4", 32, 1e-6), ("rk4", 128, 1e-6)]
adaptive = [("8", 1, 1e-9), ("8", 4, 1e-11), ("cvode", 1, 1e-8), ("cvode", 4, 1e-10)]


def text_for(file, end, dt, method, parts, tolerance):
    """The text of a file with other options of integration; of one that is given twice the last holds."""
    every = end / samples
    count = max(1, int(np.ceil(every / dt * parts)))
    ours = (f"@ total={end!r},dt={every / count!r},nout={count},meth={method},tol={tolerance},atol={tolerance},"
            "bound=1e12,maxstor=1000000,trans=0,poimap=0,range=0,dtmin=1e-14")
    text = re.sub(r"(?im)^[ \t]*(set|only)[ \t](.*\\\n)*.*$", "", file.read_text(errors="replace"))  # sets are runs
    # XPPAUT 6.11 takes a residual below 1e-3 for zero, whatever newt_tol is
    text = re.sub(r"(?m)^([ \t]*0[ \t]*=)([^=\n].*)$", r"\g<1>1e9*(\2)", text)
    lines = re.sub(r"(?i)\bfold\s*=\s*[^\s,]*", "", text).splitlines()
    done = next((i for i, line in enumerate(lines) if re.fullmatch(r"(?i)\s*d\w*\s*", line)), len(lines))
    return "\n".join([*lines[:done], ours, "done", ""])


def xppauts(file, end, dt, names, run, seconds):
    """XPPAUT's values at the samples by name, with "t", by one of its runs; None where it has none."""
    with tempfile.TemporaryDirectory() as folder:
        for other in file.parent.iterdir():  # tables of the file
            if other != file:
                (Path(folder) / other.name).symlink_to(other)
        (Path(folder) / file.name).write_text(text_for(file, end, dt, *run))
        try:
            subprocess.run(["xppaut", file.name, "-silent", "-outfile", "xpp_files.out"], cwd=folder,
                           timeout=seconds, stdin=subprocess.DEVNULL, capture_output=True)
            values = np.loadtxt(Path(folder) / "xpp_files.out", ndmin=2)
        except (subprocess.TimeoutExpired, OSError, ValueError):
            return None
    if values.shape[1:] != (len(names) + 1,):
        return None
    place = (values[:, 0] - values[0, 0]) * samples / end  # some methods write every step
    values = values[np.abs(place - np.round(place)) < 1e-3]
    return dict(zip(["t", *names], values.T))


def names_in(file):
    """Names of states and auxiliary quantities in XPPAUT's order."""
    parts = OdeFile(file.read_text(errors="replace"), file.parent).parts
    return [*parts.equations], [*parts.outputs]


def domain_of(file, options):
    """(begin, length, dt, names of states, names of outputs, whether there are noise, delays, algebraic equations)"""
    model = my.read_xpp(file)
    begin, end = model.time
    return (begin, min(end - begin, options.end), abs(model.settings.get("dt", 0.05)), *names_in(file),
            bool(model.noise), bool(model.history_of_outputs), model.mass_matrix is not None)


def myriads(file, options, states, outputs, times, rtol):
    """Myriad's values at the samples by name."""
    model = my.read_xpp(file)
    has_mass = model.mass_matrix is not None
    run = first_that_ends(model, "rodas_5p" if has_mass else options.methods, make_consistent=has_mass,
                          time=(times[0], times[-1]), samples=times, rtol=rtol, atol=1e-3 * rtol,
                          maximum_step=(times[-1] - times[0]) / samples, time_limit=options.time_limit,
                          interpreted=not (has_mass or model.history_of_outputs))
    of = {n: run[symbol("state", model.aliases.get(n, n))] for n in states} | {n: run[n] for n in outputs}
    return {n: v[0] if np.ndim(v) == 2 else np.full(len(times), v[0]) for n, v in of.items()}


def allowed(expected, got):
    """Errors in units of what is allowed. Nothing below 1e-8 counts, as of a residual of algebraic equations."""
    expected, got = (np.where(np.abs(values) < 1e-8, 0.0, values) for values in (expected, got))
    return errors_of(expected, got, of_largest=1e-5)


def agreeing(one, other, times):
    """For how many samples two of XPPAUT's runs agree to a third of what is allowed, and are at the times."""
    count = min(len(one["t"]), len(other["t"]), len(times))
    errors = [allowed(one[n][:count], other[n][:count]) for n in one] + [allowed(times[:count], other["t"][:count])]
    return int(np.argmax([*(np.max(errors, axis=0) > 1 / 3), True]))


def reference_of(file, times, dt, names, has_delays, options):
    """XPPAUT's values, for how many samples they are sure, and how many there are; None where it has none."""
    best = None
    for runs in (fixed,) if has_delays else (fixed, adaptive[:2], adaptive[2:]):
        before = None
        for run in runs:
            now = xppauts(file, float(times[-1] - times[0]), dt, names, run, options.time_limit)
            if now is not None and before is not None:
                sure = agreeing(before, now, times)
                if best is None or sure > best[1]:
                    best = now, sure
            if best and best[1] > samples:
                return best
            if now is None and before is not None:
                break
            before = now
    return best


def outcome_of(file, options):
    """(outcome, why) of a file."""
    what, found = within(options.time_limit, domain_of, file, options, refusals=my.Error)
    if what != "value":
        return what, found
    begin, length, dt, states, outputs, noise, has_delays, has_mass = found
    if noise or has_delays and not options.delays:
        return "not compared", "noise" if noise else "delays"
    times = begin + np.linspace(0, length, samples + 1)
    reference = reference_of(file, times, dt, [*states, *outputs], has_delays, options)
    if reference is None:
        seconds = 2 * options.time_limit + 100 * has_mass
        ended, found = within(seconds, myriads, file, options, states, outputs, times, 1e-8)
        return "no reference", "" if ended == "value" else f"{ended}: {found}"
    values, sure = reference
    if sure < max(2, samples // 10):
        return "undecided", f"XPPAUT agrees with itself until {times[max(sure, 1) - 1]:g} of {begin + length:g}"
    times = times[:sure]
    for rtol in (1e-8, 1e-11):
        seconds = 2 * options.time_limit + 100 * (has_delays or has_mass)
        ended, found = within(seconds, myriads, file, options, states, outputs, times, rtol)
        first = int(has_mass)  # at the start XPPAUT has the guess of what solves algebraic equations
        difference = ended == "value" and difference_of(
            {n: values[n][first:sure] for n in found}, {n: v[first:] for n, v in found.items()}, times[first:], allowed)
        if difference == "":
            if sure > samples:
                return "right", f"to {times[-1]:g}"
            return "right so far", f"until {times[-1]:g} of {begin + length:g}"
    return (ended, found) if ended != "value" else ("wrong", difference)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0], epilog=__doc__.split("\n\n", 1)[1],
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, metavar="FOLDER")
    add_options(parser, time_limit=10.0)
    parser.add_argument("--delays", action="store_true", help="compare models with delays, too")
    parser.add_argument("--end", type=float, default=100.0, help="the longest time (100)")
    parser.add_argument("--methods", default="dormand_prince_5,rodas_5p",
                        help="of integration, each where those before it fail (dormand_prince_5,rodas_5p)")
    options = parser.parse_args()
    if not shutil.which("xppaut"):
        parser.error("there is no program xppaut")
    files = chosen(sorted(options.folder.rglob("*.ode"), key=lambda f: (f.stat().st_size, f)), options)
    if not files:
        parser.error(f"{options.folder} has no such files")
    counts = tried(files, options, outcomes, outcome_of)
    return 1 if counts["wrong"] + counts["failed"] else 0


if __name__ == "__main__":
    sys.exit(main())
