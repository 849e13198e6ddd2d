#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks README.md, CONTRIBUTING.md, CHANGELOG.md, other README.md and docs/ against the sources: code, commands and
files.

Usage: scripts/check_readme.py [--fix]

Code: a line `<!-- snippet: FILE NAME -->` before a fenced block says where the block comes from: the lines of FILE
between `snippet: NAME` and `end of snippet` (comments of FILE; several such parts are joined), or without NAME all
lines below its heading. A block of C++, CMake, Python or another programming language without such a line is an error;
code of other packages, which is not built here, has `<!-- shown: SOURCE -->` instead, where it comes from.

Commands: in a block of shell without a snippet every script, program, CMake preset, target and option must exist, and
other commands must occur, letter for letter, in a script or a test.

Files: a link to a file must lead to one, and a path in backticks must be the end of a path in the repository, or the
name of a file that some program or script writes.

Messages: those that docs/troubleshooting.md cites in the first column of a table occur in the library, and it has a row
for every status.

Exit status 1 if something differs or is not there (--fix rewrites blocks of code instead), 2 if a snippet is missing.
"""

import difflib
import functools
import json
import os
import pathlib
import re
import shlex
import sys
import textwrap

ROOT = pathlib.Path(__file__).resolve().parent.parent
MARK = re.compile(r"<!-- snippet: (?P<file>\S+)(?: (?P<name>\w+))? -->")
BEGIN = re.compile(r"^\s*(//|#)\s*snippet: (?P<name>\w+)\s*$")
END = re.compile(r"^\s*(//|#)\s*end of snippet\s*$")
SHOWN = re.compile(r"<!-- shown: (?P<source>\S.*) -->")
CHECKED_LANGUAGES = ("cpp", "c++", "cmake", "python", "julia", "cuda")
SHELL = ("sh", "bash", "console")
DOCUMENTS = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "benchmarks/README.md", "validation/gpu/README.md")
SKIPPED_FOLDERS = {".git", "build", ".cache", ".deps", "__pycache__"}  # and results of runs
FILE_ENDINGS = "hpp|cuh|cpp|cu|py|sh|cmake|md|csv|txt|png|svg|in|json|jl"


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
    new, mark, shown, i = [], None, None, 0
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
            elif line[3:].strip() in CHECKED_LANGUAGES and not shown:
                raise Problem(f"{document.name}:{i}: code without a line <!-- snippet: FILE NAME -->")
            else:
                new += old[i:end]
            new.append(old[end])
            mark, shown, i = None, None, end + 1
        elif line.strip():
            if mark:
                raise Problem(f"{document.name}:{i}: the snippet {mark[0]} is not followed by a block")
            mark, shown = MARK.fullmatch(line.strip()), SHOWN.fullmatch(line.strip())
    return "\n".join(old) + "\n", "\n".join(new) + "\n"


@functools.cache
def all_files():
    """The files of the repository, as paths from its root."""
    found = []
    for folder, folders, names in os.walk(ROOT):
        folders[:] = [name for name in folders if name not in SKIPPED_FOLDERS and
                      (name != "results" or pathlib.Path(folder) != ROOT)]
        found += [str(pathlib.Path(folder, name).relative_to(ROOT)) for name in names]
    return found


@functools.cache
def text_of(path):
    try:
        return (ROOT / path).read_text(encoding="utf-8")
    except UnicodeDecodeError:
        return ""


@functools.cache
def programs_and_scripts():
    """The text of everything that may write a file or run a command: no documents."""
    return "\n".join(text_of(f) for f in all_files()
                     if f.endswith((".sh", ".py", ".cpp", ".hpp", ".cmake", ".in", "CMakeLists.txt")))


@functools.cache
def presets():
    found = json.loads(text_of("CMakePresets.json"))
    return {p["name"] for kind in ("configurePresets", "buildPresets", "testPresets") for p in found.get(kind, [])}


def option_of(word):
    """The option that a word is; all programs have --help, those with CLI11 without naming it."""
    return word.split("=")[0] if word.startswith("--") and word not in ("--", "--help") else None


def is_in_sources(word, files):
    return any(re.search(rf"(?<![\w-]){re.escape(word)}(?![\w-])", text_of(f)) for f in files)


def problem_of_command(words, line):
    """What a command names that does not exist, or None."""
    while words and re.match(r"[A-Z_]+=", words[0]):
        words = words[1:]
    if not words:
        return None
    command, options = words[0], [w for w in words[1:] if option_of(w)]
    if command in ("python3", "bash"):
        command = next((w for w in words[1:] if not w.startswith("-")), command)
    if re.match(r"(scripts|tests|examples|benchmarks|validation|\.ci)/", command):
        if command not in all_files():
            return f"there is no {command}"
        folder = os.path.dirname(command)
        # A script may pass options on, to programs beside it or to what it sources.
        sources = [command] + [f for f in all_files() if f.startswith((folder + "/", "examples/common/"))
                               and f.endswith((".py", ".sh", ".hpp", ".cpp"))]
        return next((f"{command} has no option {w}" for w in options if not is_in_sources(option_of(w), sources)), None)
    built = re.match(r"build/([\w+,.-]+)/(?:(.*)/)?([\w.+-]+)$", command)
    if built:
        preset, folder, name = built[1], built[2] or "", built[3]
        made_by_a_script = rf"build/{re.escape(preset.split('-')[0])}"
        if preset not in presets() and not re.search(made_by_a_script, programs_and_scripts()):
            return f"there is no preset {preset}"
        lists = [f for f in all_files() if f.endswith("CMakeLists.txt") and f.startswith(folder)]
        # Some are named by a loop: validate_${problem}.
        made = is_in_sources(name, lists) or is_in_sources(name.removeprefix("validate_"), lists)
        if not made:
            return f"no CMakeLists.txt in '{folder}' makes {name}"
        top = folder.split("/")[0]
        sources = [f for f in all_files() if f.startswith(top + "/" if top else "") and f.endswith((".cpp", ".hpp"))]
        return next((f"{name} has no option {w}" for w in options if not is_in_sources(option_of(w), sources)), None)
    if command in ("cmake", "ctest"):
        for flag, value in zip(words, words[1:]):
            if flag == "--preset" and value not in presets():
                return f"there is no preset {value}"
            if flag == "-S" and value.startswith("examples/") and f"{value}/CMakeLists.txt" not in all_files():
                return f"there is no {value}"
            if flag == "--target" and not re.search(rf"\b{re.escape(value)}\b|check_\$", "\n".join(
                    text_of(f) for f in all_files() if f.endswith("CMakeLists.txt"))):
                return f"there is no target {value}"
        cmake = [f for f in all_files() if f.endswith((".cmake", "CMakeLists.txt"))]
        for word in words[1:]:
            variable = re.match(r"-D(MYRIAD_\w+)", word)
            if variable and not is_in_sources(variable[1], cmake):
                return f"there is no option {variable[1]}"
        return None
    if line in programs_and_scripts():
        return None
    return "it occurs in no script and no test"


def check_commands(document):
    """What is wrong with the commands in blocks of shell that are no snippets."""
    lines = document.read_text(encoding="utf-8").splitlines()
    marked, block, command = False, None, ""
    for number, line in enumerate(lines, 1):
        if block is None:
            if line.startswith("```"):
                block = "shell" if line[3:].strip() in SHELL and not marked else "other"
            elif line.strip():
                marked = bool(MARK.fullmatch(line.strip()) or SHOWN.fullmatch(line.strip()))
            continue
        if line.rstrip() == "```":
            block, marked = None, False
            continue
        if block == "other":
            continue
        command += line.strip()
        if command.endswith("\\"):
            command = command[:-1]
            continue
        command = re.sub(r"(^|\s+)#.*", "", command)
        for part in re.split(r"\s*(?:&&|;|\|)\s*", re.sub(r"\s*[<>]\s*\S+", "", command)):
            try:
                problem = problem_of_command(shlex.split(part), part) if part else None
            except ValueError as error:
                problem = str(error)
            if problem:
                yield f"{document.relative_to(ROOT)}:{number}: '{part}': {problem}"
        command = ""


def check_files(document):
    """The files that a document cites and that do not exist."""
    text = document.read_text(encoding="utf-8")
    text = re.sub(r"^```.*?^```$", lambda block: "\n" * block[0].count("\n"), text, flags=re.M | re.S)
    here = document.parent.relative_to(ROOT)
    for number, line in enumerate(text.splitlines(), 1):
        where = f"{document.relative_to(ROOT)}:{number}"
        for link in re.findall(r"\]\(([^)\s]+)\)", line):
            file = link.split("#")[0]
            if not file or re.match(r"[a-z]+:", link):
                continue
            if file.startswith("reference/") or "/reference/" in file:  # scripts/reference.py writes it
                continue
            if not (ROOT / here / file).exists():
                yield f"{where}: the link to {file} leads to nothing"
        for token in re.findall(r"`([^`\s]+)`", line):
            path = token.removeprefix("<").removesuffix(">").removeprefix("myriad/").removeprefix("./")
            if not re.fullmatch(rf"[\w./-]+\.({FILE_ENDINGS})", path) or path.startswith("build/"):
                continue
            if token.startswith("<"):  # as a program includes it
                found = any(f in (f"include/myriad/{path}", f"backends/openmp/myriad/{path}",
                                  f"backends/cuda/myriad/{path}") for f in all_files())
            else:
                found = any(f == path or f.endswith("/" + path) for f in all_files())
            if found:
                continue
            if token.startswith("<"):
                yield f"{where}: no header is included as {token}"
                continue
            if not re.search(rf"(?<![\w.]){re.escape(os.path.basename(path))}(?!\w)", programs_and_scripts()):
                yield f"{where}: there is no file `{token}`, and nothing writes one"


@functools.cache
def messages():
    """The text of all string literals of the library and of its CMake files, those that stand in a row joined."""
    files = [f for f in all_files() if f.startswith(("include/", "src/", "backends/", "cmake/"))]
    return "".join(re.findall(r'"((?:[^"\\\n]|\\.)*)"', "\n".join(text_of(f) for f in files)))


def check_troubleshooting(document):
    """Messages that the page about troubleshooting cites and the library does not have, statuses that it leaves out."""
    text = document.read_text(encoding="utf-8")
    for number, line in enumerate(text.splitlines(), 1):
        cited = re.match(r"\| `([^`]* [^`]*)` \|", line)
        if cited and cited[1] not in messages():
            yield f"{document.relative_to(ROOT)}:{number}: no message has '{cited[1]}'"
    enumeration = re.search(r"enum class status.*?\{(.*?)\n\};", text_of("include/myriad/kernel/core/status.hpp"), re.S)
    for status in re.findall(r"^    (\w+),", enumeration[1], re.M):
        if not re.search(rf"^\| `{status}` \|", text, re.M):
            yield f"{document.relative_to(ROOT)}: says nothing about the status {status}"


def main(arguments):
    if arguments in (["-h"], ["--help"]):
        print(__doc__.strip())
        return 0
    if arguments not in ([], ["--fix"]):
        raise Problem("Usage: scripts/check_readme.py [--fix]")
    different = False
    documents = [*(ROOT / name for name in DOCUMENTS), *sorted((ROOT / "docs").rglob("*.md"))]
    problems = [p for document in documents for p in (*check_commands(document), *check_files(document))]
    problems += check_troubleshooting(ROOT / "docs" / "troubleshooting.md")
    for problem in problems:
        print(problem)
    for document in documents:
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
    return 1 if different or problems else 0


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except Problem as problem:
        print(problem, file=sys.stderr)
        sys.exit(2)
