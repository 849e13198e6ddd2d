#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws the measurements of scripts/bench.sh: ratios with their goals, time against the number of instances, scaling
over threads.

Usage: plot.py CSV PNG

Needs matplotlib (Debian, Ubuntu: python3-matplotlib). Exit status 2 if something is missing or wrong.
"""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "examples/common"))
import figure as figures  # pylint: disable=wrong-import-position

COLUMNS = {"case", "implementation", "instruction_set", "threads", "instances", "milliseconds", "wall_milliseconds",
           "nanoseconds_per_step", "ratio_to_odeint", "ratio_to_cvode", "median_difference"}
TITLES = {"lorenz_rk4": "Lorenz", "duffing_cash_karp": "Duffing", "keller_miksis_cash_karp": "Keller-\nMiksis",
          "relief_valve": "relief\nvalve", "lorenz96_32": "Lorenz 96:\n32 states", "lorenz96_128": "128 states"}
# For Myriad's time against odeint's, with g++; and against CVODE's at equal error.
GOALS = {("lorenz_rk4", "avx512"): 9, ("lorenz_rk4", "avx2"): 5, "duffing_cash_karp": 5, "keller_miksis_cash_karp": 5,
         "relief_valve": 4, "lorenz96_32": 6, "lorenz96_128": 6}
GOAL_AT_EQUAL_ERROR = 15
GOAL = "goal that the project set itself (g++)"


def read(path):
    """Rows of the table; figures as numbers, None if missing."""
    rows, _ = figures.read_rows(path, "scripts/bench.sh", COLUMNS)
    for row in rows:
        for key in COLUMNS - {"case", "implementation", "instruction_set"}:
            row[key] = float(row[key]) if row[key] else None
    return rows


def sets_of(rows):
    """Instruction sets in the order in which they were run."""
    return list(dict.fromkeys(row["instruction_set"] for row in rows))


def draw_bars(axis, labels, heights_by_set, goals):
    """Groups of bars, one bar for each instruction set, with a line at its goal."""
    width = 0.8 / len(heights_by_set)
    for s, (name, heights) in enumerate(heights_by_set.items()):
        places = [i + (s - (len(heights_by_set) - 1) / 2) * width for i in range(len(labels))]
        axis.bar(places, heights, 0.9 * width, color=figures.COLOURS[s], label=name)
        for i, place in enumerate(places):
            axis.plot([place - width / 2, place + width / 2], [goals(i, name)] * 2, color="black", linewidth=1.2,
                      label=GOAL if s == i == 0 else None)
    axis.set_xticks(range(len(labels)), labels)
    axis.legend(frameon=False, fontsize=8, ncols=3, loc="lower center", bbox_to_anchor=(0.5, 1))  # bars fill the panel


def ratios(rows, axis, _pyplot):
    """Myriad's speed relative to odeint's, from the table of times."""
    cases = [case for case in TITLES if any(row["case"] == case for row in rows)]
    heights = {}
    for name in sets_of(rows):
        first = {}
        for row in rows:
            if row["instruction_set"] == name and row["implementation"] == "myriad" and row["ratio_to_odeint"]:
                first.setdefault(row["case"], row["ratio_to_odeint"])
        heights[name] = [first.get(case, 0) for case in cases]
    draw_bars(axis, [TITLES[case] for case in cases], heights,
              lambda i, name: GOALS.get(cases[i], GOALS.get((cases[i], name), 0)))
    axis.set_ylabel("times as fast as Boost.odeint")


def equal_error(rows, axis, _pyplot):
    """The best method's speed relative to CVODE's, at the finest error that both reached."""
    cases = [case for case in TITLES
             if any(row["case"] == case + ":equal_error" and row["ratio_to_cvode"] for row in rows)]
    heights = {}
    for name in sets_of(rows):
        heights[name] = []
        for case in cases:
            compared = [row for row in rows if row["case"] == case + ":equal_error" and row["ratio_to_cvode"]
                        and row["instruction_set"] == name and row["implementation"] not in ("odeint", "cvode_adams")]
            finest = min((row["median_difference"] for row in compared), default=None)
            heights[name].append(max((row["ratio_to_cvode"] for row in compared if row["median_difference"] == finest),
                                     default=0))
    draw_bars(axis, [TITLES[case] for case in cases], heights, lambda i, name: GOAL_AT_EQUAL_ERROR)
    axis.set_ylabel("times as fast as CVODE at equal error")


def growth(rows, axis, pyplot):
    """Core time per step and instance against the number of instances."""
    for s, name in enumerate(sets_of(rows)):
        for implementation, line in (("odeint", "--"), ("myriad", "-")):
            points = sorted({row["instances"]: row["nanoseconds_per_step"] for row in rows
                             if row["case"] == "lorenz_rk4" and row["implementation"] == implementation
                             and row["instruction_set"] == name}.items())
            axis.loglog(*zip(*points), line, marker="o", markersize=4, color=figures.COLOURS[s],
                        label=f"{implementation}, {name}")
    axis.set_xlabel("instances")
    axis.set_ylabel("Lorenz: ns of a core per step and instance")
    figures.label_ticks(pyplot, axis.yaxis)
    axis.legend(frameon=False, fontsize=8)


def scaling(rows, axis, _pyplot):
    """Wall time with one thread over that with several; one instruction set is enough."""
    name = sets_of(rows)[0]
    most = 1
    for s, case in enumerate(TITLES):
        points = {}
        for row in rows:
            if row["case"] == case and row["implementation"] == "myriad" and row["instruction_set"] == name:
                points.setdefault(row["instances"], {})[row["threads"]] = row["wall_milliseconds"]
        points = max(points.values(), key=len, default={})
        if 1 not in points or len(points) < 2:
            continue
        most = max(most, *points)
        axis.plot(sorted(points), [points[1] / points[t] for t in sorted(points)], marker="o", markersize=4,
                  color=figures.COLOURS[s], label=TITLES[case])
    axis.plot([1, most], [1, most], color="0.6", linewidth=0.8, label="linear")
    axis.set_xlabel("threads")
    axis.set_ylabel(f"times as fast as one thread ({name})")
    axis.legend(frameon=False, fontsize=8)


def has_scaling(rows):
    """Whether a case was run with one thread and with several, on equally many instances."""
    seen = {}
    for row in rows:
        if row["implementation"] == "myriad":
            seen.setdefault((row["case"], row["instances"], row["instruction_set"]), set()).add(row["threads"])
    return any(1 in threads and len(threads) > 1 for threads in seen.values())


def draw(source, target):
    """The picture of a table."""
    rows = read(source)
    pyplot, _ = figures.import_libraries({**figures.PLAIN, "font.size": 10})
    panels = [ratios, growth]
    if any(row["ratio_to_cvode"] for row in rows):
        panels.insert(1, equal_error)
    if has_scaling(rows):
        panels.append(scaling)
    figure, axes = pyplot.subplots(1, len(panels), figsize=(4.6 * len(panels), 4), layout="constrained")
    for panel, axis in zip(panels, axes):
        panel(rows, axis, pyplot)
    figures.save(figure, target, 160)


if __name__ == "__main__":
    figures.exit_with(__doc__, draw)
