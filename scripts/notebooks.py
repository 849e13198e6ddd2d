#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes Jupyter notebooks of the programs in python/examples, with the same code.

Usage: scripts/notebooks.py [--check]

A program with cells (`# %%`, and `# %% [markdown]` for text) has these cells. Of others the docstring is the text, and
a cell begins and ends where a snippet of the documentation does. What a checker is told, as by `noqa`, is left out, and
the program's folder, which a notebook cannot ask for, is written relative to that of the notebook.

Notebooks are in python/examples/notebooks, without results. --check names those that differ from their program, or have
none: exit status 1.
"""

import ast
import json
import os
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROGRAMS = ROOT / "python" / "examples"
NOTEBOOKS = PROGRAMS / "notebooks"
CELL = re.compile(r"^# %%( \[markdown\])?.*$", re.M)
MARK = re.compile(r"^(# snippet: \w+|# end of snippet)\n", re.M)
HEAD = re.compile(r"(#!.*\n)?# SPDX.*\n")


def markdown(comment):
    """The text of a cell of comments."""
    return re.sub(r"^# ?", "", comment, flags=re.M)


def cells_of(program):
    """The cells of a program's text: pairs of their kind and their text."""
    text = HEAD.sub("", program, count=1)
    first = CELL.search(text)
    if first:
        parts = list(CELL.finditer(text))
        ends = [part.start() for part in parts[1:]] + [len(text)]
        for part, end in zip(parts, ends):
            body = text[part.end():end]
            yield ("markdown", markdown(body.strip("\n"))) if part[1] else ("code", body)
        return
    docstring = ast.get_docstring(ast.parse(text), clean=True)
    body = text.split('"""', 2)[2]
    yield "markdown", docstring
    yield from (("code", part) for part in MARK.split(body)[::2])


def as_in(folder, source, code):
    """The code of a cell, as it is in a notebook of a folder."""
    place = os.path.relpath(source.parent, folder)
    code = code.replace("pathlib.Path(__file__).parent", f'pathlib.Path("{place}")')
    code = re.sub(r"  # (noqa|type: ignore|pylint).*$", "", code, flags=re.M)
    return re.sub(r"^ *# (snippet: \w+|end of snippet)\n", "", code + "\n", flags=re.M).strip("\n")


def notebook(source, target):
    """The text of the notebook of a program."""
    cells = []
    for kind, text in cells_of(source.read_text(encoding="utf-8")):
        text = as_in(target.parent, source, text) if kind == "code" else text.strip()
        if not text.strip():
            continue
        cell = {"cell_type": kind, "id": f"cell-{len(cells)}", "metadata": {}, "source": text.splitlines(keepends=True)}
        cells.append({**cell, "execution_count": None, "outputs": []} if kind == "code" else cell)
    made = {"cells": cells, "nbformat": 4, "nbformat_minor": 5, "metadata": {
        "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
        "language_info": {"name": "python"}, "license": "MIT"}}
    return json.dumps(made, indent=1, ensure_ascii=False, sort_keys=True) + "\n"


def notebooks():
    """What there should be: notebooks by their path."""
    sources = sorted(PROGRAMS.rglob("*.py"))
    targets = [NOTEBOOKS / source.relative_to(PROGRAMS).with_suffix(".ipynb") for source in sources]
    return {target: notebook(source, target) for source, target in zip(sources, targets)}


def main(arguments):
    if arguments not in ([], ["--check"]):
        print(__doc__.strip())
        return 0 if arguments in (["-h"], ["--help"]) else 2
    made, there = notebooks(), set(NOTEBOOKS.rglob("*.ipynb"))
    different = [path for path, text in made.items()
                 if path not in there or path.read_text(encoding="utf-8") != text]
    for path in sorted([*different, *(there - made.keys())]):
        what = ("differs from its program" if arguments else "written") if path in made else "has no program"
        print(path.relative_to(ROOT), what)
        if not arguments and path in made:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(made[path], encoding="utf-8")
        elif not arguments:
            path.unlink()
    if arguments and (different or there - made.keys()):
        print("Run scripts/notebooks.py", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
