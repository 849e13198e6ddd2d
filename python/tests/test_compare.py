# SPDX-License-Identifier: MIT
"""benchmarks/python/compare.py on a grid that takes no time: its programs agree with SciPy, and others are left out."""

import csv
import pathlib
import subprocess
import sys

import pytest

script = pathlib.Path(__file__).resolve().parents[2] / "benchmarks" / "python" / "compare.py"


def test_programs_are_compared_and_those_that_are_not_there_are_left_out():
    pytest.importorskip("scipy")
    done = subprocess.run([sys.executable, script, "--side", "4", "--calls", "1", "--programs", "myriad interpreted",
                           "scipy", "cubie"], capture_output=True, text=True, check=True)
    ours, theirs = csv.DictReader(done.stdout.splitlines())
    assert ours["program"] == "myriad interpreted" and theirs["program"] == "scipy"
    for row in (ours, theirs):
        assert float(row["warm_ms"]) >= float(row["shortest_ms"]) > 0
        assert float(row["median_error"]) < 0.05 and 50 < float(row["steps"]) < 100 and row["instances"] == "16"
    assert "cubie: left out" in done.stderr
