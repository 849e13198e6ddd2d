# SPDX-License-Identifier: MIT
"""benchmarks/python on grids that take no time: its programs agree with SciPy, and others are left out."""

import csv
import json
import os
import pathlib
import subprocess
import sys

import pytest

benchmarks = pathlib.Path(__file__).resolve().parents[2] / "benchmarks" / "python"


def told(script, *arguments, **environment):
    """What a script wrote to its standard output and its standard error."""
    done = subprocess.run([sys.executable, benchmarks / script, *arguments], env={**os.environ, **environment},
                          capture_output=True, text=True, check=True)
    return done.stdout.splitlines(), done.stderr


@pytest.fixture
def simulated(tmp_path):
    """Environment variables with which CuBIE simulates a GPU, where it is installed."""
    pytest.importorskip("cubie")
    return {"NUMBA_ENABLE_CUDASIM": "1", "CUBIE_CACHE_DIR": str(tmp_path)}


def test_programs_are_compared_and_those_that_are_not_there_are_left_out():
    pytest.importorskip("scipy")
    lines, errors = told("compare.py", "--side", "4", "--calls", "1", "--programs", "myriad interpreted", "scipy",
                         "cubie")
    ours, theirs = csv.DictReader(lines)
    assert ours["program"] == "myriad interpreted" and theirs["program"] == "scipy"
    for row in (ours, theirs):
        assert float(row["warm_ms"]) >= float(row["shortest_ms"]) > 0
        assert float(row["median_error"]) < 0.05 and 50 < float(row["steps"]) < 100 and row["instances"] == "16"
    assert "cubie: left out" in errors


def test_cubie_has_the_same_instances_in_the_same_order(simulated):
    pytest.importorskip("scipy")
    ours, theirs = (json.loads(told("compare.py", "--only", name, "--side", "4", "--calls", "1", "--rtol", "1e-6",
                                    **simulated)[0][-1])["ends"] for name in ("cubie", "scipy"))
    assert len(ours) == 16 and ours == pytest.approx(theirs, abs=1e-3)


@pytest.mark.parametrize("precision", ["double", "float"])
def test_cubies_kernel_is_timed(precision, simulated):
    lines, _ = told("van_der_pol.py", "--only", "cubie", precision, "--side", "2", "--calls", "1", **simulated)
    times = {what: float(milliseconds) for _, real, what, milliseconds in csv.reader(lines) if real == precision}
    assert times.keys() == {"cold", "call and results", "kernel"} and min(times.values()) > 0
