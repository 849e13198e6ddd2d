#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks, in a finished Ninja build, that no file compiled for an instruction set includes Eigen.

The alignment of Eigen's objects depends on the instruction set, so such a file and main would disagree about it, which
ends in a "double free". Exit status: 0 none does, 1 at least one does.
"""
import json
import re
import shlex
import subprocess
import sys
from pathlib import Path


def main():
    build = Path(sys.argv[1])
    compiled_for_isa = {}
    for entry in json.loads((build / "compile_commands.json").read_text(encoding="utf-8")):
        words = shlex.split(entry["command"])
        if any(word.startswith("-march=") for word in words):
            compiled_for_isa[words[words.index("-o") + 1]] = entry["file"]

    dependencies = subprocess.run(["ninja", "-C", str(build), "-t", "deps"], capture_output=True, text=True, check=True).stdout
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
    return 1 if wrong or not seen else 0


if __name__ == "__main__":
    sys.exit(main())
