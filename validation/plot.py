#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws the pictures of a validation run: error against tolerance, and against work.

Usage: plot.py report.csv FOLDER
Writes tolerance.png and, if work was measured, work.png. Needs numpy and matplotlib.
"""
import os
import pathlib
import sys

from report import read

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "examples/common"))
import figure as figures  # pylint: disable=wrong-import-position

STYLES = {"CVODE": ("#000000", "x", ":"), "odeint cash_karp": (figures.RED, "+", ":"),
          "runge_kutta_4": ("#999999", "s", "-"),
          "cash_karp": (figures.BLUE, "o", "-"), "tsitouras_5": (figures.GREEN, "^", "-"),
          "dormand_prince_5": (figures.ORANGE, "v", "-"), "verner_7": (figures.PINK, "D", "-"),
          "dormand_prince_8": (figures.SKY, "P", "-"), "verner_9": ("#555555", "X", "-"),
          "rosenbrock_23": ("#000000", "*", "--"),
          "rodas_5p": (figures.RED, "h", "--")}
NAMES = {"lorenz": "Lorenz", "duffing": "Duffing", "van_der_pol": "van der Pol", "keller_miksis": "Keller–Miksis",
         "relief_valve": "relief valve", "heat": "heat conduction", "kepler": "Kepler", "timed_circle": "timed circle",
         "robertson": "Robertson", "oregonator": "Oregonator",
         "pollution": "pollution", "hires": "HIRES", "ring_modulator": "ring modulator",
         "ring_of_48": "ring of 48 states"}
# Problems without a panel, each with the reason.
LEFT_OUT = {"bouncing_ball": "No panel for the bouncing ball:\nits flights are parabolas, which\n"
                             "every method integrates exactly,\nso that its errors do not\nfollow the tolerance."}
LABELS = {"cash_karp": "Cash–Karp 5(4)", "tsitouras_5": "Tsitouras 5(4)", "runge_kutta_4": "Runge–Kutta 4, fixed steps",
          "odeint cash_karp": "Boost.odeint, Cash–Karp", "CVODE": "CVODE, Adams",
          "dormand_prince_5": "Dormand–Prince 5(4)",
          "verner_7": "Verner 7(6)", "verner_9": "Verner 9(8)",
          "dormand_prince_8": "Dormand–Prince 8(5,3)", "rosenbrock_23": "Rosenbrock 2(3)",
          "rodas_5p": "Rodas 5P"}


def style(method):
    colour, marker, line = STYLES.get(method, (figures.YELLOW, "*", "-"))
    return dict(color=colour, marker=marker, linestyle=line, markersize=4, linewidth=1,
                label=LABELS.get(method, method))


def curves(rows, problem, measure):
    """method: [(setting, value)], by setting."""
    found = {}
    for r in rows:
        if r["problem"] == problem and r["measure"] == measure and r["precision"] == "double":
            found.setdefault(r["method"], []).append((r["setting"], r["value"]))
    return {method: sorted(points) for method, points in found.items()}


def draw_tolerances(pyplot, rows, path):
    problems = [p for p in NAMES if any(len(c) > 2 for c in curves(rows, p, "end state, median").values())]
    columns = 4
    rows_of_axes = -(-len(problems) // columns)
    height = 0.9 + 1.6 * rows_of_axes
    figure, axes = pyplot.subplots(rows_of_axes, columns, figsize=(7.2, height), sharex=True, sharey=True,
                                   squeeze=False)
    drawn = {}
    for axis, problem in zip(axes.flat, problems):
        for method, points in curves(rows, problem, "end state, median").items():
            if len(points) > 2:
                drawn[method] = axis.loglog(*zip(*points), **style(method))[0]
        axis.loglog([1e-11, 1e-5], [1e-11, 1e-5], "k--", linewidth=0.6)
        axis.set_title(NAMES[problem], fontsize=9)
    reasons = [reason for problem, reason in LEFT_OUT.items() if any(r["problem"] == problem for r in rows)]
    for axis in axes.flat[len(problems):]:
        axis.set_axis_off()
        if reasons:
            axis.text(0.0, 0.95, reasons.pop(0), transform=axis.transAxes, fontsize=8, verticalalignment="top")
    for axis in axes.flat[max(0, len(problems) - columns):len(problems)]:
        axis.tick_params(labelbottom=True)
    axes.flat[0].set_xticks([1e-11, 1e-9, 1e-7, 1e-5])
    figure.supxlabel("tolerance, relative and absolute", fontsize=9)
    figure.supylabel("median error at the end", fontsize=9)
    figure.legend(handles=list(drawn.values()), loc="upper center", ncols=4, frameon=False, fontsize=8)
    figure.subplots_adjust(left=0.10, right=0.985, bottom=0.5 / height, top=1 - 0.7 / height, hspace=0.28, wspace=0.12)
    figures.save(figure, path, 170)


def draw_work(pyplot, rows, path):
    problems = [p for p in NAMES if curves(rows, p, "work: median error")]
    if not problems:
        return
    figure, axes = pyplot.subplots(2, len(problems), figsize=(7.2, 5.6), sharey="col", squeeze=False)
    drawn = {}
    for column, problem in enumerate(problems):
        errors = curves(rows, problem, "work: median error")
        for row, (measure, label) in enumerate((("work: evaluations per instance", "evaluations of f per instance"),
                                                ("work: time per instance over CVODE's at 1e-6",
                                                 "time per instance / that of CVODE at $10^{-6}$"))):
            axis = axes[row][column]
            for method, work in curves(rows, problem, measure).items():
                drawn[method] = axis.loglog([w for _, w in work], [e for _, e in errors[method]], **style(method))[0]
            axis.set_xlabel(label, fontsize=8.5)
            if column == 0:
                axis.set_ylabel("median error at the end", fontsize=8.5)
        axes[0][column].set_title(NAMES[problem], fontsize=9)
    figure.legend(handles=list(drawn.values()), loc="upper center", ncols=3, frameon=False, fontsize=8)
    figure.subplots_adjust(left=0.10, right=0.985, bottom=0.09, top=0.85, hspace=0.33, wspace=0.2)
    figures.save(figure, path, 170)


def draw(source, folder):
    """All pictures of a report."""
    pyplot, _ = figures.import_libraries({**figures.PLAIN, "font.size": 8, "xtick.top": True, "ytick.right": True,
                                          "axes.grid": True, "grid.linewidth": 0.3, "grid.alpha": 0.5})
    _, rows = read(source)
    os.makedirs(folder, exist_ok=True)
    draw_tolerances(pyplot, rows, os.path.join(folder, "tolerance.png"))
    draw_work(pyplot, rows, os.path.join(folder, "work.png"))


if __name__ == "__main__":
    figures.exit_with(__doc__, draw, ("CSV", "FOLDER"))
