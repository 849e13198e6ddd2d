#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws the measurements of the program `methods`, and writes its tables into a Markdown file.

Usage: plot.py [CSV [CSV of another device]] [--images DIR] [--into FILE]

Without CSV: the files next to this one. One picture per case, DIR/CASE.png: median error against evaluations of f, and
against time on each device. Tables go between the lines `<!-- measured: NAME -->` and `<!-- end of measured -->` of
FILE. Needs matplotlib (Debian: python3-matplotlib). Exit status 2 if something is missing or wrong.
"""
import argparse
import math
import re
import sys
from collections import defaultdict
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "examples/common"))
import figure as figures  # pylint: disable=wrong-import-position

COLUMNS = ("case", "method", "device", "instances", "tolerance", "milliseconds", "accepted", "rejected",
           "rhs_evaluations",
           "median_error", "largest_error", "failed", "astray")
TITLES = {"keller_miksis": "Keller-Miksis bubble", "relief_valve": "Relief valve with impacts",
          "relief_valve_watched": "Relief valve with impacts, 8 looks a step", "robertson": "Robertson's reaction"}
# Markers and dashes repeat the distinction by colours.
STYLES = {"cash_karp": (figures.ORANGE, "s"), "dormand_prince_5": (figures.SKY, "v"),
          "tsitouras_5": (figures.GREEN, "^"),
          "verner_7": (figures.PINK, "D"), "dormand_prince_8": (figures.BLUE, "o"),
          "rosenbrock_23": (figures.ORANGE, "s"),
          "rodas_5p": (figures.BLUE, "o")}
CONTROLS = {"": ("-", 1), "pi": ("--", 0), "rms": (":", 0)}  # line, and whether markers are filled


def read_table(path):
    """Rows by (case, method), sorted by tolerance, of one device."""
    rows, _ = figures.read_rows(path, "methods", COLUMNS)
    table = defaultdict(list)
    for row in rows:
        for key in row:
            if key not in ("case", "method", "device"):
                row[key] = float(row[key])
        table[row["case"], row["method"]].append(row)
    for rows in table.values():
        rows.sort(key=lambda row: -row["tolerance"])
    return table


def cases_of(table):
    """Cases in the order in which they were run."""
    return list(dict.fromkeys(case for case, _ in table))


def methods_of(table, case):
    """Methods of a case in the order in which they were run."""
    return [method for name, method in table if name == case]


def kind_of(table):
    """`CPU` or `GPU`."""
    device = next(iter(table.values()))[0]["device"]
    return "GPU" if device.startswith("cuda") else "CPU"


def cost_at(rows, error, cost):
    """The cost of a median error no larger than the given one: that of the loosest tolerance if its error is small
    enough, else interpolated log-log between two measured points; None if it was not reached."""
    if rows[0]["median_error"] <= error:
        return cost(rows[0])
    for one, other in zip(rows, rows[1:]):
        high, low = one["median_error"], other["median_error"]
        if low <= error <= high and low < high:
            share = math.log(high / error) / math.log(high / low)
            return math.exp((1 - share) * math.log(cost(one)) + share * math.log(cost(other)))
    return None


def milliseconds(row):
    """Time of a row."""
    return row["milliseconds"]


def evaluations(row):
    """Evaluations of f per instance."""
    return row["rhs_evaluations"] / row["instances"]


def draw(tables, case):
    """The picture of one case: evaluations, then time on each device."""
    pyplot, _ = figures.import_libraries({**figures.PLAIN, "font.size": 10})
    from matplotlib.ticker import FuncFormatter, LogLocator  # pylint: disable=import-outside-toplevel
    panels = [("evaluations of $f$ per instance", tables[0], evaluations)]
    for table in tables:
        rows = [row for (name, _), measured in table.items() if name == case for row in measured]
        if kind_of(table) == "CPU":  # only times of the same run are comparable
            shortest = min(milliseconds(row) for row in rows)
            panels.append(("time on the CPU over the shortest", table, lambda row, s=shortest: milliseconds(row) / s))
        else:
            count = f"{rows[0]['instances']:,.0f}".replace(",", " ")
            panels.append((f"time on the GPU, {count} instances (ms)", table, milliseconds))
    figure, axes = pyplot.subplots(1, len(panels), sharey=True, figsize=(4.2 * len(panels), 4.2), layout="constrained")
    for axis, (label, table, cost) in zip(axes, panels):
        for method in methods_of(table, case):
            name, _, control = method.partition(" ")
            colour, marker = STYLES[name]
            line, filled = CONTROLS[control]
            rows = table[case, method]
            axis.loglog([cost(row) for row in rows], [row["median_error"] for row in rows], line, color=colour,
                        marker=marker, markersize=4.5, markerfacecolor=colour if filled else "white", linewidth=1,
                        label=method)
        axis.set_xlabel(label)
        axis.grid(True, which="major", linewidth=0.3, color="0.8")
        low, high = axis.get_xlim()
        if high / low < 100:  # a single power of ten tells nothing
            axis.xaxis.set_minor_locator(LogLocator(subs=(2, 5)))
            for each in (axis.xaxis.set_major_formatter, axis.xaxis.set_minor_formatter):
                each(FuncFormatter(lambda value, _: f"{value:g}"))
    axes[0].set_ylabel("median error")
    axes[-1].legend(frameon=False, fontsize=8)
    figure.suptitle(TITLES.get(case, case), fontsize=12)
    return figure


def equal_error(tables, case):
    """Lines of the table of times at equal median error, relative to the fastest, for errors that some method had."""
    measured = [rows for (name, _), rows in tables[0].items() if name == case]
    wanted = [e for e in (1e-4, 1e-6, 1e-8, 1e-10, 1e-12)
              if any(rows[-1]["median_error"] <= e <= rows[0]["median_error"] for rows in measured)]
    lines = ["| method | " + " | ".join(f"{e:.0e}".replace("e-0", "e-") for e in wanted) + " |",
             "|---" * (1 + len(wanted)) + "|"]
    for method in methods_of(tables[0], case):
        cells = []
        for error in wanted:
            parts = []
            for table in tables:
                costs = {m: cost_at(table[case, m], error, milliseconds) for m in methods_of(table, case)}
                known = [c for c in costs.values() if c]
                mine = costs.get(method)
                parts.append(f"{mine / min(known):.2f}" if mine else "–")
            cells.append(" / ".join(parts))
        lines.append(f"| `{method}` | " + " | ".join(cells) + " |")
    return lines


def astray(tables, case):
    """Lines of the table of instances that went astray, by method and tolerance."""
    table = tables[0]
    methods = methods_of(table, case)
    tolerances = [row["tolerance"] for row in table[case, methods[0]]]
    lines = ["| method | " + " | ".join(f"{t:.0e}".replace("e-0", "e-") for t in tolerances) + " |",
             "|---" * (1 + len(tolerances)) + "|"]
    for method in methods:
        lines.append(f"| `{method}` | " + " | ".join(f"{row['astray']:.0f}" for row in table[case, method]) + " |")
    return lines


def write_tables(path, tables):
    """Replaces the tables in a Markdown file."""
    text = Path(path).read_text(encoding="utf-8")

    def table_of(match):
        kind, case = match.group("kind"), match.group("case")
        if kind not in ("time", "astray") or (case, methods_of(tables[0], case)[0]) not in tables[0]:
            raise ValueError(f"{path} asks for '{kind} {case}', which was not measured")
        lines = equal_error(tables, case) if kind == "time" else astray(tables, case)
        return match.group("begin") + "\n".join(lines) + "\n" + match.group("end")

    pattern = r"(?P<begin><!-- measured: (?P<kind>\w+) (?P<case>\w+) -->\n).*?(?P<end><!-- end of measured -->)"
    text, count = re.subn(pattern, table_of, text, flags=re.S)
    if count == 0:
        raise ValueError(f"{path} has no lines <!-- measured: NAME --> and <!-- end of measured -->")
    Path(path).write_text(text, encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("tables", nargs="*", metavar="CSV", default=sorted(Path(__file__).parent.glob("*.csv")),
                        help="tables of the program, one file per device (default: the files next to this one)")
    parser.add_argument("--images", metavar="DIR", help="folder for the pictures")
    parser.add_argument("--into", metavar="FILE", help="Markdown file to write the tables into")
    arguments = parser.parse_args()
    try:
        tables = [read_table(path) for path in arguments.tables]
        if arguments.images:
            for case in cases_of(tables[0]):
                figures.save(draw([table for table in tables if case in cases_of(table)], case),
                             str(Path(arguments.images) / f"{case}.png"), 160)
        if arguments.into:
            write_tables(arguments.into, tables)
    except figures.PlotError as error:
        print(error, file=sys.stderr)
        return 2
    except (OSError, ValueError, IndexError) as error:
        print(f"{error}; run the program `methods` first", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
