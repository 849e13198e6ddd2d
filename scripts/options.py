#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What is written of the table of options, include/myriad/host/options/option_table.hpp:
python/myriad_ode/solving/options.py, and the table in docs/solving.md.

Usage: PYTHON scripts/options.py (--check | --fix)

PYTHON is one that has the package of this source, as build/python-environment/bin/python after scripts/python.sh.
--check says what differs, with exit status 1; --fix writes it.
"""

import difflib
import importlib.util
import math
import pathlib
import sys
import textwrap

ROOT = pathlib.Path(__file__).resolve().parent.parent
PYTHON = ROOT / "python/myriad_ode/solving/options.py"
DOCUMENT = ROOT / "docs/solving.md"
BEGIN, END = "<!-- options: written by scripts/options.py -->\n", "<!-- end of options -->\n"

HINTS = {"whole number": "int", "number": "float", "truth": "bool", "tolerances": "Tolerance", "numbers": "Values",
         "components": "SomeComponents", "events": "Mapping[Component, EventChoice] | None",
         "record": "SomeComponents | RecordChoice | None", "samples": "Values | SampleChoice | None"}


def literal(choices):
    return f"Literal[{', '.join(f'{c!r}' for c in choices)}]".replace("'", '"')


class Field:
    """An option of Python's."""

    def __init__(self, row, option_names):
        self.row, self.core_name = row, row["name"]
        self.name = option_names.names.get(self.core_name, self.core_name).rpartition(".")[2]
        self.only_solve = row["of_call_alone"] or self.name in option_names.arguments_of_study
        yes = option_names.true_choices.get(self.core_name)
        if yes:
            self.hint, self.default = "bool", repr(row["initial"] == yes)
        elif row["type"] == "choice":
            self.hint, self.default = literal(row["choices"]), f'"{row["initial"]}"'
        else:
            self.hint, self.default = HINTS[row["type"]], row["initial"] or "None"
            if row["type"] == "number" and not math.isfinite(float(row["initial"] or "nan")):
                self.hint, self.default = "float | None", "None"
        self.default = self.default.replace("e-0", "e-")
        if self.hint == "Tolerance":
            self.default = f"NotGiven({self.default})"

    def meaning(self):
        """The sentence, with range and unit."""
        notes = [n for n in (self.row["range"] and f"in {self.row['range']}",
                             self.row["unit"] and f"in {unit_of(self.row)}") if n]
        return self.row["meaning"] + (f" ({', '.join(notes)})" if notes else "")


def unit_of(row):
    return {"time": "the model's unit of time", "state": "the state's unit",
            "event function": "the function's unit"}.get(row["unit"], row["unit"])


def wrapped(text, first, rest):
    return textwrap.wrap(text, 120, initial_indent=first, subsequent_indent=rest, break_long_words=False,
                         break_on_hyphens=False)


def python_module(rows, option_names):
    fields = [Field(r, option_names) for r in rows if "." not in r["name"] and r["name"] not in option_names.left_out]
    lines = ['# SPDX-License-Identifier: MIT',
             '"""The options of `solve` and `study`. Written by scripts/options.py from the table of options."""', '',
             'from __future__ import annotations', '', 'from collections.abc import Mapping',
             'from dataclasses import dataclass', 'from typing import Literal, TypedDict', '',
             'from ..symbolic.types import Component, NotGiven, SomeComponents, Tolerance, Values', '',
             '__all__ = ["EventChoice", "Options", "RecordChoice", "SampleChoice"]', '']
    for struct, name, what in (("events", "EventChoice", "How an event is detected, instead of what the model says."),
                               ("record", "RecordChoice", "What is kept at the end of each phase."),
                               ("samples", "SampleChoice",
                                "Dense output: exactly one of `evenly`, `times` and `every` says at which times.")):
        inner = [Field(r, option_names) for r in rows
                 if r["name"].startswith(struct + ".") and r["name"] not in option_names.left_out_of_structs]
        lines += ["", f"class {name}(TypedDict, total=False):", f'    """{what}', ""]
        for f in inner:
            lines += wrapped(f.meaning(), f"    {f.name}: ", "        ")
        lines += ['    """', ""]
        lines += [f"    {f.name}: {f.hint}" for f in inner]
        lines.append("")
    for name, base, chosen, what in (
            ("StudyArguments", "TypedDict", [f for f in fields if not f.only_solve], "Options of `study`, by keyword."),
            ("SolveArguments", "StudyArguments", [f for f in fields if f.only_solve],
             "Options of `solve`, by keyword.")):
        lines += ["", f"class {name}({base}, total=False):", f'    """{what}"""', ""]
        lines += [f"    {f.name}: {f.hint}" for f in chosen]
        lines.append("")
    lines += ["", "@dataclass(frozen=True, kw_only=True)", "class Options:",
              '    """The options of a call of `solve` or `study`, to be given as `options=`, or each by its name.', ""]
    for f in fields:
        lines += wrapped(f.meaning(), f"    {f.name}: ", "        ")
    lines += ['    """', ""]
    lines += [f"    {f.name}: {f.hint} = {f.default}" for f in fields]
    return "\n".join(lines) + "\n"


def markdown_table(rows):
    """The options that are no struct, and those of structs, for docs/solving.md."""
    lines = ["| option | default | range | unit | meaning |", "|---|---|---|---|---|"]
    for r in rows:
        default = {"inf": "infinite", "1000000": "10^6"}.get(r["initial"], r["initial"])
        default = default.replace("e-0", "e-")
        if r["type"] == "choice":
            default = f"`{default}`"
        others = [f"`{c}`" for c in r["choices"] if c != r["initial"]]
        range_ = "or " + ", ".join(others) if others else r["range"]
        for number, written in (("inf", "∞"), ("2000000000", "2·10^9"), ("1000000000", "10^9")):
            range_ = range_.replace(number, written)
        lines.append(f"| `{r['name']}` | {default} | {range_} | {r['unit']} | {r['meaning']} |")
    return "\n".join(lines) + "\n"


def loaded(name, file):
    spec = importlib.util.spec_from_file_location(name, file)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def main(arguments):
    if arguments not in (["--check"], ["--fix"]):
        print(__doc__.strip())
        return 0 if arguments in (["-h"], ["--help"]) else 2
    option_names = loaded("option_names", ROOT / "python/myriad_ode/base/option_names.py")
    package = importlib.util.find_spec("myriad_ode").submodule_search_locations[0]  # which need not be importable
    core = next(pathlib.Path(package).glob("_core*.so"))
    rows = loaded("myriad_ode._core", core).option_rows()
    document = DOCUMENT.read_text(encoding="utf-8")
    before, _, rest = document.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not end:
        raise SystemExit(f"{DOCUMENT.name} has no place for the table of options")
    wanted = {PYTHON: python_module(rows, option_names),
              DOCUMENT: before + BEGIN + "\n" + markdown_table(rows) + "\n" + END + after}
    wrong = 0
    for file, text in wanted.items():
        there = file.read_text(encoding="utf-8") if file.exists() else ""
        if there == text:
            continue
        if arguments == ["--fix"]:
            file.write_text(text, encoding="utf-8")
            continue
        wrong = 1
        print(f"{file.relative_to(ROOT)} is not what scripts/options.py --fix writes:")
        print("".join(difflib.unified_diff(there.splitlines(True), text.splitlines(True), "it has", "the table says")))
    return wrong


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
