# SPDX-License-Identifier: MIT
"""The examples, which are also the documentation's, run as programs; each checks its own numbers."""

import os
import pathlib
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import pytest

folder = pathlib.Path(__file__).parents[1] / "examples"
programs = sorted(str(path.relative_to(folder)) for path in folder.rglob("*.py"))


@pytest.fixture(scope="module")
def started(tmp_path_factory):
    """What each program has done, in a folder of its own; as many run at a time as there are cores."""
    def run(program):
        place = tmp_path_factory.mktemp(pathlib.Path(program).stem)
        return place, subprocess.run([sys.executable, folder / program], cwd=place, capture_output=True, text=True,
                                     env={**os.environ, "MPLBACKEND": "Agg"}, check=False)

    for package in ("libsbml", "matplotlib", "sympy", "xarray"):
        pytest.importorskip(package)
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        yield {program: pool.submit(run, program) for program in programs}


@pytest.mark.long
@pytest.mark.parametrize("program", programs)
def test_example_runs(program, started):
    place, done = started[program].result()
    assert done.returncode == 0, done.stderr
    if (program in ("cheat_sheet.py", "doses.py", "duffing.py", "global_sensitivity.py", "how_to/attractors.py",
                    "how_to/delays.py", "how_to/doses.py", "how_to/experiments.py", "how_to/patients.py",
                    "how_to/poincare.py", "noise.py",
                    "cellml.py", "sbml.py", "xpp.py")
            or program.startswith("case_studies")):
        picture = place / pathlib.Path(program).with_suffix(".png").name
        assert picture.stat().st_size > 10_000
    if program == "fit.py":
        assert (place / "fit_profile.png").stat().st_size > 10_000
    if program == "duffing.py":
        assert "4608 success" in done.stdout
