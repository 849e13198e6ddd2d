#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Tabulates the registers, stack and spills of every method's kernel for 2, 4, 8 and 16 equations, or, with --features,
of one model's kernel with events and hooks.

Compiles benchmarks/methods/registers.cu once for each method and kind of number, or features.cu once for each set of
features, and writes a Markdown table, to the standard output or, with --into FILE, between the lines
`<!-- registers -->` and `<!-- end of registers -->` of FILE. Needs nvcc, no GPU. Exit status 2 if something is missing
or does not compile.
"""
import argparse
import os
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests" / "cuda"))
sys.dont_write_bytecode = True
from check_resources import compile_command, read_report  # noqa: E402
from methods import ORDINARY  # noqa: E402

SIZES = (2, 4, 8, 16)
FEATURES = {
    "no event, no hook": ["-DEVENTS=0"],
    "two accessories, `after_step`": ["-DEVENTS=0", "-DACCESSORIES", "-DAFTER_STEP"],
    "two accessories, `initialise` and `finalise`": ["-DEVENTS=0", "-DACCESSORIES", "-DPHASE_ENDS"],
    "the maximum of a quantity (`summaries`)": ["-DEVENTS=0", "-DSUMMARIES"],
    "one event": ["-DEVENTS=1"],
    "two events": ["-DEVENTS=2"],
    "four events": ["-DEVENTS=4"],
    "two events, `after_event` that writes an accessory": ["-DEVENTS=2", "-DACCESSORIES", "-DOBSERVING_ACTION"],
    "two events, `after_event` that changes the state": ["-DEVENTS=2", "-DACCESSORIES", "-DIMPACT"],
    "two events, accessories, all hooks": ["-DEVENTS=2", "-DACCESSORIES", "-DOBSERVING_ACTION", "-DAFTER_STEP",
                                           "-DPHASE_ENDS"],
}
FEATURE_METHODS = ("runge_kutta_4", "cash_karp", "tsitouras_5", "verner_7")
BEGIN, END = "<!-- registers -->", "<!-- end of registers -->"


def kernels_of(arguments, source, flags):
    """Resources of the kernels in a source, by name."""
    arguments = argparse.Namespace(**vars(arguments) | {"flag": flags})
    with tempfile.TemporaryDirectory() as folder:
        command = compile_command(arguments, str(ROOT / "benchmarks" / "methods" / source), f"{folder}/kernel.o")
        result = subprocess.run(command, capture_output=True, text=True, check=False)
    if result.returncode != 0:
        raise RuntimeError(result.stdout + result.stderr)
    return read_report(result.stdout + result.stderr)


def resources(arguments, method, real):
    """Resources of one method's kernels by number of equations."""
    found = {}
    for name, used in kernels_of(arguments, "registers.cu", [f"-DMETHOD={method}", f"-DREAL={real}"]).items():
        size = re.search(r"lorenz_96<(\d+)>", name)
        if size:
            found[int(size.group(1))] = used
    missing = set(SIZES) - set(found)
    if missing:
        raise RuntimeError(f"no kernels of {method} for {sorted(missing)} equations in what ptxas reports")
    return found


def cell(used):
    """Registers; behind them bytes of stack and of spill stores and loads, where there are any."""
    return f"{used.registers}" + (f" ({used.stack}, {used.spill})" if used.stack or used.spill else "")


def table(arguments, real):
    """Lines of one table."""
    lines = ["| method | " + " | ".join(f"n = {n}" for n in SIZES) + " |", "|---" * (1 + len(SIZES)) + "|"]
    with ThreadPoolExecutor(arguments.jobs) as pool:
        for method, used in zip(ORDINARY, pool.map(lambda method: resources(arguments, method, real), ORDINARY)):
            lines.append(f"| `{method}` | " + " | ".join(cell(used[n]) for n in SIZES) + " |")
            print(f"{real}: {method}", file=sys.stderr)
    return lines


def feature_table(arguments):
    """Lines of the table of features."""
    lines = ["| Duffing oscillator with | " + " | ".join(f"`{method}`" for method in FEATURE_METHODS) + " |",
             "|---" * (1 + len(FEATURE_METHODS)) + "|"]
    for name, flags in FEATURES.items():
        cells = []
        for method in FEATURE_METHODS:
            kernels = kernels_of(arguments, "features.cu", [f"-DMETHOD={method}", "-DREAL=double", *flags])
            used = [used for kernel, used in kernels.items() if "integrate_ensemble" in kernel]
            if len(used) != 1:
                raise RuntimeError(f"ptxas reports {len(used)} kernels of {method} with {name}, not one")
            cells.append(cell(used[0]))
        lines.append(f"| {name} | " + " | ".join(cells) + " |")
        print(name, file=sys.stderr)
    return lines


def replaced(text, lines):
    """The text with other lines between the marks."""
    before, begin, rest = text.partition(BEGIN + "\n")
    _, end, after = rest.partition(END)
    if not begin or not end:
        raise RuntimeError(f"there are no lines {BEGIN} and {END} to write the table between")
    return before + begin + "\n".join(lines) + "\n" + end + after


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--nvcc", default="nvcc", help="the compiler (default: nvcc)")
    parser.add_argument("--arch", default="sm_90", help="real architecture (default: sm_90)")
    parser.add_argument("--eigen", default="/usr/include/eigen3", metavar="DIR",
                        help="Eigen (default: /usr/include/eigen3)")
    parser.add_argument("--features", action="store_true", help="the table of events and hooks")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="compilers at a time (default: all cores)")
    parser.add_argument("--into", metavar="FILE", help="Markdown file to write the table into")
    arguments = parser.parse_args()
    arguments.include = [str(ROOT / "include"), str(ROOT / "backends" / "cuda")]
    arguments.system_include = [arguments.eigen]
    try:
        version = subprocess.run([arguments.nvcc, "--version"], capture_output=True, text=True, check=True).stdout
        release = re.search(r"V([\d.]+)", version)
        lines = [f"nvcc {release.group(1) if release else '?'}, {arguments.arch}, double precision:", ""]
        if arguments.features:
            lines += feature_table(arguments)
        else:
            lines += table(arguments, "double") + ["", "Single precision:", ""] + table(arguments, "float")
        if arguments.into:
            file = Path(arguments.into)
            file.write_text(replaced(file.read_text(encoding="utf-8"), lines), encoding="utf-8")
        else:
            print("\n".join(lines))
    except (OSError, RuntimeError, subprocess.CalledProcessError) as error:
        print(error, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
