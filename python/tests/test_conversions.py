# SPDX-License-Identifier: MIT
"""What results are called in datasets and tables, and which inputs are refused rather than converted."""

import numpy as np
import pytest

import myriad_ode as my


@pytest.fixture(scope="module")
def model():
    """A model whose components have the names of columns, and one that is called t."""
    time, t = my.states("time t")
    phase, count = my.parameter("phase"), my.integer_accessory("count")
    return my.model({time: phase * my.shared_integer("n"), t: 1}, accessories={my.accessory("t_start"): 7, count: None})


def solve(model, sweep=None, start=None, **options):
    return my.solve(model, my.grid(phase=[1.0, 2.0], t=[0.0, 0.5, 1.0], n=3) if sweep is None else sweep,
                    start={"time": 0, "count": 0, **(start or {})}, time=(0, 1), rtol=1e-7, interpreted=True, **options)


def test_to_xarray_keeps_components_with_names_of_its_own(model):
    pytest.importorskip("xarray")
    run = solve(model, samples=dict(states="time", evenly=3))
    data = run.to_xarray()
    assert dict(data.sizes) == {"parameter_phase": 2, "state_t_start": 3, "sample": 3}
    assert np.array_equal(data["state_t_start"], [0.0, 0.5, 1.0]) and (data["accessory_t_start_end"] == 7).all()
    assert np.array_equal(data["t_sample"].values.ravel(), run.t_sample.ravel())
    assert np.array_equal(data["time_sample"].values.ravel(), run["time"].ravel())


def test_to_pandas_keeps_a_parameter_called_phase(model):
    pytest.importorskip("pandas")
    frame = solve(model, record="time", phases=2).to_pandas()
    assert list(frame["phase"]) == [0, 1] * 6 and list(frame["parameter_phase"]) == [1.0] * 6 + [2.0] * 6
    assert np.allclose(frame["time"], 3 * frame["parameter_phase"] * (1 + frame["phase"]))


def test_records_of_a_state_called_t(model):
    run = solve(model, record=dict(states="t", time=True), phases=2)
    for key in ("state_t", my.state("t")):
        assert np.allclose(run[key][:3], [[1, 2], [1.5, 2.5], [2, 3]])
    assert (run[my.time] == 1).all() and (run["t"] == 1).all()
    assert np.allclose(solve(model, phases=2)["t"][:3], [2, 2.5, 3])  # where no times are kept


@pytest.mark.parametrize("value", [2.7, 2**40, float("nan"), float("inf")])
def test_integers_are_not_cast(model, value):
    with pytest.raises(my.Error, match="'n' is an integer and has the value"):
        solve(model, {"phase": 1.0, "n": value}, {"t": 0})
    with pytest.raises(my.Error, match="'count' is an integer and has the value"):
        solve(model, {"phase": 1.0, "n": 1}, {"t": 0, "count": [1, value]})


def test_masked_values_are_refused(model):
    masked = np.ma.array([1.0, 2.0], mask=[False, True])
    for refused in (lambda: solve(model, {"phase": masked, "n": 3}), lambda: my.grid(phase=masked),
                    lambda: my.table("A", masked), lambda: my.parameter("k") + masked[1]):
        with pytest.raises(my.Error, match="masked values"):
            refused()
    assert my.grid(phase=np.ma.array([1.0, 2.0])).size == 2
