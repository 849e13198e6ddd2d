#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws the measurements of gpu_ensembles: kernel time against the number of instances, with the limits and the times
of other packages; or, with --states, the time per state and instance against the number of states.

Usage: plot.py [--states] CSV PNG

Needs matplotlib (Debian, Ubuntu: python3-matplotlib). Exit status 2 if something is missing or wrong.
"""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "examples/common"))
import figure as figures  # pylint: disable=wrong-import-position

COLUMNS = {"case", "implementation", "instances", "kernel_ms", "median_error"}
# Kernel times of other packages, ms: MPGOS 3.1 on an H100, measured with the same method and the same numbers of steps;
# of GRADSOLVE and DiffEqGPU on an H200 as published by GRADSOLVE's authors, errors within a factor of two.
MPGOS = {"lorenz_rk4": {8192: 0.120, 65536: 0.287, 768000: 2.893, 4194304: 15.47},
         "keller_miksis": {8192: 914.7, 46080: 975.8, 307200: 1928},
         "relief_valve": {8192: 74.9, 30720: 77.1, 768000: 489}}
PUBLISHED = {"GRADSOLVE": {"1e-3": 0.276, "1e-6": 0.657, "1e-8": 1.424},
             "DiffEqGPU": {"1e-3": 0.748, "1e-6": 1.922, "1e-8": 4.240}}
# CuBIE 0.17 on an H200: Lorenz 96, 131 072 instances, Tsitouras' method, by number of states.
CUBIE = {"double": {4: 0.288, 8: 0.492, 16: 0.908, 32: 3.35, 64: 26.9, 128: 89.6},
         "single": {4: 0.111, 8: 0.095, 16: 0.151, 32: 0.294, 64: 1.56, 128: 22.8}}
# 45 double-precision instructions per step, 64 of them per cycle on each of 132 multiprocessors at 1980 MHz.
LIMIT_NS_PER_INSTANCE = 1000 * 45 / (64 * 132 * 1.98)


def read(path):
    """Kernel times by case, implementation and number of instances, and the name of the GPU."""
    rows, comments = figures.read_rows(path, "gpu_ensembles", COLUMNS)
    gpu = next((line[len("GPU: "):].split(",")[0] for line in comments if line.startswith("GPU: ")), "")
    times = {}
    for row in rows:
        case = times.setdefault(row["case"], {})
        case.setdefault(row["implementation"], {})[int(row["instances"])] = float(row["kernel_ms"])
    return times, gpu


def draw(axis, times, label, colour, line="-"):
    """One curve, in the order of instances."""
    axis.loglog(*zip(*sorted(times.items())), line, marker="o", markersize=4, color=colour, label=label)


def lorenz_fixed(times, axis):
    """Classic Runge-Kutta steps compared with the hand-written kernel."""
    case = times["lorenz_rk4"]
    sizes = sorted(case["myriad"])
    draw(axis, case["myriad"], "Myriad", figures.COLOURS[0])
    draw(axis, case["by_hand"], "written by hand", figures.COLOURS[1], "--")
    draw(axis, MPGOS["lorenz_rk4"], "MPGOS", "0.5", ":")
    axis.loglog(sizes, [1e-6 * LIMIT_NS_PER_INSTANCE * n for n in sizes], color="0.7", linewidth=0.8,
                label="limit: double precision")
    axis.set_title("Lorenz, 1000 Runge-Kutta steps", fontsize=10)


# Methods with a smaller error than Tsitouras' at a tolerance, in less time.
AS_EXACT = {"1e-3": "tsitouras_5 1.35e-3 first step 0.04", "1e-6": "verner_7 6e-6", "1e-8": "verner_7 5e-8"}


def lorenz_adaptive(times, axis):
    """Tsitouras' method at three tolerances, and methods that reach its errors faster."""
    for i, (tolerance, other) in enumerate(AS_EXACT.items()):
        draw(axis, times[f"lorenz_tsit5_{tolerance}"]["myriad"], f"Myriad, {tolerance}", figures.COLOURS[i])
        draw(axis, times["lorenz_methods"][other], "first step 0.04" if i == 0 else other, figures.COLOURS[i], "--")
        for marker, (package, published) in zip("sv", PUBLISHED.items()):
            axis.loglog([524288], [published[tolerance]], marker, color=figures.COLOURS[i], markersize=6,
                        markerfacecolor="none",
                        linestyle="none", label=package if i == 0 else None)
    axis.set_title("Lorenz, Tsitouras 5(4)", fontsize=10)


