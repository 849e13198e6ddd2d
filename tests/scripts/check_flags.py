#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks, in a finished Ninja build, that no file compiled for an instruction set includes Eigen, and that none shares
functions.

The alignment of Eigen's objects depends on the instruction set, so such a file and main would disagree about it, with
a "double free" as the result. A function that a model calls without MYRIAD_FUNCTION, if it is not inlined, is shared
by all files that have it, and the linker keeps one of them, whatever its flags. Exit status: 0 all is well, 1 at
least one file is wrong.
"""
import json
import re
import shlex
import subprocess
import sys
from pathlib import Path


def shared_functions(build, nm, entries):
    """Of model files that are optimised, so that functions of the standard library are inlined, if only by -O1."""
    wrong, seen = [], 0
    for entry in entries:
        words, source = shlex.split(entry["command"]), Path(entry["file"])
        levels = [word for word in words if re.match(r"-O\w*$", word)]
        if "-DMYRIAD_MODEL_FILE" not in words or levels[-1:] not in (["-O1"], ["-O2"], ["-O3"]) or not source.exists():
            continue
        target = build / words[words.index("-o") + 1]
        text = source.read_text(encoding="utf-8")
        # A file with test cases contains Catch2's functions, and is compiled for one instruction set.
        if not target.exists() or "catch.hpp" in text or not re.search(r"^MYRIAD_INSTANTIATE", text, re.MULTILINE):
            continue
        seen += 1
        symbols = subprocess.run([nm, "-C", "--defined-only", str(target)], capture_output=True, text=True,
                                 check=True).stdout
        for line in symbols.splitlines():
            name = re.match(r"[0-9a-f]+ W (.*)", line)
            # The names of kernels and of xsimd's functions carry their instruction set; clang++'s own only ends the
            # program.
            own = r"openmp_|instruction_set\)|xsimd::kernel::|__clang_call_terminate"
            if name and not re.search(own, name.group(1)):
                wrong.append(f"{source} shares {name.group(1)}: put MYRIAD_FUNCTION before it")
    return seen, wrong


def main():
    build = Path(sys.argv[1])
    nm = sys.argv[2]
    compiled_for_isa = {}
    entries = json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))
    for entry in entries:
        words = shlex.split(entry["command"])
        if any(word.startswith("-march=") for word in words):
            compiled_for_isa[words[words.index("-o") + 1]] = entry["file"]

    dependencies = subprocess.run(["ninja", "-C", str(build), "-t", "deps"], capture_output=True, text=True,
                                  check=True).stdout
    seen, wrong = 0, []
    source = None
    for line in dependencies.splitlines():
        target = re.match(r"(\S.*): #deps \d+", line)
        if target:
            source = compiled_for_isa.get(target.group(1))
            seen += source is not None
        elif source and line.endswith("/Eigen/Core"):
            wrong.append(source)
    print(f"{seen} files are compiled for an instruction set")
    for file in wrong:
        print(f"{file} includes Eigen: list it after FILES instead of MODELS, or leave Eigen out")
    models, shared = shared_functions(build, nm, entries)
    print(f"{models} model files are looked at for functions that others may have, too")
    print(*shared, sep="\n")
    return 1 if wrong or shared or not seen else 0


if __name__ == "__main__":
    sys.exit(main())
