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
    period_five = run["x"][-1]  # at k = 0.3
    np.testing.assert_allclose(period_five[5:], period_five[:-5], atol=1e-8)
    np.testing.assert_allclose(period_five[-1], -1.13703428619, atol=1e-8)
