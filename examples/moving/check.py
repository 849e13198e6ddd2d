#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Compares the tables of two programs that make the same sweep.

Usage: check.py COMMAND [ARGUMENT] -- COMMAND [ARGUMENT]

Both integrate with errors of 1e-8 per step; at the end, after some hundred steps along a limit cycle, x may differ by
1e-5. Exit status 77, "skipped" for ctest, if the second command is a script whose package is not installed.
"""

import csv
import subprocess
import sys


def table(command):
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if "ModuleNotFoundError" in done.stderr:
        print(f"Skipped: {done.stderr.splitlines()[-1]}")
        sys.exit(77)
    if done.returncode != 0:
        sys.exit(f"{command[0]} failed: {done.stderr}")
    return [(float(row["mu"]), float(row["x"])) for row in csv.DictReader(done.stdout.splitlines())]


def main():
    split = sys.argv.index("--")
    ours, theirs = table(sys.argv[1:split]), table(sys.argv[split + 1:])
    if len(ours) != 1024 or len(theirs) != len(ours):
        sys.exit(f"{len(ours)} and {len(theirs)} instances instead of 1024")
    if max(abs(a[0] - b[0]) for a, b in zip(ours, theirs)) > 1e-12:
        sys.exit("the two sweeps have different parameters")
    worst = max(abs(a[1] - b[1]) for a, b in zip(ours, theirs))
    print(f"largest difference of x: {worst:.2g}")
    if not worst < 1e-5:
        sys.exit("the two do not agree")


if __name__ == "__main__":
    main()
