#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the report of a validation run as Markdown, from the rows that the program `validate` has written.

Usage: report.py report.csv MARKDOWN [--images FOLDER] [--command TEXT]
FOLDER contains the pictures, relative to the Markdown file. Needs only Python's standard library.
"""
import argparse
import csv
import os

SHOWN = {  # measure: heading of the column
    "end state, worst": "end state", "event times": "event times", "accessories": "accessories", "samples": "samples",
    "invariants": "invariants"}
ORDERS = ["one step against published coefficients", "order", "error over its prediction by halved steps",
          "order of samples", "order of the error estimate", "exponent of the tolerance in the error"]


def read(path):
    with open(path, encoding="utf-8") as file:
        comments = []
        lines = []
        for line in file:
            (comments if line.startswith("# ") else lines).append(line)
    rows = list(csv.DictReader(lines))
    for row in rows:
        for name in ("setting", "value", "low", "high"):
            row[name] = float(row[name])
    return [c[2:].strip() for c in comments], rows


def short(value):
    if value != value:
        return "nan"
    if value == 0:
        return "0"
    return f"{value:.1e}" if abs(value) < 0.01 or abs(value) >= 1e4 else f"{value:.3g}"


def table(head, lines):
    def row(cells):
        return "| " + " | ".join(cells) + " |"
    return [row(head), "|" + "---|" * len(head), *map(row, lines), ""]


def worst_ratios(rows):
    """For each problem, method and precision, the largest ratio of error to bound over all tolerances, by measure."""
    found = {}
    for row in rows:
        if row["measure"] not in SHOWN or row["high"] in (float("inf"), 0):
            continue
        key = (row["problem"], row["method"], row["precision"])
        ratio = row["value"] / row["high"]
        before = found.setdefault(key, {}).get(row["measure"])
        if before is None or not ratio <= before:
            found[key][row["measure"]] = ratio
    return found


def bounds_of(row):
    """The bounds of a statistic as text; empty if it has no verdict."""
    if not row["verdict"]:
        return ""
    if row["low"] > float("-inf"):
        return f'{row["low"]:.5g} to {row["high"]:.5g}'
    return f'at most {short(row["high"])}'


def summary(comments, rows, command):
    """What was checked, and what was missed."""
    judged = [row for row in rows if row["verdict"]]
    missed = [row for row in judged if row["verdict"] != "within"]
    out = ["# Validation report", "", "<!-- Written by validation/report.py from report.csv; do not edit. -->", ""]
    outcome = f"{len(missed)} were missed" if missed else "all were kept"
    out += [f"**{len(judged)} bounds were checked; {outcome}.**", ""]
    out += [f"* {line}" for line in comments if not line.startswith("problem ")]
    if command:
        out += [f"* command: `{command}`"]
    out += ["",
            "Every method integrates ensembles of 64 or 65 instances of each problem. `report.csv` states the bounds "
            "and their reasons row by row; the references are described below.", ""]
    out += ["## The problems", ""] + [f"* {line[8:]}." for line in comments if line.startswith("problem ")] + [""]
    if missed:
        out += ["## Missed", ""] + table(
            ["problem", "method", "setting", "measure", "value", "bounds"],
            [[r["problem"], f'{r["method"]} {r["precision"]}', short(r["setting"]), r["measure"], short(r["value"]),
              f'{short(r["low"])} to {short(r["high"])}'] for r in missed])
    return out


def references(rows):
    """The references and their errors."""
    out = ["## The references and their errors", "",
           "CVODE (Adams; BDF for stiff problems) at a tolerance of 3e-14 per step, with the model's own right-hand "
           "side, root finding and a restart after each impact. An upper estimate of its error is the difference "
           "from a run at ten times the tolerance. Where a closed form or a value in quadruple precision is known, "
           "the error is measured, and that value is the reference instead. *Growth* is the largest factor by which "
           "an error of one step grows until the end, found by perturbing the solution at six times.", ""]
    problems = list(dict.fromkeys(r["problem"] for r in rows if r["method"] == "CVODE" and r["setting"] == 3e-14))

    def of_reference(problem, measure):
        values = [r["value"] for r in rows
                  if r["problem"] == problem and r["method"] == "CVODE" and r["measure"] == measure]
        return short(values[0]) if values else ""
    out += table(["problem", "growth, largest (median)", "CVODE against itself",
                  "CVODE against closed form or quadruple precision",
                  "its event times"],
                 [[p, f'{of_reference(p, "growth of errors, largest")} ({of_reference(p, "growth of errors, median")})',
                   of_reference(p, "reference against itself at ten times the tolerance"),
                   of_reference(p, "reference against closed form or quadruple precision"),
                   of_reference(p, "event times against closed form")] for p in problems])
    out += ["Where CVODE's difference from itself is not far below a method's error, CVODE is the limit: its error is "
            "part of the bound there.", ""]
    return out


def errors(rows, images):
    """The errors of all problems against their bounds."""
    out = ["## Errors against their bounds", "",
           "The bound, per instance, is growth x (accepted steps x (tolerance + rounding) + events x event tolerance) "
           "+ error of the reference. It holds however the errors of steps add up, so it is not tight; the orders "
           "below are. The table shows the largest ratio of error to bound over all instances and tolerances from "
           "1e-5 to 1e-11 (single precision: 1e-3 to 1e-5); a ratio below 1 keeps the bound. For fixed steps, the "
           "bound is twice the difference from steps half as long, plus rounding. Samples from the Hermite "
           "polynomial have no bound that follows from the tolerance.", ""]
    ratios = worst_ratios(rows)
    out += table(["problem", "method"] + list(SHOWN.values()),
                 [[key[0], key[1] + ("" if key[2] == "double" else " (float)")] +
                  [short(found[m]) if m in found else "" for m in SHOWN] for key, found in ratios.items()])
    counts = [r for r in rows if r["measure"] == "instances with other event counts"]
    out += [f"Numbers of events were compared in {len(counts)} runs of an ensemble; the number differs from the "
            f"reference's in {int(sum(r['value'] for r in counts))} instances.", ""]
    if images:
        out += [f"![Error against tolerance]({images}/tolerance.png)", "",
                "Median error of the end states against the tolerance; the dashed line is error = tolerance. "
                "The bouncing ball has no panel: every method integrates its parabolas exactly.", ""]
    return out


def orders(rows):
    """The orders of all methods."""
    out = ["## Orders: the tight checks", "",
           "With fixed steps, also for methods with step-size control; medians over the instances. *One step* is "
           "compared with the same step computed from published coefficients in 60 digits.", ""]
    lines = []
    for key in dict.fromkeys((r["problem"], r["method"]) for r in rows if r["measure"] in ORDERS):
        cells = []
        for measure in ORDERS:
            here = [r for r in rows if (r["problem"], r["method"], r["measure"]) == (*key, measure)]
            if not here:
                cells.append("")
            elif here[0]["low"] == float("-inf"):
                cells.append(short(here[0]["value"]))
            else:
                cells.append(f'{here[0]["value"]:.2f} [{here[0]["low"]:.3g}, {here[0]["high"]:.3g}]')
        lines.append([*key] + cells)
    out += table(["problem", "method", "one step: error", "order", "error / predicted", "order of samples",
                  "order of estimate",
                  "error ~ tolerance^"], lines)
    return out


def chaotic(rows):
    """The statistics of chaotic solutions, if there are any."""
    chaos = [r for r in rows if "chaotic" in r["problem"] or "28" in r["problem"]]
    if not chaos:
        return []
    out = ["## Chaotic solutions", "",
           "Only statistics can be compared; their bounds are four standard errors of the mean over 64 instances.",
           ""]
    out += table(["problem", "method", "statistic", "value", "bounds"],
                 [[r["problem"], r["method"], r["measure"], f'{r["value"]:.5g}', bounds_of(r)]
                  for r in chaos if r["measure"] != "failed instances"])
    return out


def long_times(rows):
    """Rounding over long times, if it was measured."""
    rounding = [r for r in rows if r["problem"].startswith("orbit")]
    if not rounding:
        return []
    out = ["## Rounding over long times", "",
           "A circular orbit that starts at a late time, where the resolution of t is coarse, against the same "
           "orbit from t = 0; and the mean change of energy of 1024 orbits in single precision, next to that in "
           "double precision.", ""]
    out += table(["problem", "method", "t_begin or tolerance", "value", "at most"],
                 [[r["problem"], r["method"], f'{r["setting"]:g}', short(r["value"]),
                   short(r["high"])] for r in rounding])
    return out


def backends(rows):
    """Backends against each other, if there are several."""
    against = [r for r in rows if r["measure"].startswith("against")]
    if not against:
        return []
    out = ["## Between backends", "",
           "Adaptive runs on two backends may differ by at most twice the bound on the error, fixed steps by "
           "rounding errors.", ""]
    groups = {}
    for r in against:
        groups.setdefault((r["problem"], r["method"], r["precision"]), []).append(r)
    out += table(["problem", "method", "end state: largest ratio to its bound", "steps: ratio",
                  "instances with other event counts"],
                 [[k[0], k[1] + ("" if k[2] == "double" else " (float)"),
                   short(max(r["value"] / r["high"] for r in v if r["measure"].endswith("end state"))),
                   " to ".join(f"{f(r['value'] for r in v if r['measure'].endswith('steps')):.4f}" for f in (min,
                                                                                                             max)),
                   str(int(sum(r["value"] for r in v if r["measure"].endswith("counts"))))] for k,
                   v in groups.items()])
    return out


def work(rows, images):
    """Error against work, if there is a picture of it."""
    if not images or not any(r["measure"].startswith("work: time") for r in rows):
        return []
    return ["## Error against work", "", f"![Error against evaluations and against time]({images}/work.png)", "",
            "One core. Times are relative to CVODE's at a tolerance of 1e-6 in the same run: an ensemble of 1024 "
            "instances for Myriad, 64 in succession for CVODE (Adams with Newton's iteration, a new object for "
            "each instance, which its time includes) and for Boost.odeint's controlled Cash-Karp stepper. All "
            "evaluate the same model function; CVODE's evaluations include those for its Jacobians. Speeds are "
            "compared by the repository's benchmarks, not here.", ""]


def detection():
    """How it is known that errors are found."""
    return ["## Does it detect errors?", "",
            "`scripts/validate.sh --mutations` changes every coefficient a, b, c and e of every explicit method by a "
            "ten-thousandth of itself, one at a time, and measures it with the functions behind the table of orders: "
            "each must be reported (`validation/mutation/coefficients.cpp`; a coefficient of a is changed without "
            "its node c). It then compiles the kernels from headers with one line changed (the other direction of "
            "events, a lost action, a slope kept after a jump, a rejected step accepted, and more: "
            "`validation/mutation/logic.py`), and each must fail this validation. `scripts/test.sh --all` runs the "
            "first part, and four changes of the second. `validation/mutation/event_rules.py --package DIR` leaves "
            "out one rule of event location at a time in the interpreter of the Python package, in packs and in "
            "single lanes, and says which test finds it first, with `--build DIR` in C++ test programs; that takes "
            "minutes for each rule, and so it is run by hand. `validation/mutation/event_rules.txt` has what was "
            "found, and when.", ""]


def write(comments, rows, images, command):
    return "\n".join([
        *summary(comments, rows, command), *references(rows), *errors(rows, images), *orders(rows), *chaotic(rows),
        *long_times(rows), *backends(rows), *work(rows, images), *detection()])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("csv")
    parser.add_argument("markdown")
    parser.add_argument("--images", default="")
    parser.add_argument("--command", default="")
    options = parser.parse_args()
    text = write(*read(options.csv), options.images, options.command)
    with open(options.markdown + ".part", "w", encoding="utf-8") as file:
        file.write(text)
    os.replace(options.markdown + ".part", options.markdown)


if __name__ == "__main__":
    main()
