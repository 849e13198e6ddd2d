#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks that the C++ and CMake code in README.md and docs/ is, letter for letter, code that is built and run.

Usage: scripts/check_readme.py [--fix]

A line `<!-- snippet: FILE NAME -->` before a fenced block says where the block comes from: the lines of FILE between
`snippet: NAME` and `end of snippet` (comments of FILE; several such parts are joined), or without NAME all lines below
its heading. A block of C++ or CMake without such a line is an error too. Exit status 1 if a block differs (--fix
rewrites it instead), 2 if a snippet or file is missing.
"""

import difflib
import pathlib
import re
import sys
import textwrap

ROOT = pathlib.Path(__file__).resolve().parent.parent
MARK = re.compile(r"<!-- snippet: (?P<file>\S+)(?: (?P<name>\w+))? -->")
BEGIN = re.compile(r"^\s*(//|#)\s*snippet: (?P<name>\w+)\s*$")
END = re.compile(r"^\s*(//|#)\s*end of snippet\s*$")
CHECKED_LANGUAGES = ("cpp", "c++", "cmake")


class Problem(Exception):
    """A snippet that cannot be found, or code that names none."""


def snippet(file, name):
    """Returns the lines of a snippet."""
    path = ROOT / file
    if not path.is_file():
        raise Problem(f"there is no file {file}")
    lines = path.read_text(encoding="utf-8").splitlines()
    if name is None:
        while lines and re.match(r"//|#|\s*$", lines[0]):
            lines.pop(0)
        return lines
    parts, part = [], None
    for line in lines:
        begin = BEGIN.match(line)
        if begin:
            if part is not None:
                raise Problem(f"{file}: a snippet begins inside another")
            part = [] if begin["name"] == name else None
        elif END.match(line):
            if part is not None:
                parts.append(textwrap.dedent("\n".join(part)))
            part = None
        elif part is not None:
            part.append(line)
    if part is not None:
        raise Problem(f"{file}: the snippet '{name}' has no end")
    if not parts:
        raise Problem(f"{file} has no snippet '{name}'")
    return "\n".join(parts).splitlines()


def check(document):
    """Returns the text of a document and what it should be."""
    old = document.read_text(encoding="utf-8").splitlines()
    new, mark, i = [], None, 0
    while i < len(old):
        line = old[i]
        new.append(line)
        i += 1
        if line.startswith("```"):
            end = next((j for j in range(i, len(old)) if old[j].rstrip() == "```"), None)
            if end is None:
                raise Problem(f"{document.name}:{i}: the block has no end")
            if mark:
                new += snippet(mark["file"], mark["name"])
            elif line[3:].strip() in CHECKED_LANGUAGES:
                raise Problem(f"{document.name}:{i}: code without a line <!-- snippet: FILE NAME -->")
            else:
                new += old[i:end]
            new.append(old[end])
            mark, i = None, end + 1
        elif line.strip():
            if mark:
                raise Problem(f"{document.name}:{i}: the snippet {mark[0]} is not followed by a block")
            mark = MARK.fullmatch(line.strip())
    return "\n".join(old) + "\n", "\n".join(new) + "\n"


def main(arguments):
    if arguments in (["-h"], ["--help"]):
        print(__doc__.strip())
        return 0
    if arguments not in ([], ["--fix"]):
        raise Problem("Usage: scripts/check_readme.py [--fix]")
    different = False
    for document in [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]:
        old, new = check(document)
        if old == new:
            continue
        name = str(document.relative_to(ROOT))
        if arguments:
            document.write_text(new, encoding="utf-8")
            print(f"{name} rewritten")
        else:
            different = True
            sys.stdout.writelines(
                difflib.unified_diff(old.splitlines(True), new.splitlines(True), name, f"{name}, as in the sources"))
    if different:
        print("Correct the sources, or run scripts/check_readme.py --fix", file=sys.stderr)
    return 1 if different else 0


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except Problem as problem:
        print(problem, file=sys.stderr)
        sys.exit(2)
