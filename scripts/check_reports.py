#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks that recorded results are not too old.

Usage: scripts/check_reports.py [--list]

Each report and table of REPORTS names the commit of the sources it was made with. Since then no more commits may have
changed the code that it depends on than stated here; changes of comments, formatting and the order of includes do not
count. No page may name a commit that is not in the history. --list only prints how old each one is. Exit status 1 if
something is wrong; 77 (skipped) where the history is not there.
"""

import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
NUMERICS = ["include/myriad/kernel"]
ON_GPUS = NUMERICS + ["backends/cuda"]
ON_CPUS = NUMERICS + ["backends/openmp"]
# file: (how it names its sources, what it depends on, commits to that which it may be older, how it is made anew).
# What needs a GPU may be older, as CI has none.
REPORTS = {
    "docs/validation.md": (r"^\* sources: (\w+)", NUMERICS, 64, "scripts/validate.sh"),
    "docs/methods.md": (r"The figures are for commit (\w+)", ON_GPUS, 96, "scripts/method_registers.py"),
    "validation/gpu/results.csv": (r"^# sources: (\w+)", ON_GPUS, 96, "scripts/validate.sh --device cuda"),
    "benchmarks/results/h200.csv": (r"^# commit: (\w+)", ON_GPUS, 96, "scripts/gpu.sh --bench"),
    "benchmarks/results/cpu.csv": (r"^# commit: (\w+)", ON_CPUS, 130, "scripts/bench.sh"),
}
CODE = re.compile(r"\.(hpp|cuh)$")


def git(*arguments):
    """What git prints, or None if it fails."""
    done = subprocess.run(["git", *arguments], cwd=ROOT, capture_output=True, text=True, check=False)
    return done.stdout if done.returncode == 0 else None


def code_of(text):
    """A source without comments, white space and includes; what is left decides what a program does."""
    text = re.sub(r"\\\n", "\n", text)
    text = re.sub(r"^[ \t]*#[ \t]*(include|pragma once).*$", "", text, flags=re.MULTILINE)
    text = re.sub(r'("(?:\\.|[^"\\\n])*")|//[^\n]*|/\*.*?\*/', lambda match: match[1] or "", text, flags=re.DOTALL)
    return re.sub(r"\s+", "", text).replace('""', "")


def changes_code(commit, folders):
    """Whether a commit changes more than comments and layout in these folders. A file that was only moved does not."""
    def sources(revision, paths):
        texts = [git("show", f"{revision}:{path}") for path in paths]
        return sorted(code_of(text) for text in texts if text is not None)

    paths = git("diff", "--name-only", "--no-renames", f"{commit}^", commit, "--", *folders)
    paths = [path for path in (paths or "").splitlines() if CODE.search(path)]
    return sources(f"{commit}^", paths) != sources(commit, paths)


def age(commit, folders):
    """The number of commits since then that change the code in these folders."""
    later = git("rev-list", "--no-merges", f"{commit}..HEAD", "--", *folders).split()
    return sum(changes_code(one, folders) for one in later)


def unknown_commits():
    """Messages about commits that pages name and the history does not have."""
    messages = []
    for name in git("ls-files", "*.md").splitlines():
        words = set(re.findall(r"\b[0-9a-f]{7}\b", (ROOT / name).read_text(encoding="utf-8")))
        for word in sorted(word for word in words if re.search(r"[a-f]", word) and re.search(r"\d", word)):
            if git("merge-base", "--is-ancestor", word, "HEAD") is None:
                messages.append(f"{name} names {word}, which is no commit of this history")
    return messages


def main(arguments):
    """Looks at all reports."""
    if arguments not in ([], ["--list"]):
        print(__doc__.strip())
        return 0 if arguments in (["-h"], ["--help"]) else 2
    top = git("rev-parse", "--show-toplevel")
    if top is None or pathlib.Path(top.strip()).resolve() != ROOT.resolve() or \
            git("rev-parse", "--is-shallow-repository").strip() == "true":
        print("skipped: the history is not there")
        return 77
    messages = unknown_commits()
    print("\n".join(messages), end="\n" if messages else "")
    wrong = len(messages)
    for name, (pattern, folders, most, command) in REPORTS.items():
        found = re.search(pattern, (ROOT / name).read_text(encoding="utf-8"), re.MULTILINE)
        if found is None or git("merge-base", "--is-ancestor", found[1], "HEAD") is None:
            print(f"{name} names no commit of this history as its sources: make it anew by {command}")
            wrong += 1
            continue
        commits = age(found[1], folders)
        if arguments or commits > most:
            print(f"{name} is {commits} changes of {', '.join(folders)} older than the sources, of at most {most}"
                  + (f": make it anew by {command}" if commits > most else ""))
        wrong += commits > most
    return 1 if wrong and not arguments else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
