# SPDX-License-Identifier: MIT
"""Inputs that contradict themselves, or are of the wrong kind: refused with a message that says what to write."""

import copy
import fractions
import pickle

import numpy as np
import pytest

import myriad_ode as my

x, v = my.states("x v")
k = my.parameter("k")
oscillator = my.model({x: v, v: -k * x}, name="oscillator")


def solve(sweep=None, **options):
    call = dict(start={x: 1, v: 0}, time=(0, 1), device="cpu", interpreted=True)
    return my.solve(oscillator, {k: 1} if sweep is None else sweep, **{**call, **options})


def study(sweep, **options):
    return my.study(oscillator, sweep, **{**dict(start={x: 1, v: 0}, time=(0, 1)), **options})


def test_two_values_for_a_component_are_refused():
    with pytest.raises(my.Error, match="'k' is given twice in the sweep: give it once"):
        solve({k: 1, "k": 2})
    with pytest.raises(my.Error, match="'x' is given twice in start=: give it once"):
        solve(start={x: 1, "x": 2, v: 0})
    with pytest.raises(my.Error, match="'x' is given twice in rtol: give it once"):
        solve(rtol={x: 1e-3, "x": 1e-6})


def test_two_values_for_a_component_of_a_study_are_refused():
    with pytest.raises(my.Error, match="'k' is given twice in the sweep: give it once"):
        study({k: [1, 2], "k": 2})
    with pytest.raises(my.Error, match="'x' is given in the sweep and in start=: give it once"):
        study({k: 1, x: [1, 2]})
    with pytest.raises(my.Error, match="'x' is given in the sweep and in start=: give it once"):
        study({k: 1, "x": [1, 2]})
    with pytest.raises(my.Error, match="'t_end' is given in the sweep and in time=: give None there"):
        study({k: 1, my.t_end: [1, 2]})


def test_a_grid_with_more_instances_than_numbers_is_refused():
    axis = np.zeros(1 << 16)  # four of them have 2^64 combinations, which is 0 in 64 bits
    with pytest.raises(my.Error, match="the sweep has 18446744073709551616 instances"):
        my.grid(k=axis, x=axis, v=axis, w=axis)


def test_values_of_the_wrong_kind_are_refused_in_words_of_the_package():
    with pytest.raises(my.Error, match=r"\[\[1\], \[1, 2\]\] is no array"):
        solve({k: [[1], [1, 2]]})
    for device in (None, 0, [1]):
        with pytest.raises(my.Error, match="is unknown: use \"auto\""):
            solve(device=device)
    with pytest.raises(my.Error, match=r"schedule is \[\]: give \"automatic\", "):
        solve(schedule=[])
    with pytest.raises(my.Error, match="the model is a type"):
        my.solve(type(oscillator), {k: 1})


def test_messages_name_arguments_of_python():
    with pytest.raises(my.Error, match="give it in the sweep$"):
        solve({k: np.nan})
    with pytest.raises(my.Error, match="give it in start=$"):
        solve(start={x: np.nan, v: 0})
    with pytest.raises(my.Error, match="give it in time=$"):
        solve(time=(0, np.nan))
    with pytest.raises(my.Error, match="give control=\"tolerance_per_instance\""):
        solve(tolerance_scale=[1])


def test_a_report_is_not_copied_and_says_so():
    report = solve().report
    for attempt in (copy.copy, copy.deepcopy, pickle.dumps):
        with pytest.raises(my.Error, match="a report cannot be pickled or copied: keep str"):
            attempt(report)
    assert not hasattr(report, "nonsense")


def test_whole_numbers_may_be_all_those_of_32_bits():
    n = my.shared_integer("n")
    model = my.model({x: my.where(n < 0, 1.0, 0.0)})
    for value, slope in ((-(1 << 31), 1), ((1 << 31) - 1, 0)):
        run = my.solve(model, {n: value}, start={x: 0}, time=(0, 1), device="cpu", interpreted=True)
        assert run["x"][0] == pytest.approx(slope, rel=1e-12)
    for value in (1 << 31, -(1 << 31) - 1, 0.5, np.nan):
        with pytest.raises(my.Error, match="give whole numbers between -2147483648 and 2147483647"):
            my.solve(model, {n: value}, start={x: 0}, time=(0, 1), device="cpu", interpreted=True)


def test_tables_of_uneven_lists_are_refused_in_words_of_the_package():
    with pytest.raises(my.Error, match=r"\[\[1\], \[1, 2\]\] is no array"):
        my.table("W", [[1], [1, 2]])
    with pytest.raises(my.Error, match="an interpolation"):
        my.interpolate(my.time, [0, 1], [[1], [1, 2]])
    with pytest.raises(my.Error, match="an interpolation"):
        my.interpolate(my.time, ["a", "b"], [0, 1])
    assert my.table("W", [fractions.Fraction(1, 4)]).values[0] == 0.25


def test_text_is_no_number_for_an_option():
    for name in ("step", "minimum_step", "maximum_step", "growth_limit", "time_limit", "phase_length"):
        for value in ("2", b"2", bytearray(b"2"), True):
            with pytest.raises(my.Error, match=f"^{name} is .*: give a number$"):
                solve(**{name: value})
        for value in (2, np.float32(2), np.array(2), fractions.Fraction(2)):
            solve(**{name: value})


def test_a_step_of_nan_is_refused():
    with pytest.raises(my.Error, match="^step is nan: give a number, or leave it out$"):
        solve(step=np.nan)
    assert solve(step=None)["x"][0] == solve()["x"][0]


def test_paths_of_the_wrong_kind_are_refused_and_bytes_are_paths(tmp_path):
    result = study({k: [1, 2]}).run()
    for use in (study({k: [1, 2]}).run, my.open_study, my.verify, result.to_csv, result.to_netcdf):
        for path, message in (("", "the path is empty"), (b"", "the path is empty"), (5, "the path is 5: give a text"),
                              (b"results\xff", "has bytes that are no characters of UTF-8"),
                              ("results\udcff", "has bytes that are no characters of UTF-8")):
            with pytest.raises(my.Error, match=message):
                use(path)
    folder = tmp_path / "of bytes"
    study({k: [1, 2]}).run(bytes(folder))
    assert my.verify(bytes(folder)) == [] and my.open_study(bytes(folder)).complete


def test_a_netcdf_file_with_a_backslash_in_its_name_is_refused(tmp_path):
    pytest.importorskip("netCDF4")
    with pytest.raises(my.Error, match="has a backslash, which netCDF takes"):
        study({k: [1, 2]}).run().to_netcdf(tmp_path / "back\\slash.nc")
    assert not list(tmp_path.iterdir())
