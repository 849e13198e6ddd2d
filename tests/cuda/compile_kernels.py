#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Compiles the kernels of a configured build with the CUDA backend for its GPUs alone, machine code and PTX.

    compile_kernels.py BUILD [--files REGEX] [--except FILE] [--jobs N]

The build's own commands without the host's part, which takes three quarters of the time, and which programs that are
linked show. REGEX is searched for in the paths of the objects, below BUILD; a line of FILE is a part of the path of one
that is left out. Exit status: 0, 1 some do not compile, 2 there is nothing to compile.
"""
import argparse
import concurrent.futures
import json
import os
import re
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path


def object_of(entry):
    words = shlex.split(entry["command"])
    return words[words.index("-o") + 1]


def compile_kernel(entry):
    """Returns what the compiler says and whether it failed."""
    words = shlex.split(entry["command"])
    words[words.index("-c")] = "-fatbin"
    with tempfile.TemporaryDirectory() as folder:
        words[words.index("-o") + 1] = str(Path(folder) / "kernels.fatbin")
        done = subprocess.run(words, cwd=entry["directory"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True)
    return done.stdout, done.returncode != 0


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build", type=Path)
    parser.add_argument("--files", default="")
    parser.add_argument("--except", type=Path, dest="left_out")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    options = parser.parse_args()
    left_out = options.left_out.read_text(encoding="utf-8").split() if options.left_out else []
    entries = []
    for entry in json.loads((options.build / "compile_commands.json").read_text(encoding="utf-8")):
        if entry["file"].endswith(".cu") and re.search(options.files, object_of(entry)) and not any(
                part in object_of(entry) for part in left_out):
            entries.append(entry)
    if not entries:
        print("There is nothing to compile", file=sys.stderr)
        return 2
    failures = 0
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for entry, (said, failed) in zip(entries, pool.map(compile_kernel, entries)):
            failures += failed
            print(f"{'FAILED: ' if failed else ''}{entry['file']}", said, sep="\n", end="", flush=True)
    print(f"{len(entries)} files with kernels, {failures} do not compile")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
