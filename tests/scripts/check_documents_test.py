#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""scripts/check_readme.py finds in made-up documents what they cite and what is not there, and nothing else."""

import importlib.util
import pathlib
import sys
import tempfile

SCRIPT = pathlib.Path(__file__).resolve().parent.parent.parent / "scripts" / "check_readme.py"

FILES = {
    "CMakePresets.json": '{"configurePresets": [{"name": "release"}]}',
    "CMakeLists.txt": 'option(MYRIAD_BUILD_TESTS "Build the tests" ON)\nadd_executable(program main.cpp)\n',
    "main.cpp": '// --size\n// snippet: part\nint x;\n// end of snippet\n',
    "scripts/go.sh": "# --quick\necho written.csv\n",
    "include/myriad/a/b.hpp": "",
}
# Documents with nothing wrong, then each with one thing wrong, and what must be said of it.
RIGHT = """
See `a/b.hpp`, `<myriad/a/b.hpp>`, `written.csv` and [the script](../scripts/go.sh).

```sh
cmake --preset release -DMYRIAD_BUILD_TESTS=OFF   # a comment
build/release/program --size 3 && scripts/go.sh --quick
echo written.csv
```
"""
WRONG = {
    "See `a/c.hpp`.": "no file `a/c.hpp`",
    "See `<myriad/b.hpp>`.": "no header is included as <myriad/b.hpp>",
    "See [this](../scripts/gone.sh).": "leads to nothing",
    "```sh\nscripts/gone.sh\n```": "there is no scripts/gone.sh",
    "```sh\nscripts/go.sh --slow\n```": "has no option --slow",
    "```sh\ncmake --preset debug\n```": "there is no preset debug",
    "```sh\ncmake -S . -DMYRIAD_BUILD_TEST=OFF\n```": "there is no option MYRIAD_BUILD_TEST",
    "```sh\nbuild/release/programme\n```": "makes programme",
    "```sh\nbuild/release/program --length 3\n```": "has no option --length",
    "```sh\nrm -r everything\n```": "occurs in no script",
    "```cpp\nint x;\n```": "code without a line",
    "```python\nx = 1\n```": "code without a line",
    "<!-- snippet: main.cpp gone -->\n```cpp\nint x;\n```": "has no snippet 'gone'",
    "<!-- snippet: main.cpp part -->\n```cpp\nint y;\n```": "differs",
}


def problems(module, text):
    document = module.ROOT / "docs" / "page.md"
    document.write_text(text, encoding="utf-8")
    found = [*module.check_commands(document), *module.check_files(document)]
    try:
        old, new = module.check(document)
        found += ["it differs"] if old != new else []
    except module.Problem as problem:
        found.append(str(problem))
    return found


def main():
    spec = importlib.util.spec_from_file_location("check_readme", SCRIPT)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    failures = 0
    with tempfile.TemporaryDirectory() as folder:
        module.ROOT = pathlib.Path(folder)
        for name, text in FILES.items():
            file = module.ROOT / name
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text, encoding="utf-8")
        (module.ROOT / "docs").mkdir()
        cases = [(RIGHT, None), *WRONG.items()]
        for text, expected in cases:
            found = problems(module, text.lstrip("\n") + ("" if text.endswith("\n") else "\n"))
            right = not found if expected is None else len(found) == 1 and expected in found[0]
            if not right:
                failures += 1
                print(f"{text!r}: expected {expected}, found {found}")
    print(f"{len(cases)} documents, {failures} of them judged wrongly")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
