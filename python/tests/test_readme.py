# SPDX-License-Identifier: MIT
"""The program of the package's README runs, and draws."""

import pathlib
import re

import numpy as np


def test_the_program_of_the_readme():
    import matplotlib
    matplotlib.use("Agg")
    readme = pathlib.Path(__file__).resolve().parents[1] / "README.md"
    program, = re.findall(r"```python\n(.*?)```", readme.read_text(encoding="utf-8"), re.DOTALL)
    names = {}
    exec(program, names)  # pylint: disable=exec-used
    run = names["run"]
    assert run.report.by_status == {"success": 4608} and run["x"].shape == (4608, 32)
    last = run["x"][-1]  # k = 0.3, an orbit of five periods of the forcing
    np.testing.assert_allclose(last[5:], last[:-5], atol=1e-9)
    np.testing.assert_allclose(last[-1], -1.13703381912, atol=1e-7)  # with tolerances of 1e-13, by all methods
    assert abs(last[-1] - last[-2]) > 0.1


def test_the_readme_says_how_long_an_installation_and_the_first_result_take():
    readme = (pathlib.Path(__file__).resolve().parents[1] / "README.md").read_text(encoding="utf-8")
    assert re.search(r"`pip install \.` compiles for [\w ]+ minutes", readme)
    assert re.search(r"first result", readme)
