#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Compiles files of a build again, with the build's own commands, and says what that takes.

    compile_times.py BUILD [--files REGEX] [--slowest N] [--repeat N] [--budget FILE]

CPU seconds (user and system, the least of the repetitions) and peak memory of the compiler. BUILD has a
compile_commands.json, and with --slowest a finished Ninja build. With --budget a table of limits: a file's seconds are
divided by those of the reference file that the table names, compiled in the same run by the same compiler, so that a
slower machine finds the same; peak memory is limited in MB. A file over its budget is compiled anew beside the
reference, up to three times, since what else a machine does may delay one of them. Exit status: 0, 1 over the budget,
2 nothing to compile.
"""
import argparse
import json
import os
import re
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path


def command_of(entry, output):
    """The words of a compilation, writing to another file."""
    words = shlex.split(entry["command"])
    words[words.index("-o") + 1] = output
    return words


def cost(words, folder, repeat):
    """The least CPU seconds and the largest peak memory in MB; None if it does not compile."""
    least, most = float("inf"), 0
    for _ in range(repeat):
        process = subprocess.Popen(words, cwd=folder)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode != 0:
            return None
        least = min(least, usage.ru_utime + usage.ru_stime)
        most = max(most, usage.ru_maxrss / 1024)
    return least, most


def slowest(build, count):
    """Objects of the longest compilations that Ninja has logged."""
    seconds = {}
    for line in (build / ".ninja_log").read_text(encoding="utf-8").splitlines()[1:]:
        begin, end, _, target, *_ = line.split("\t")
        if target.endswith(".o"):
            seconds[target] = max(seconds.get(target, 0), int(end) - int(begin))
    return sorted(seconds, key=seconds.get, reverse=True)[:count]


def read_budget(path, compiler):
    """Rows of "file, largest multiple of the reference's seconds by g++, by clang++, largest peak in MB"."""
    rows, reference = {}, None
    for line in path.read_text(encoding="utf-8").splitlines():
        words = line.split("#")[0].split()
        if words[:1] == ["reference"]:
            reference = words[1]
        elif words:
            rows[words[0]] = (float(words[2 if "clang" in compiler else 1]), float(words[3]))
    return rows, reference


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=Path)
    parser.add_argument("--files", help="regular expression for source files")
    parser.add_argument("--slowest", type=int, default=0)
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--budget", type=Path)
    arguments = parser.parse_args()
    entries = json.loads((arguments.build / "compile_commands.json").read_text(encoding="utf-8"))
    rows, reference = {}, None
    if arguments.budget:
        arguments.budget = arguments.budget.resolve()
        rows, reference = read_budget(arguments.budget, shlex.split(entries[0]["command"])[0])
        # A file that is part of several programs is compiled once.
        entries = list({e["file"]: e for e in reversed(entries)
                        if any(e["file"].endswith("/" + name) for name in rows)}.values())
    elif arguments.slowest:
        targets = slowest(arguments.build, arguments.slowest)
        entries = [e for target in targets for e in entries if f" -o {target} " in e["command"]]
    elif arguments.files:
        entries = [e for e in entries if re.search(arguments.files, e["file"])]
    if not entries or (arguments.budget and len(entries) != len(rows)):
        print(f"{arguments.build} has {len(entries)} of the files to compile", file=sys.stderr)
        return 2

    over = False
    root = Path(os.path.commonpath([e["file"] for e in entries] + [str(arguments.build.resolve().parent)]))
    with tempfile.TemporaryDirectory() as folder:
        output, unit = str(Path(folder) / "object.o"), None
        if arguments.budget:  # with the flags of the host's files
            entry = next(e for e in entries if "MYRIAD_MODEL_FILE" not in e["command"])
            words = command_of(entry, output)
            words[words.index(entry["file"])] = str(arguments.budget.parent / reference)
            reference_words, reference_folder = words, entry["directory"]
            unit = cost(words, entry["directory"], arguments.repeat)
            if unit is None:
                print(f"{reference} does not compile", file=sys.stderr)
                return 2
        for entry in entries:
            words = command_of(entry, output)
            found = cost(words, entry["directory"], arguments.repeat)
            if found is None:
                print(f"{entry['file']} does not compile", file=sys.stderr)
                return 2
            name, tries = os.path.relpath(entry["file"], root), 0
            if arguments.budget:
                most, memory = rows[next(name for name in rows if entry["file"].endswith("/" + name))]
                while found[0] / unit[0] > most and tries < 3:
                    unit = cost(reference_words, reference_folder, 1)
                    found, tries = cost(words, entry["directory"], 1), tries + 1
            line = f"{found[0]:6.2f} s {found[1]:5.0f} MB  {name}"
            if arguments.budget:
                ratio = found[0] / unit[0]
                line += f": {ratio:.2f} times the reference's {unit[0]:.2f} s (limit {most:.2f}, {memory:.0f} MB)"
                if ratio > most or found[1] > memory:
                    line += "  OVER THE BUDGET"
                    over = True
            print(line, flush=True)
    return 1 if over else 0


if __name__ == "__main__":
    sys.exit(main())
