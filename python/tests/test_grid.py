# SPDX-License-Identifier: MIT
"""Sweeps by name."""

import numpy as np
import pytest

import myriad_ode as my


def test_grid_varies_its_last_axis_fastest():
    sweep = my.grid(k=[1, 2], B=[0.1, 0.2, 0.3], c=5)
    assert sweep.size == 6 and sweep.shape == (2, 3) and sweep.names == ["k", "B", "c"]
    assert sweep.values("k").tolist() == [1, 1, 1, 2, 2, 2]
    assert sweep.values("B").tolist() == [0.1, 0.2, 0.3, 0.1, 0.2, 0.3]
    assert sweep.values("c").tolist() == [5] * 6
    assert [name for name, _ in sweep.axes] == ["k", "B"]
    assert sweep.unstack(np.arange(12).reshape(6, 2)).shape == (2, 3, 2)
    assert sweep.unstack(sweep.values("B"))[1, 2] == 0.3


def test_grid_accepts_symbols_and_zips():
    k, B = my.parameter("k"), my.shared("B")
    sweep = my.grid(my.zip({k: [1, 2], "d": [3, 4]}), {B: [5, 6, 7]})
    assert sweep.shape == (2, 3)
    assert sweep.values("d").tolist() == [3, 3, 3, 4, 4, 4]
    assert sweep.coordinates["d"][0] == sweep.coordinates["k"][0] == "instance"


def test_zip_takes_values_together():
    sweep = my.zip(k=np.linspace(0, 1, 5), B=0.3)
    assert sweep.shape == (5,) and sweep.axes[0][0] == "k" and sweep.constants == {"B": 0.3}
    assert my.zip(k=1.0).size == 1


@pytest.mark.parametrize("make, message", [
    (lambda: my.zip(k=[1, 2], B=[1, 2, 3]), "k has 2, B has 3"),
    (lambda: my.zip(k=[1, np.nan, 2, np.nan]), "k is NaN in 2 of 4 values, first at index 1"),
    (lambda: my.grid(k=[1, np.nan]), "k is NaN"),
    (lambda: my.grid(k=np.ones((2, 2))), r"shape \(2, 2\)"),
    (lambda: my.grid(k=[1j]), "complex"),
    (lambda: my.grid(k=["a"]), "no numbers"),
    (lambda: my.grid(my.grid(k=[1]), k=[2]), "on two axes"),
    (lambda: my.grid({my.parameter("k"): [1], "k": [2]}), "given twice"),
    (lambda: my.grid([1, 2]), "no part of a grid"),
    (lambda: my.zip({my.state("x") + 1: [1]}), "names nothing"),
    (lambda: my.grid(k=[1, 2]).values("B"), "no values of 'B'"),
    (lambda: my.grid(k=[1, 2]).unstack(np.zeros(3)), "2 instances"),
])
def test_wrong_sweeps_are_refused(make, message):
    with pytest.raises(my.Error, match=message) as error:
        make()
    assert "test_grid.py:" in str(error.value)
