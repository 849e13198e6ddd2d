# SPDX-License-Identifier: MIT
"""The examples, which are also the documentation's, run as programs; each checks its own numbers."""

import os
import pathlib
import subprocess
import sys

import pytest

folder = pathlib.Path(__file__).parents[1] / "examples"


@pytest.mark.parametrize("program", sorted(path.name for path in folder.glob("*.py")))
def test_example_runs(program, tmp_path):
    for package in ("matplotlib", "sympy", "xarray"):
        pytest.importorskip(package)
    done = subprocess.run([sys.executable, folder / program], cwd=tmp_path, capture_output=True, text=True,
                          env={**os.environ, "MPLBACKEND": "Agg"})
    assert done.returncode == 0, done.stderr
    if program == "duffing.py":
        assert "4608 success" in done.stdout and (tmp_path / "duffing.png").stat().st_size > 10_000
