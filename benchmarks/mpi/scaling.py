#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""How much faster two ranks of one core each are than one: the study of examples/mpi, run in turns.

Usage: scaling.py MPI_STUDY [--ranks 1,2] [--repeat 5] [--instances 20000]

Prints CSV: ranks, the median time of a run with mpirun's start and of the study alone (its slowest rank), and the
speedup over the first number of ranks in the same repetition: its median, least and largest value. `processes` are as
many processes that share the folder without MPI, by claims alone. A number of ranks above that of cores shows nothing.
"""

import argparse
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile
import time

MPIRUN = pathlib.Path(__file__).resolve().parents[2] / "examples/common/mpirun.sh"
DONE = re.compile(r"^rank \d+ of (\d+), .*: (\d+) of (\d+) instances in ([0-9.e+-]+) s$", re.MULTILINE)


def run(command, processes, instances):
    """Seconds of all, and of the slowest process' study; all instances must have been done once."""
    begin = time.perf_counter()
    started = [subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
               for _ in range(processes)]
    texts = [process.communicate() for process in started]
    seconds = time.perf_counter() - begin
    found = [match for out, _ in texts for match in DONE.findall(out)]
    if any(process.returncode for process in started) or sum(int(match[1]) for match in found) != instances:
        sys.exit(f"{' '.join(command)} failed: {texts}")
    return seconds, max(float(match[3]) for match in found)


def main():
    """Measures and prints."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--ranks", default="1,2")
    parser.add_argument("--repeat", type=int, default=5)
    parser.add_argument("--instances", type=int, default=20000)
    asked = parser.parse_args()
    ranks = [int(number) for number in asked.ranks.split(",")]
    kinds = [("ranks", n) for n in ranks] + [("processes", n) for n in ranks[1:]]
    times = {kind: [] for kind in kinds}
    for _ in range(asked.repeat):
        for kind, n in kinds:
            with tempfile.TemporaryDirectory() as folder:
                program = [asked.program, folder + "/study", str(asked.instances)]
                one_core = [str(MPIRUN), "--bind-to", "core", "-n"]
                if kind == "ranks":
                    times[kind, n].append(run(one_core + [str(n)] + program, 1, asked.instances))
                else:
                    times[kind, n].append(run(one_core + ["1"] + program, n, asked.instances))
    print("kind,number,seconds,seconds_of_study,speedup_of_study,smallest,largest")
    for (kind, n), measured in times.items():
        speedups = [first[1] / this[1] for first, this in zip(times[kinds[0]], measured)]
        print(f"{kind},{n},{statistics.median(t for t, _ in measured):.2f},"
              f"{statistics.median(t for _, t in measured):.2f},{statistics.median(speedups):.2f},"
              f"{min(speedups):.2f},{max(speedups):.2f}")


if __name__ == "__main__":
    main()
