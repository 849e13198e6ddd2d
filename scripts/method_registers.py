#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Tabulates the registers, stack and spills of every method's kernel for 2, 4, 8 and 16 equations.

Compiles benchmarks/methods/registers.cu once for each method and kind of number and writes a Markdown table, to the
standard output or, with --into FILE, between the lines `<!-- registers -->` and `<!-- end of registers -->` of FILE.
Needs nvcc, no GPU. Exit status 2 if something is missing or does not compile.
"""
import argparse
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests" / "cuda"))
sys.dont_write_bytecode = True
from check_resources import compile_command, read_report  # noqa: E402

METHODS = ("runge_kutta_4", "cash_karp", "tsitouras_5", "dormand_prince_5", "verner_7", "dormand_prince_8",
           "rosenbrock_23", "rodas_5p")
SIZES = (2, 4, 8, 16)
BEGIN, END = "<!-- registers -->", "<!-- end of registers -->"


def resources(arguments, method, real):
    """Resources of one method's kernels by number of equations."""
    arguments.flag = [f"-DMETHOD={method}", f"-DREAL={real}"]
    with tempfile.TemporaryDirectory() as folder:
        command = compile_command(arguments, str(ROOT / "benchmarks" / "methods" / "registers.cu"),
                                  f"{folder}/kernel.o")
        result = subprocess.run(command, capture_output=True, text=True, check=False)
    if result.returncode != 0:
        raise RuntimeError(result.stdout + result.stderr)
    found = {}
    for name, used in read_report(result.stdout + result.stderr).items():
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
    for method in METHODS:
        used = resources(arguments, method, real)
        lines.append(f"| `{method}` | " + " | ".join(cell(used[n]) for n in SIZES) + " |")
        print(f"{real}: {method}", file=sys.stderr)
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
    parser.add_argument("--into", metavar="FILE", help="Markdown file to write the table into")
    arguments = parser.parse_args()
    arguments.include = [str(ROOT / "include"), str(ROOT / "backends" / "cuda")]
    arguments.system_include = [arguments.eigen]
    try:
        version = subprocess.run([arguments.nvcc, "--version"], capture_output=True, text=True, check=True).stdout
        release = re.search(r"V([\d.]+)", version)
        lines = [f"nvcc {release.group(1) if release else '?'}, {arguments.arch}, double precision:", ""]
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
