# SPDX-License-Identifier: MIT
"""One quantity has one name, in runs, studies, datasets, tables and files, and in all calls."""

import csv
import inspect
import pkgutil
import types

import numpy as np
import pytest

import myriad_ode as my

x, v = my.states("x v")
k, B, a = my.parameter("k"), my.shared("B"), my.accessory("a")
model = my.model({x: v, v: -k * x + B}, name="spring", finalise={a: x * v})
sweep = my.grid({k: [1.0, 4.0], x: [1.0, 2.0, 3.0]}, {B: 0.5})
call = dict(start={v: 0.25}, time=(0, 2), phases=2, record=dict(states=[x], time=True), rtol=1e-9)


def solved(**more):
    return my.solve(model, sweep, interpreted=True, device="cpu", **{**call, **more})


def studied(store=None, **more):
    return my.study(model, sweep, interpreted=True, keep=dict(end=[x, v, a, my.time], work=True),
                    **{**call, **more}).run(store, device="cpu")


@pytest.mark.parametrize("more", [{}, {"samples": 3}, {"record": None, "samples": 3}])
def test_a_run_has_all_that_a_study_has_under_the_same_names(more):
    run, result = solved(**more), studied(**more)
    assert set(result) - set(run) == {"phases_done", "accepted_steps", "rejected_steps", "located_steps",
                                      "rhs_evaluations"}  # which datasets of a run leave out
    for name in result:
        if name in ("phase", "k", "x_start"):  # which a study has along their axes
            assert set(np.ravel(run[name])) == set(result[name])
        else:
            np.testing.assert_array_equal(np.reshape(run[name], np.shape(result[name])), result[name], err_msg=name)
    for key in (x, "x", v, a, k, my.time):
        assert np.shape(run[key])[1:] == np.shape(result[key])[2:]


def test_datasets_of_runs_and_studies_have_the_same_names_and_dimensions():
    pytest.importorskip("xarray")
    of_run, of_study = solved(samples=3).to_xarray(), studied(samples=3).to_xarray()
    work = {"phases_done", "accepted_steps", "rejected_steps", "located_steps", "rhs_evaluations"}
    assert set(of_study.variables) - work == set(of_run.variables)
    for name in set(of_run.variables):
        assert of_run[name].dims == of_study[name].dims, name
        np.testing.assert_array_equal(of_run[name].values, of_study[name].values)
        assert of_run[name].attrs.get("units") == of_study[name].attrs.get("units")
    assert of_run.x.dims == ("k", "x_start", "phase") and of_run.x_sample.dims == ("k", "x_start", "sample")


def test_a_name_of_a_dataset_is_one_of_the_run():
    pytest.importorskip("xarray")
    run = solved(samples=3)
    data = run.to_xarray()
    assert set(data.variables) == set(run)
    for name in run:
        np.testing.assert_array_equal(np.unique(data[name].values), np.unique(run[name]))


def test_tables_have_the_names_of_the_run():
    pytest.importorskip("pandas")
    assert set(solved(record=None).to_pandas()) == {"instance", "k", "x_end", "v_end", "a_end", "t_last", "status"}
    assert set(solved().to_pandas()) == {"instance", "phase", "k", "x", "t", "status"}
    assert set(solved(record=None, samples=3).to_pandas()) == {"instance", "t_sample", "k", "x_sample", "v_sample",
                                                               "status"}


def test_a_table_of_text_says_how_instances_ended_in_words(tmp_path):
    result = studied(max_steps=6)
    result.to_csv(tmp_path / "study.csv")
    with open(tmp_path / "study.csv") as file:
        rows = list(csv.DictReader(file))
    assert {"k", "x_start", "x_end", "t_last", "status", "accepted_steps"} <= set(rows[0])
    assert [row["status"] for row in rows] == result.status.ravel().tolist()
    assert set(result.status.ravel()) == set(result.by_status)


def test_statuses_are_words_everywhere_and_numbers_by_another_name(tmp_path):
    pytest.importorskip("xarray")
    run = solved(max_steps=6)
    result = studied(tmp_path / "store", max_steps=6)
    assert set(run.status) == {"max_steps"} and (run["status"] == "max_steps").all() and run.failed.all()
    assert (result.status == "max_steps").all() and result.failed.all() and result.failed.shape == (2, 3)
    for one in (run, result):
        assert [my.status_names[code] for code in one.status_codes.ravel()] == one.status.ravel().tolist()
    assert (run.to_xarray().status == "max_steps").all()
    lazily = result.to_xarray().status
    assert not lazily.variable._in_memory and (lazily == "max_steps").all() and "flag_meanings" not in lazily.attrs
    assert lazily.isel(k=1, x_start=slice(0, 2)).values.tolist() == ["max_steps"] * 2