def by_method(name, title, chosen):
    """Draws one case with the methods at about the error that Cash-Karp has at 1e-10."""

    def panel(times, axis):
        for i, implementation in enumerate(chosen):
            draw(axis, times[f"{name}_methods"][implementation], implementation, figures.COLOURS[i])
        draw(axis, MPGOS[name], "MPGOS, cash_karp 1e-10", "0.5", ":")
        axis.set_title(title, fontsize=10)

    return panel


def draw_states(source, target):
    """Lorenz 96: the time per state and instance, of whichever way of writing the model is faster at that size."""
    times, gpu = read(source)
    pyplot, _ = figures.import_libraries({})
    figure, axis = pyplot.subplots(figsize=(9, 4.2))
    cases = {int(name.rsplit("_", 1)[1]): case for name, case in times.items() if name.startswith("lorenz96_")}
    instances = min(size for case in cases.values() for by_size in case.values() for size in by_size)

    def fastest(ending):
        found = {n: [case[way + ending][instances] for way in ("whole", "units") if way + ending in case]
                 for n, case in cases.items()}
        return {n: min(ways) for n, ways in found.items() if ways}

    for i, (precision, ending) in enumerate({"double": " 1e-6", "single": " float 1e-4"}.items()):
        for label, line, found in ((f"Myriad, {precision} precision", "-", fastest(ending)),
                                   ("the same, errors judged as CuBIE does", "--",
                                    fastest(" rms" + ending)),
                                   (f"CuBIE 0.17, {precision}", ":", CUBIE[precision])):
            draw(axis, {n: 1e6 * ms / n / instances for n, ms in found.items()}, label, figures.COLOURS[i], line)
    axis.set_xticks(sorted(cases), [str(n) for n in sorted(cases)], minor=False)
    axis.set_yticks(heights := (0.1, 0.2, 0.5, 1, 2, 5), [f"{ns:g}" for ns in heights])
    axis.minorticks_off()
    axis.set_xlabel("states")
    axis.set_ylabel("ns per state and instance")
    axis.set_title(f"Lorenz 96 to t = 1, {instances} instances, {gpu}", fontsize=10)
    axis.legend(frameon=False, fontsize=8, loc="upper left", bbox_to_anchor=(1, 1))
    axis.spines[["top", "right"]].set_visible(False)
    figure.tight_layout()
    figures.save(figure, target, 110)


def draw_all(source, target):
    """The picture of a table."""
    times, gpu = read(source)
    pyplot, _ = figures.import_libraries({})
    panels = (lorenz_fixed, lorenz_adaptive,
              by_method("keller_miksis", "Keller-Miksis, 64 phases",
                        ("cash_karp 1e-10", "verner_7 1e-10", "dormand_prince_8 1e-9")),
              by_method("relief_valve", "relief valve, 64 phases",
                        ("cash_karp 1e-10", "verner_7 1e-9", "dormand_prince_8 1e-9")))
    figure, axes = pyplot.subplots(2, 2, figsize=(9, 7))
    for panel, axis in zip(panels, axes.flat):
        try:
            panel(times, axis)
        except KeyError as error:
            raise figures.PlotError(f"{source} has no times of {error}: "
                                    "run gpu_ensembles without a choice of cases") from error
        figures.label_ticks(pyplot, axis.xaxis)
        figures.label_ticks(pyplot, axis.yaxis)
        axis.set_xlabel("instances")
        axis.set_ylabel("kernel, ms")
        axis.legend(frameon=False, fontsize=8)
        axis.spines[["top", "right"]].set_visible(False)
    figure.suptitle(gpu)
    figure.tight_layout()
    figures.save(figure, target, 110)


if __name__ == "__main__":
    by_states = "--states" in sys.argv
    if by_states:
        sys.argv.remove("--states")
    figures.exit_with(__doc__, draw_states if by_states else draw_all)
