#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The version, and whether all files agree on it.

    version.py           prints it
    version.py --check   what names another than include/myriad/version.hpp; exit status 1 if something does
    version.py --release the same, and CHANGELOG.md must have a section of it with a date

CMakeLists.txt and the Conan recipe read that header; CITATION.cff, README.md and the Spack recipe repeat it.
"""
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def found(path, pattern):
    """What the pattern's group matches in the file, everywhere."""
    return re.findall(pattern, (ROOT / path).read_text(encoding="utf-8"), re.MULTILINE)


def version():
    """The version in the header, whose numbers must be those of its text."""
    numbers = [found("include/myriad/version.hpp", rf"MYRIAD_VERSION_{part} (\d+)$") for part in
               ("MAJOR", "MINOR", "PATCH")]
    text = found("include/myriad/version.hpp", r'MYRIAD_VERSION "(.*)"$')
    space = found("include/myriad/kernel/core/abi.hpp", r"MYRIAD_ABI v(.*)$")
    if len(text) != 1 or text[0] != ".".join(sum(numbers, [])) or space != [text[0].replace(".", "_")]:
        sys.exit(f"include/myriad/version.hpp: MYRIAD_VERSION is {text}, its numbers are {numbers}, and MYRIAD_ABI is "
                 f"{space}")
    return text[0]


def disagreements(now, release):
    """One message for each file that says something else."""
    short = ".".join(now.split(".")[:2])
    for path, pattern, expected in (
            ("CITATION.cff", r"^version: (.*)$", now),
            ("README.md", r"find_package\(myriad (\S+) REQUIRED", short),
            ("README.md", r"^Version ([\d.]+) ", now),
            ("packaging/spack/package.py", r'^    version\("([\d.]+)"', now)):
        said = found(path, pattern)
        if not said or said[0] != expected:
            yield f"{path} says {said[0] if said else 'nothing'}, not {expected}"
    sections = found("CHANGELOG.md", r"^## \[([^\]]+)\]")
    versions = [section for section in sections if section != "Unreleased"]
    if release and not found("CHANGELOG.md", rf"^## \[{re.escape(now)}\] - \d{{4}}-\d\d-\d\d$"):
        yield f"CHANGELOG.md has no section '## [{now}] - YYYY-MM-DD': move what is Unreleased to it"
    if not sections or (versions and sorted(map(numbers_of, versions))[-1] > numbers_of(now)):
        yield f"CHANGELOG.md has sections {', '.join(sections) or 'none'}, and the version is {now}"


def numbers_of(text):
    return [int(part) for part in text.split(".")]


def main(arguments):
    now = version()
    if not arguments:
        print(now)
        return 0
    if arguments not in (["--check"], ["--release"]):
        sys.exit(__doc__.strip())
    messages = list(disagreements(now, arguments == ["--release"]))
    print("\n".join(messages) or f"All files agree on version {now}.")
    return 1 if messages else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