def test_what_a_study_has_not_done_has_not_been_started(tmp_path):
    study = my.study(model, sweep, interpreted=True, keep=[x], **{**call, "record": None})
    with pytest.raises(ZeroDivisionError):
        study.run(tmp_path / "store", device="cpu:1", chunk=1, progress=lambda done, total: 1 / (done < 2))
    result = my.open_study(tmp_path / "store")
    words = set(result.status.ravel())
    if not result.complete:
        assert words == {"success", "not_started"} and (result.to_csv(tmp_path / "part.csv") is None)
        with open(tmp_path / "part.csv") as file:
            assert {row["status"] for row in csv.DictReader(file)} == words
    assert not result.failed.any()


def test_a_sum_of_a_study_sees_statuses_in_words():
    count = my.reduce.total("ended", [], 1, lambda chunk: [(chunk["status"] == "success").sum()])
    assert studied(reduce=count)["ended"] == 6


def test_a_component_with_a_name_of_the_results_has_its_kind_in_front_in_runs_and_studies():
    t, status, end = my.state("t"), my.parameter("status"), my.parameter("t_end")
    odd = my.model({t: status * end}, name="odd")
    call = dict(start={t: 1}, time=(0, 2), record=dict(states=[t], time=True), interpreted=True)
    given = my.grid({status: [1.0, 2.0]}, {end: 3})
    run = my.solve(odd, given, device="cpu", **call)
    study = my.study(odd, given, keep=[t], **call).run(device="cpu")
    for one in (run, study):
        assert {"state_t", "state_t_end", "state_t_start", "t", "parameter_status", "status", "t_end"} <= set(one)
        np.testing.assert_allclose(np.ravel(one[t]), [7, 13])
        np.testing.assert_array_equal(one[status], [1, 2])
        np.testing.assert_array_equal(np.ravel(one["t"]), [2, 2])
        assert (one["status"] == "success").all() and one["t_end"] == 2
    assert "parameter_t_end" in run.to_xarray() and "parameter_t_end" in study.to_xarray()


def test_a_parameter_that_hooks_change_is_there_as_it_was_given_and_as_it_is_at_the_end():
    growing = my.model({x: k}, finalise={k: 2 * k}, name="growing")
    call = dict(start={x: 0}, time=(0, 1), phases=2, interpreted=True)
    run = my.solve(growing, {k: [1.0, 2.0]}, device="cpu", **call)
    result = my.study(growing, {k: [1.0, 2.0]}, keep=[x, k], **call).run(device="cpu")
    for one in (run, result):
        np.testing.assert_array_equal(one["k"], [1, 2])
        np.testing.assert_array_equal(one["k_end"], [4, 8])


def test_what_has_another_name_now_says_so():
    run, result = solved(samples=3), studied(samples=3)
    with pytest.raises(AttributeError, match="run.t has another name: use run.t_last"):
        _ = run.t
    with pytest.raises(AttributeError, match="use run.t_sample"):
        _ = run.sample_times
    with pytest.raises(AttributeError, match="use run.accepted_steps, rejected_steps"):
        run.steps()
    with pytest.raises(AttributeError, match="there is no run.stepz"):
        _ = run.stepz
    for one in (run, result):
        for before, now in (("x_begin", "x_start"), ("x_samples", "x_sample"), ("samples_stored", "stored_samples")):
            with pytest.raises(KeyError, match=f"'{before}' has another name: use '{now}'"):
                _ = one[before]
        with pytest.raises(KeyError, match="'y' is no name of the results"):
            _ = one["y"]
    with pytest.raises(my.Error, match="no option 'sensitivities'.*give free="):
        solved(sensitivities=[k])
    with pytest.raises(TypeError, match="free"):
        my.batched(model, by=[k], of=x)


def test_free_names_what_derivatives_are_by_in_every_call():
    for function in (my.solve, my.batched, my.fit, my.least_squares, my.with_sensitivities):
        parameters = inspect.signature(function).parameters
        assert "free" in parameters and not {"by", "sensitivities", "wrt"} & set(parameters)


def packages():
    yield my
    for found in pkgutil.walk_packages(my.__path__, f"{my.__name__}."):
        if found.ispkg:
            yield __import__(found.name, fromlist=["_"])


def test_no_module_of_the_package_is_hidden_by_something_of_its_name():
    seen = 0
    for package in packages():
        for found in pkgutil.iter_modules(package.__path__):
            try:
                __import__(f"{package.__name__}.{found.name}")
            except ImportError:  # of another package that is not there
                continue
            there = getattr(package, found.name)
            assert isinstance(there, types.ModuleType) and there.__name__ == f"{package.__name__}.{found.name}"
            seen += 1
    assert seen > 80


def test_no_public_function_has_the_name_of_a_module_beside_it():
    modules = {found.name for found in pkgutil.iter_modules(my.__path__)}
    assert not modules & {name for name in dir(my) if not isinstance(getattr(my, name), types.ModuleType)}
