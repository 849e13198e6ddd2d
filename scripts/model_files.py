# SPDX-License-Identifier: MIT
"""What the scripts that try collections of model files share: runs in processes of their own, differences, tables."""

import collections
import multiprocessing
import os
import re
import time

import numpy as np

from myriad_ode.base.errors import CannotInterpret, Error
from myriad_ode.formats.sbml.math import Refused

from sbml_suite import largest_error, table


def within(seconds, function, *arguments, refusals=(Refused, CannotInterpret)):
    """What a function gives in a process of its own: (what, value), where what is "value", "refused", "failed" or
    "time limit"."""
    def work(end):
        for stream in (1, 2):  # where libraries write
            os.dup2(os.open(os.devnull, os.O_WRONLY), stream)
        try:
            found = "value", function(*arguments)
        except refusals as error:
            found = "refused", str(error)
        except TimeoutError:
            found = "time limit", f"{seconds:g} s"
        except Exception as error:
            found = "failed", f"{type(error).__name__}: {error}"
        end.send(found)

    forked = multiprocessing.get_context("fork")
    mine, its = forked.Pipe(duplex=False)
    process = forked.Process(target=work, args=(its,))
    process.start()
    its.close()
    try:
        found = mine.recv() if mine.poll(seconds) else ("time limit", f"{seconds:g} s")
    except EOFError:
        process.join()
        found = "failed", f"the process ended as {process.exitcode}"
    process.kill()
    process.join()
    return found


def first_that_ends(model, methods, interpreted=True, **arguments):
    """The run by the first of several methods that integrates to the end."""
    import myriad_ode as my
    ends = []
    for method in methods.split(","):
        run = my.solve(model, interpreted=interpreted, device="cpu:1", advice=False, max_steps=10_000_000,
                       method=method, **arguments)
        if not run.failed.any():
            return run
        ends.append(str(run.status[0]))
    raise TimeoutError if set(ends) == {"interrupted"} else Error(f"ended as {', '.join(ends)}")


def errors_of(expected, got, relative=1e-4, of_largest=1e-7):
    """The errors at the samples in units of what is allowed: relative, plus a part of the largest value."""
    floor = of_largest * np.nanmax(np.abs(expected)) + 1e-12
    return np.array([largest_error(expected[i], got[i], floor, relative) for i in range(len(expected))])


def difference_of(reference, found, times, allowed=errors_of):
    """The first difference that is not allowed, as text; empty if there is none."""
    errors = {name: allowed(reference[name], found[name]) for name in found}
    wrong = [name for name in found if not errors[name].max() <= 1]
    if not wrong:
        return ""
    first = min(wrong, key=lambda name: (np.argmax(errors[name] > 1), -errors[name].max()))
    at = int(np.argmax(errors[first] > 1))
    return (f"{len(wrong)} of {len(found)}, {first} first: {found[first][at]:.9g} instead of "
            f"{reference[first][at]:.9g} at {times[at]:g}; at {sum(errors[first] > 1)} samples")


def kind_of(why):
    """A reason without the names, numbers and lines of one file."""
    why = re.sub(r"'[^']*'|`[^`]*`", "...", re.sub(r"line \d+, `.*?`: ", "", why))
    why = re.sub(r"\(line \d+\)|line \d+", "", why)
    return re.sub(r"\d[\d.e+-]*", "#", why)[:100]


def add_options(parser, time_limit):
    """Options that choose files and bound times."""
    parser.add_argument("--models", help="some alone, by parts of their paths, separated by commas")
    parser.add_argument("--part", default="1/1", help="one part of several, as in 2/10, spread over all sizes")
    parser.add_argument("--time-limit", type=float, default=time_limit,
                        help=f"seconds for each model and program ({time_limit:g})")
    parser.add_argument("--within", type=float, default=float("inf"), metavar="SECONDS",
                        help="begin no model after that")


def chosen(files, options):
    """The files of a run."""
    if options.models:
        files = [f for f in files if any(n in str(f.relative_to(options.folder)) for n in options.models.split(","))]
    part, parts = map(int, options.part.split("/"))
    return files[part - 1::parts]


def tried(files, options, outcomes, outcome_of):
    """Prints the outcome of each file and the tables; how often each outcome was had."""
    begin, counts, reasons = time.perf_counter(), collections.Counter(), collections.Counter()
    for file in files:
        start = time.perf_counter()
        if start - begin > options.within:
            outcome, why = "skipped", "not begun in time"
        else:
            outcome, why = outcome_of(file, options)
        print(f"{file.relative_to(options.folder)}: {outcome}: {why} ({time.perf_counter() - start:.1f} s)", flush=True)
        counts[outcome] += 1
        if not outcome.startswith("right"):
            reasons[outcome, "" if outcome in ("wrong", "undecided") else kind_of(why)] += 1
    print("\n" + table([("models", *outcomes), (len(files), *(counts[o] for o in outcomes))]))
    print("\n" + table([("outcome", "reason", "models"), *((*key, n) for key, n in reasons.most_common())]))
    print(f"\n{time.perf_counter() - begin:.0f} s")
    return counts
