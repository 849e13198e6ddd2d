#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks of the sources that compilers do not make.

Usage: check_sources.py --list              names the files with code
       check_sources.py --lines [FILE...]   no line of them is too long
       check_sources.py --tests             every header has a test at its path, or a reason why not

A test has the path of what it tests: tests/kernel/scalar/pack_test.cpp for include/myriad/kernel/scalar/pack.hpp. The
file tests/headers_without_test.txt lists the headers that have none, each with what else tests it. Exit status 1 if
something is wrong.
"""

import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
CODE = re.compile(r"\.(hpp|cuh|cpp|cu|cmake|cmake\.in|cpp\.in|py|sh)$|(^|/)(CMakeLists\.txt|\.ci/run)$")
HEADERS = re.compile(r"^(include|backends/[^/]+)/myriad/(?P<path>.+)\.(hpp|cuh)$")
COLUMNS = 120
# Lines read by programs, which cannot be broken.
UNBREAKABLE = re.compile(r"^// (expect|flags|limit|forbid): |^\s*(//|#) \S*://\S+$")


def sources():
    """All files with code, relative to the root: tracked by git, or without it all outside of generated folders."""
    listed = subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], cwd=ROOT, capture_output=True, text=True,
                            check=False)
    if listed.returncode == 0:
        names = listed.stdout.splitlines()
    else:
        names = []
        for folder, folders, files in os.walk(ROOT):
            folders[:] = [name for name in folders if name not in ("build", "results",
                                                                   "__pycache__") and not name.startswith(".")]
            names += [os.path.relpath(os.path.join(folder, name), ROOT) for name in files]
    return sorted(name for name in set(names) if CODE.search(name) and (ROOT / name).is_file())


def long_lines(names):
    """Messages about lines with too many columns."""
    messages = []
    for name in names:
        for number, line in enumerate((ROOT / name).read_text(encoding="utf-8").splitlines(), 1):
            if len(line) > COLUMNS and not UNBREAKABLE.match(line):
                messages.append(f"{name}:{number}: {len(line)} columns, not {COLUMNS} at the most")
    return messages


def untested_headers():
    """Messages about headers without a test and without a reason, and about reasons that no longer apply."""
    listing = ROOT / "tests/headers_without_test.txt"
    reasons = {}
    for line in listing.read_text(encoding="utf-8").splitlines():
        if line and not line.startswith("#"):
            header, _, reason = line.partition(": ")
            reasons[header] = reason
    messages = [f"{listing.name}: {header} has no reason" for header, reason in reasons.items() if not reason]
    unused = set(reasons)
    for name in sources():
        match = HEADERS.match(name)
        if not match or "namespace" not in (ROOT / name).read_text(encoding="utf-8"):  # it only includes others
            continue
        test = ROOT / "tests" / (match["path"] + "_test.cpp")
        named = [entry for entry in reasons if name.endswith("/" + entry)]
        unused -= set(named)
        if test.is_file() and named:
            messages.append(f"{name} has a test: take it out of {listing.name}")
        if not test.is_file() and not named:
            messages.append(f"{name} has no test {test.relative_to(ROOT)}: write one, or name it in {listing.name} "
                            "with what shows that it is right")
    return messages + [f"{listing.name}: there is no header {entry}" for entry in sorted(unused)]


def main(arguments):
    """Runs the checks selected by the arguments."""
    if arguments == ["--list"]:
        print("\n".join(sources()))
        return 0
    if arguments[:1] == ["--lines"]:
        messages = long_lines(arguments[1:] or sources())
    elif arguments == ["--tests"]:
        messages = untested_headers()
    else:
        sys.exit(__doc__.strip())
    print("\n".join(messages), end="\n" if messages else "")
    return 1 if messages else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
