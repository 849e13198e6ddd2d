#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Compiles kernels with nvcc for one GPU, and compares what that takes with a budget.

    check_compile_times.py BUDGET [--nvcc NVCC] [--reference-compiler CXX] [--include DIR...] [--system-include DIR...]

A line of BUDGET is "FILE MULTIPLE MEMORY": a file beside it, the most CPU seconds as a multiple of those of the
reference, a file that the line "reference FILE" names and the reference compiler compiles in the same run, and the most
memory in MB. CPU seconds are of all of nvcc's programs; other work on the machine hardly changes their quotient. Exit
status: 0, 1 over the budget, 2 something does not compile.
"""
import argparse
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))
from compile_times import cost  # noqa: E402


def read_budget(path):
    """The reference's file, and (file, multiple, MB) of each other."""
    reference, rows = None, []
    for line in path.read_text(encoding="utf-8").splitlines():
        words = line.split("#")[0].split()
        if words[:1] == ["reference"]:
            reference = path.parent / words[1]
        elif words:
            rows.append((path.parent / words[0], float(words[1]), float(words[2])))
    return reference, rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("budget", type=Path)
    parser.add_argument("--nvcc", default="nvcc")
    parser.add_argument("--reference-compiler", default="g++")
    parser.add_argument("--include", action="append", default=[])
    parser.add_argument("--system-include", action="append", default=[])
    parser.add_argument("--repeat", type=int, default=1)
    arguments = parser.parse_args()
    reference, rows = read_budget(arguments.budget.resolve())
    over = False
    with tempfile.TemporaryDirectory() as folder:
        def costs(words, file, output):
            found = cost([*words, str(file), "-o", str(Path(folder) / output)], folder, arguments.repeat)
            if found is None:
                print(f"{file} does not compile", file=sys.stderr)
                sys.exit(2)
            return found

        unit, _ = costs([arguments.reference_compiler, "-std=c++20", "-O1", "-c"], reference, "reference.o")
        nvcc = [arguments.nvcc, "-std=c++20", "-O3", "-prec-div=false", "-arch=sm_90", "-x", "cu", "-cubin",
                *(f"-I{Path(d).resolve()}" for d in arguments.include),
                *(f"-isystem={d}" for d in arguments.system_include)]
        for file, most, memory in rows:
            seconds, peak = costs(nvcc, file, "kernels.cubin")
            line = (f"{seconds:6.2f} s {peak:5.0f} MB  {file.name}: {seconds / unit:.2f} times the reference's "
                    f"{unit:.2f} s (limit {most:.2f}, {memory:.0f} MB)")
            if seconds / unit > most or peak > memory:
                line += "  OVER THE BUDGET"
                over = True
            print(line, flush=True)
    return 1 if over else 0


if __name__ == "__main__":
    sys.exit(main())
