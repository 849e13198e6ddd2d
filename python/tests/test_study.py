# SPDX-License-Identifier: MIT
"""Studies against `solve`, in memory, in stores and after a stop."""

import json
import os
import pathlib
import pickle
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import myriad_ode as my
from myriad_ode.studies import store_slices

x, v = my.states("x v")
k, B = my.parameter("k"), my.shared("B")


def duffing():
    return my.model({x: v, v: x - x**3 - k * v + B * my.cos(my.time)})


def grid(n=25):
    return my.grid({k: my.linspace(0.2, 0.3, n), x: [-0.5, 0.1, 0.2]}, {B: 0.3})


call = dict(start={v: -0.1}, time=(0, 2 * np.pi), phases=3, record=dict(from_phase=1, states=[x], time=True), rtol=1e-9)


@pytest.mark.parametrize("interpreted", [False, True])
def test_a_study_has_the_bits_of_solve(tmp_path, interpreted):
    expected = my.solve(duffing(), grid(), interpreted=interpreted, **call)
    study = my.study(duffing(), grid(), interpreted=interpreted, keep=[x, v, my.time], **call)
    assert study.size == 75
    for store in (None, tmp_path / "store"):
        result = study.run(store, chunk=16)
        assert result.complete and result.instances == result.done == 75 and result.by_status == {"success": 75}
        assert result.axes == {"k": 25, "x_start": 3} and result.shape == (25, 3)
        np.testing.assert_array_equal(result["x"], expected["x"].reshape(25, 3, 2))
        np.testing.assert_array_equal(result["t"], expected[my.time].reshape(25, 3, 2))
        np.testing.assert_array_equal(result["v_end"], expected["v"].reshape(25, 3))
        np.testing.assert_array_equal(result["t_last"], expected.t_last.reshape(25, 3))
        np.testing.assert_array_equal(result["k"], np.linspace(0.2, 0.3, 25))
        assert result["B"] == 0.3
        assert result.kernel.startswith("interpreted") == interpreted
    assert result.description["notes"]["kernel"] == ("interpreted" if interpreted else "compiled")


def test_results_open_in_xarray_lazily(tmp_path):
    xarray = pytest.importorskip("xarray")
    study = my.study(duffing(), grid(), keep=[x], reduce=[my.reduce.mean("x_end")], units={x: "m"}, **call)
    here = study.run().to_xarray()
    stored = study.run(tmp_path / "store", chunk=7)
    there = stored.to_xarray()
    assert not there["x"].variable._in_memory  # until it is used
    part = there["x"].isel(k=slice(20, 3, -3), x_start=1)
    np.testing.assert_array_equal(part.values, here["x"].values[20:3:-3, 1])
    np.testing.assert_array_equal(there["x"][4].values, here["x"].values[4])
    np.testing.assert_array_equal(there["x_end"].sel(x_start=0.2, k=0.3).values, here["x_end"].values[-1, -1])
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(there))["x"].values, here["x"].values)
    xarray.testing.assert_identical(there.load(), here)
    assert there["x"].dims == ("k", "x_start", "phase") and there["x"].attrs["units"] == "m"
    np.testing.assert_array_equal(there["phase"], [1, 2])
    assert not there["status"].variable.attrs.keys() & {"flag_values", "flag_meanings"}
    assert (there["status"] == "success").all() and there["status"].dtype.kind == "U"
    assert json.loads(there.attrs["myriad_study"])["options"]["phases"] == 3


def test_a_store_is_a_zarr_group(tmp_path):
    zarr = pytest.importorskip("zarr", minversion="3")
    result = my.study(duffing(), grid(), keep=[x], **call).run(tmp_path / "store", chunk=7)
    group = zarr.open_group(tmp_path / "store", mode="r")
    np.testing.assert_array_equal(group["x_end"][:], result["x_end"].ravel())


@pytest.mark.parametrize("package", ["netCDF4", "h5netcdf.legacyapi"])
def test_netcdf_is_written_part_by_part(tmp_path, package, monkeypatch):
    xarray = pytest.importorskip("xarray")
    module = pytest.importorskip(package)
    if package != "netCDF4":
        pytest.importorskip("h5py")
    monkeypatch.setattr("myriad_ode.studies.result._netcdf_package", lambda: module.Dataset)
    monkeypatch.setattr("myriad_ode.studies.result.blocks", lambda lengths, most: store_slices.blocks(lengths, 8))
    result = my.study(duffing(), grid(), keep=[x], reduce=my.reduce.minimum("x"), **call).run(tmp_path / "store")
    result.to_netcdf(tmp_path / "study.nc")
    assert sorted(os.listdir(tmp_path)) == ["store", "study.nc"]
    with xarray.open_dataset(tmp_path / "study.nc", engine=package.partition(".")[0].lower()) as read:
        expected = result.to_xarray()
        assert set(read.variables) == set(expected.variables) and set(read.coords) == set(expected.coords)
        assert read["status"].flag_meanings.split() == [s for s in my.status_names if s != "interrupted"]
        np.testing.assert_array_equal(read["status"].values, result.status_codes)
        for name in set(expected.variables) - {"status"}:
            np.testing.assert_array_equal(read[name].values, expected[name].values)
        for name in expected.variables:
            assert read[name].dims == expected[name].dims


def test_blocks_cover_a_grid():
    for lengths in ((), (7,), (3, 5), (2, 3, 4), (1, 1)):
        for most in (1, 4, 100):
            seen = np.zeros(lengths, int)
            for key in store_slices.blocks(lengths, most):
                seen[key] += 1
                assert seen[key].size <= most
            assert (seen == 1).all()


def test_axes_of_every_kind():
    model = duffing()
    many = my.study(model, my.grid(my.zip({k: [0.2, 0.3], x: [1.0, 2.0]}), {v: my.geomspace(1, 100, 3), B: 0.3}),
                    time=(0, 0), draws=4).run()
    assert many.shape == (2, 3, 4)
    np.testing.assert_allclose(many["v_end"][0, :, 0], [1, 10, 100])
    np.testing.assert_array_equal(many["x_end"][:, 2, 3], [1, 2])
    paired = my.study(model, {"k": np.linspace(0, 1, 5), "B": 0.3}, start={"x": my.linspace(1, 5, 5), v: 0},
                      time=(0, 0)).run()
    np.testing.assert_array_equal(paired["x_end"], [1, 2, 3, 4, 5])
    ends = my.study(my.model({x: 1.0}), my.grid({my.t_end: [1.0, 2.0, 5.0]}), start={x: 0}, time=(0, None),
                    interpreted=True).run()
    np.testing.assert_allclose(ends["x_end"], [1, 2, 5])
    assert np.asarray(my.linspace(0, 1, 3)).tolist() == [0, 0.5, 1]
    here = my.solve(model, my.grid({k: my.linspace(0, 1, 3)}, {B: 0.3}), start={x: 1, v: 0}, time=(0, 1))
    np.testing.assert_array_equal(here["k"], [0, 0.5, 1])


def test_random_values_depend_on_the_seed_and_the_instance():
    def drawn(seed, **more):
        study = my.study(duffing(), {k: my.uniform(0.2, 0.3), B: 0.3}, start={x: my.normal(1, 2), v: 0},
                         time=(0, 0), draws=2000, seed=seed, **more)
        return study.run(chunk=300)
    first = drawn(1)
    np.testing.assert_array_equal(first["x_start"], first["x_end"])
    assert 0.2 <= first["k"].min() < 0.201 and 0.299 < first["k"].max() < 0.3
    assert abs(first["x_end"].mean() - 1) < 5 * 2 / 2000**0.5 and abs(first["x_end"].std() - 2) < 0.2
    np.testing.assert_array_equal(first["k"], drawn(1)["k"])
    assert (first["k"] != drawn(2)["k"]).all()
    assert "k" not in drawn(1, keep=dict(end=[x], random=False)).names
    with pytest.raises(my.Error, match="is drawn for each instance of a study"):
        my.solve(duffing(), {k: my.uniform(0, 1), B: 0.3}, start={x: 1, v: 0}, time=(0, 1))


def test_random_values_in_a_grid_are_those_of_a_sweep():
    def drawn(sweep):
        return my.study(duffing(), sweep, start={v: 0}, time=(0, 0), seed=3).run()["x_end"]
    values, others = my.linspace(0, 1, 50), {B: 0.3, x: my.normal(2, 0.5)}
    first = drawn(my.grid({k: values}, others))
    assert len(set(first)) == 50
    np.testing.assert_array_equal(first, drawn({k: values, **others}))
    with pytest.raises(my.Error, match=r"`uniform\(0, k\)` is drawn between bounds that differ.*my.study in a dict"):
        my.grid({k: values}, {x: my.uniform(0, k)})
    between = drawn({k: values, B: 0.3, x: my.uniform(0, k)})
    assert (between[1:] > 0).all() and (between <= np.linspace(0, 1, 50)).all() and len(set(between)) == 50


def test_reductions_are_numpys():
    edges = np.linspace(-1, 1, 9)
    several = [my.reduce.mean("x"), my.reduce.maximum("x_end"), my.reduce.minimum("v_end"),
               my.reduce.histogram("x", edges),
               my.reduce.total("energy", ["x_end", "x"], 2, lambda c: [(c["x_end"]**2).sum(), c["x"][:, 1].sum()])]
    result = my.study(duffing(), grid(), keep=[x, v], reduce=several, **call).run(chunk=10)
    np.testing.assert_allclose(result["x_mean"], result["x"].mean(axis=(0, 1)), rtol=1e-14)
    assert result["x_end_maximum"] == result["x_end"].max() and result["v_end_minimum"] == result["v_end"].min()
    np.testing.assert_array_equal(result["x_histogram"], np.histogram(result["x"], edges)[0])
    np.testing.assert_allclose(result["energy"], [(result["x_end"]**2).sum(), result["x"][..., 1].sum()])
    alone = my.study(duffing(), grid(), reduce=several[0], record=[x],
                     **{n: c for n, c in call.items() if n != "record"}, keep=dict(records=False))
    assert "x" not in alone.run().names


def test_variances_and_standard_errors_are_numpys_in_any_chunks():
    several = [make(name) for name in ("x", "x_end") for make in (my.reduce.variance, my.reduce.standard_error)]
    results = [my.study(duffing(), grid(), keep=[x], reduce=several, **call).run(chunk=chunk) for chunk in (7, 1000)]
    for name, axes in (("x", (0, 1)), ("x_end", None)):
        values = results[0][name]
        variance, n = values.var(axis=axes, ddof=1), results[0]["x_end"].size
        np.testing.assert_allclose(results[0][f"{name}_variance"], variance, rtol=1e-13)
        np.testing.assert_allclose(results[0][f"{name}_standard_error"], np.sqrt(variance / n), rtol=1e-13)
        for what in ("variance", "standard_error"):
            np.testing.assert_array_equal(results[0][f"{name}_{what}"], results[1][f"{name}_{what}"])


def test_histograms_and_quantiles_of_each_sample():
    edges, shares = np.linspace(-2, 2, 401), [0.05, 0.5, 0.95]
    result = my.study(duffing(), {k: my.uniform(0.2, 0.3), B: 0.3}, draws=500, start={x: my.normal(0, 0.1), v: 0},
                      time=(0, 5), samples=np.linspace(0, 5, 6), method="dormand_prince_5", keep=dict(samples=True),
                      reduce=[my.reduce.histograms("x_sample", edges), my.reduce.quantiles("x_sample", shares, edges)]
                      ).run(chunk=77)
    samples = result["x_sample"]
    assert samples.shape == (500, 6)
    counted = [np.histogram(column, edges)[0] for column in samples.T]
    np.testing.assert_array_equal(result["x_sample_histograms"], counted)
    assert result["x_sample_histograms_outside"].tolist() == [[0, 0, 0]] * 6
    exact = np.quantile(samples, shares, axis=0, method="inverted_cdf")
    assert np.abs(result["x_sample_quantiles"] - exact).max() <= 0.01 * (1 + 1e-9)  # a bin's width
    with pytest.raises(my.Error, match=r"a quantile of x_sample is 50 \(must be from 0 to 1\): 0.5 is the median"):
        my.study(duffing(), grid(), reduce=my.reduce.quantiles("x_sample", 50, edges), **call)


def test_failures_are_statuses():
    model = my.model({x: my.sqrt(k) * x})
    result = my.study(model, {k: np.linspace(-2, 2, 5)}, start={x: 1}, time=(0, 1), reduce=my.reduce.mean("x_end"),
                      keep=[x], interpreted=True).run()
    assert result.by_status == {"not_finite": 2, "success": 3}
    done = result["status"] == "success"
    assert done.tolist() == [False, False, True, True, True]
    assert result["x_end_mean"] == pytest.approx(result["x_end"][done].mean(), rel=1e-15)


def test_tables_samples_and_events_of_models():
    weights = my.table("W", np.array([[0.0, 1.0], [-1.0, 0.0]]))
    bounces = my.integer_accessory("bounces")
    model = my.model(dict(zip((x, v), weights @ [x, v])),
                     events=[my.event(x, direction="falling", tolerance=1e-10, do={bounces: bounces + 1})],
                     initialise={bounces: 0})
    for interpreted in (False, True):  # of which the latter has more components than the model
        result = my.study(model, my.grid({x: [1.0, 2.0]}), start={v: 0}, time=(0, 10), samples=5, rtol=1e-10,
                          atol=1e-10, keep=[bounces], interpreted=interpreted).run()
        np.testing.assert_allclose(result["x_sample"], np.outer([1, 2], np.cos(np.linspace(0, 10, 5))), atol=1e-7)
        np.testing.assert_array_equal(result[bounces], [2, 2])


SLOW = """
import sys, threading
import numpy as np, myriad_ode as my
x, v = my.states("x v")
k = my.parameter("k")
study = my.study(my.model({x: v, v: -k * x}), my.grid({k: my.linspace(1, 2, 4000)}), start={x: 1, v: 0},
                 time=(0, float(sys.argv[2])), keep=[x], interpreted=True)
begun = lambda done, total: done and print("begun", flush=True)
try:
    result = study.run(sys.argv[1], chunk=int(sys.argv[3]), device="cpu:1", progress=begun)
    print("ended", result.done, result.instances)
except my.Interrupted as stopped:
    print("stopped", stopped.run.done, stopped.run.complete)
"""


def run_slowly(store, sent=None, chunk=50, end=300):
    child = subprocess.Popen([sys.executable, "-c", SLOW, str(store), str(end), str(chunk)], stdout=subprocess.PIPE,
                             text=True)
    if sent is not None:
        child.stdout.readline()
        child.send_signal(sent)
    told = child.communicate(timeout=120)[0].split()
    return told[told.index("stopped"):] if "stopped" in told else told[told.index("ended"):] if "ended" in told else []


paths_model = my.model({x: v, v: -k * x - 0.5 * v}, noise={v: 0.3})
of_paths = dict(time=(0, 1), step=1 / 16, seed=3, paths=6, samples=dict(evenly=3, states=[x, v]))
path_sweep = my.grid({k: [1.0, 2.0, 4.0], x: [0.5, 1.0]})
per_set = [*(make(name, over="path") for name in ("x_end", "x_sample") for make in (
                my.reduce.mean, my.reduce.variance, my.reduce.standard_error, my.reduce.minimum, my.reduce.maximum)),
           my.reduce.quantiles("x_sample", [0.5], my.linspace(-3, 3, 601), over="path"),
           my.reduce.histogram("x_end", [-3.0, 0, 3], over="path"),
           my.reduce.covariance("x_end", "v_end", over=["path"]), my.reduce.covariance("x_sample", "v_sample"),
           my.reduce.total("positive", "v_end", 1, lambda c: [(c["v_end"] > 0).sum()], over=["path", "k"])]


def reduced_paths(store=None, **more):
    study = my.study(paths_model, path_sweep, start={v: 0}, keep=[x, v], reduce=per_set, **of_paths)
    return study.run(store, **more)


def test_reductions_over_paths_are_those_of_each_set_of_parameters():
    result = reduced_paths(chunk=36)
    ends, samples = np.array(result["x_end"]), np.array(result["x_sample"])
    assert ends.shape == (3, 2, 6) and samples.shape == (3, 2, 6, 3)
    for name, values in (("x_end", ends), ("x_sample", samples)):
        several = dict(mean=values.mean(2), variance=values.var(2, ddof=1), minimum=values.min(2),
                       maximum=values.max(2), standard_error=values.std(2, ddof=1) / 6**0.5)
        for what, expected in several.items():
            np.testing.assert_allclose(result[f"{name}_{what}"], expected, rtol=1e-12, atol=1e-15, err_msg=what)
    inside = np.sort(samples, axis=2)
    assert result["x_sample_quantiles"].shape == (3, 2, 1, 3)
    assert (np.abs(result["x_sample_quantiles"][:, :, 0] - inside[:, :, 2]) <= 0.0101).all()
    assert result["x_end_histogram"].tolist() == [[np.histogram(one, [-3, 0, 3])[0].tolist() for one in row]
                                                  for row in ends]
    v_end, v_sample = np.array(result["v_end"]), np.array(result["v_sample"])
    expected = [[np.cov(a, b)[0, 1] for a, b in zip(*rows)] for rows in zip(ends, v_end)]
    np.testing.assert_allclose(result["x_end_v_end_covariance"], expected, rtol=1e-12)
    expected = [np.cov(samples[..., s].ravel(), v_sample[..., s].ravel())[0, 1] for s in (1, 2)]
    np.testing.assert_allclose(result["x_sample_v_sample_covariance"][1:], expected, rtol=1e-12)
    assert result["positive"].tolist() == (v_end > 0).sum(axis=(0, 2)).tolist()
    data = result.to_xarray()
    assert data.x_sample_quantiles.dims == ("k", "x_start", "x_sample_quantile", "sample")
    np.testing.assert_allclose(data.x_end_mean, data.x_end.mean("path"), rtol=1e-12)


def test_reductions_over_paths_have_the_same_bits_for_other_chunks_and_after_a_stop(tmp_path):
    names = [name for name in reduced_paths(chunk=36) if name.startswith(("x_", "positive"))]
    expected = {name: np.array(reduced_paths(chunk=36)[name]) for name in names}
    assert "x_end_v_end_covariance" in names and "x_sample_quantiles" in names

    calls = []

    def stop_in_the_middle(chunk):
        calls.append(1)
        if len(calls) > 12:
            raise KeyError
        return per_set[-1].arguments[-1].function(chunk)
    stops = my.reduce.total("positive", "v_end", 1, stop_in_the_middle, over=["path", "k"])
    study = my.study(paths_model, path_sweep, start={v: 0}, keep=[x, v], reduce=[*per_set[:-1], stops], **of_paths)
    with pytest.raises(KeyError):
        study.run(tmp_path / "store", chunk=1)
    assert 0 < my.open_study(tmp_path / "store").done < 36
    for found in (reduced_paths(tmp_path / "store"), reduced_paths(chunk=5), reduced_paths(chunk=1)):
        for name in names:
            np.testing.assert_array_equal(found[name], expected[name], err_msg=name)


@pytest.mark.parametrize("reduction, said", [
    (my.reduce.mean("x_end", over="draw"), "is over \"draw\", and the study has no such axis: there are k, path"),
    (my.reduce.mean("x_end", over=["path", "path"]), "over \"path\" twice: name it once"),
    (my.reduce.covariance("x_end", "x_sample", over="path"), "of x_end and x_sample, which have different shapes"),
    (my.reduce.histogram("x_end", my.linspace(0, 1, 1000), over="path"), "sums of reductions"),
])
def test_reductions_over_axes_that_cannot_be_are_refused(reduction, said):
    study = my.study(paths_model, {k: my.linspace(1, 2, 10**9)}, start={x: 1, v: 0}, reduce=reduction,
                     **of_paths)
    with pytest.raises(my.Error, match=said):
        study.run()


@pytest.mark.parametrize("over", [[], 3, ["path", 3]])
def test_axes_of_a_reduction_are_names(over):
    with pytest.raises(my.Error, match="give the name of an axis of the study"):
        my.reduce.mean("x_end", over=over)


def test_a_study_goes_on_after_an_interrupt_and_after_a_kill(tmp_path):
    stopped, done, complete = run_slowly(tmp_path / "store", signal.SIGINT)
    assert stopped == "stopped" and 0 < int(done) < 4000 and complete == "False"
    assert my.open_study(tmp_path / "store").done == int(done)
    before = [int(done)]
    assert run_slowly(tmp_path / "store", signal.SIGKILL) == []
    before.append(my.open_study(tmp_path / "store").done)
    assert before[0] <= before[1] < 4000
    ended, all_done, now = run_slowly(tmp_path / "store")
    assert ended == "ended" and int(all_done) == 4000 and int(now) == 4000 - before[1]
    whole = my.open_study(tmp_path / "store")
    assert whole.complete and whole.verify() == []
    some = my.solve(my.model({x: v, v: -k * x}), {k: np.linspace(1, 2, 4000)[::399]}, start={x: 1, v: 0},
                    time=(0, 300), interpreted=True)
    np.testing.assert_array_equal(whole["x_end"][::399], some["x"])


@pytest.mark.parametrize("sweep, start", [
    ({"kk": my.linspace(0.2, 0.3, 3), B: 0.3}, {x: 1, v: 0}),
    ({"kk": 0.2, B: 0.3}, {x: 1, v: 0}),
    (my.grid({"kk": my.linspace(0.2, 0.3, 3)}, {B: 0.3}), {x: 1, v: 0}),
])
def test_an_unknown_name_is_not_reported_as_a_missing_one(sweep, start):
    with pytest.raises(my.Error, match="'kk' is no component of the model: did you mean 'k'"):
        my.study(duffing(), sweep, start=start, time=(0, 1))


def test_the_message_of_an_unknown_name_lists_no_elements_of_tables():
    table = my.table("T", np.ones((50, 50)))
    with pytest.raises(my.Error, match="'qqq' is no component of the model: there are x, k$"):
        my.study(my.model({x: -k * table[1, 2] * x}), {k: 1}, start={x: 1}, time=(0, 1), keep=["qqq"])
    with pytest.raises(my.Error, match="'qqq' is no component.*there are x, k$"):
        my.solve(my.model({x: -k * table[1, 2] * x}), {k: 1, "qqq": 2}, start={x: 1}, time=(0, 1))


def test_damage_is_found_and_mended(tmp_path):
    study = my.study(duffing(), grid(), keep=[x], **call)
    expected = study.run(tmp_path / "store", chunk=10)["x_end"]
    file = sorted(p for p in pathlib.Path(tmp_path / "store" / "x_end").rglob("*") if p.is_file() and
                  p.name != "zarr.json")[2]
    data = bytearray(file.read_bytes())
    data[3] ^= 1
    file.write_bytes(data)
    damage, = my.verify(tmp_path / "store")
    assert damage.variable == "x_end" and "checksum" in damage.reason
    with pytest.raises(my.Error, match="its checksum is.*start the study again with the option check set to checksums"):
        my.open_study(tmp_path / "store")["x_end"]
    mended = study.run(tmp_path / "store", check="checksums")
    assert mended.instances == 10
    np.testing.assert_array_equal(mended["x_end"], expected)


def test_files_that_are_exchanged_are_not_read_in_silence(tmp_path):
    study = my.study(duffing(), grid(), keep=[x], **call)
    expected = study.run(tmp_path / "store", chunk=10)
    chunks = sorted(p for p in (tmp_path / "store" / "x_end").rglob("*") if p.is_file() and p.name != "zarr.json")
    chunks[1].write_bytes(chunks[0].read_bytes())
    for read in (lambda r: r["x_end"], lambda r: r.to_xarray().x_end.values):
        with pytest.raises(my.Error, match="in the record"):
            read(my.open_study(tmp_path / "store"))
    axis = next(iter(expected.axes))
    file = next(p for p in (tmp_path / "store" / axis).rglob("*") if p.is_file() and p.name != "zarr.json")
    other = my.grid({k: my.linspace(0.5, 0.6, 25), x: [-0.5, 0.1, 0.2]}, {B: 0.3})
    my.study(duffing(), other, keep=[x], **call).run(tmp_path / "other", chunk=10)
    file.write_bytes((tmp_path / "other" / file.relative_to(tmp_path / "store")).read_bytes())
    with pytest.raises(my.Error, match="in the record"):
        my.open_study(tmp_path / "store")[axis]
    assert {d.variable for d in my.verify(tmp_path / "store")} == {"x_end", axis}


def test_a_result_of_all_instances_whose_file_was_removed_is_not_read_as_a_number(tmp_path):
    reductions = [my.reduce.mean("x_end"), my.reduce.histogram("x_end", [-2.0, 0, 2])]
    my.study(duffing(), grid(), reduce=reductions, **call).run(tmp_path / "store")
    for name in ("x_end_mean", "x_end_histogram", "x_end_outside"):
        file, = (p for p in (tmp_path / "store" / name).rglob("*") if p.is_file() and p.name != "zarr.json")
        content = file.read_bytes()
        file.unlink()
        for read in (lambda r, name=name: r[name], lambda r, name=name: r.to_xarray()[name].values):
            with pytest.raises(my.Error, match=f"{name}.* is damaged .it is missing.: start the study again"):
                read(my.open_study(tmp_path / "store"))
        file.write_bytes(content)


def test_a_store_says_what_computed_it(tmp_path):
    my.study(duffing(), grid(), keep=[x], **call).run(tmp_path / "store", device="cpu", chunk=10)
    record = json.loads((tmp_path / "store" / "myriad" / "chunks" / "0.json").read_text(encoding="utf-8"))
    assert record["arithmetic"]["instruction set"] in ("avx512", "avx2", "sse2", "generic")
    assert record["arithmetic"]["compiler"] and record["arithmetic"]["library"].startswith("Myriad ")
    with pytest.raises(my.Error, match="arithmetic is 'other'"):
        my.study(duffing(), grid(), **call).run(tmp_path / "store", arithmetic="other")


def test_a_store_of_another_study_is_refused(tmp_path):
    my.study(duffing(), grid(), **call).run(tmp_path / "store")
    with pytest.raises(my.Error, match="options.rtol: .1e-09. in the store, .1e-08. here"):
        my.study(duffing(), grid(), **{**call, "rtol": 1e-8}).run(tmp_path / "store")
    other = my.model({x: v, v: x - x**3 - k * v + B * my.sin(my.time)})
    with pytest.raises(my.Error, match="notes.model"):
        my.study(other, grid(), **call).run(tmp_path / "store")


def test_the_message_of_a_model_that_was_edited_names_what_it_does_otherwise(tmp_path):
    def run(factor=1.0, damping=0.1, rewritten=False):
        falls = my.event(x - 0.5, direction="falling", name="falls", do={v: factor * v})
        acceleration = -damping * v - x if rewritten else -x - damping * v
        model = my.model({x: v, v: acceleration}, events=[falls])
        my.study(model, {x: [1.0, 2.0]}, start={v: 0.0}, time=(0, 3), interpreted=True).run(tmp_path / "store")

    run()
    run()
    with pytest.raises(my.Error, match="the right-hand side of state.v: .* in the store, .* here"):
        run(damping=0.1001)
    with pytest.raises(my.Error, match="state.v after the action of event .*: .* in the store, .* here"):
        run(factor=0.9)
    with pytest.raises(my.Error) as raised:  # its source is another, and what it does is not
        run(rewritten=True)
    assert "notes.model" in str(raised.value) and "right-hand side" not in str(raised.value)


def test_an_infinite_expiry_never_takes_over(tmp_path):
    study = my.study(my.model({x: -x}), start={x: [1.0, 2.0]}, time=(0, 1), interpreted=True)
    study.run(tmp_path / "store", expiry=float("inf"))
    for expiry in (0, -1, float("nan")):
        with pytest.raises(my.Error, match=f"expiry is {expiry}: give seconds"):
            study.run(tmp_path / "store", expiry=expiry)


@pytest.mark.parametrize("given, what", [
    (dict(notes={"who": "\ud800"}), "the note 'who' has"), (dict(notes={"\udcff": "I"}), "the key of a note has"),
    (dict(title="\udfff"), "the title has"), (dict(units={x: "m\ud83d"}), "the unit of 'state.x' has")])
def test_half_a_character_is_refused_by_its_place(given, what):
    with pytest.raises(my.Error, match=what + ".*which is no character"):
        my.study(my.model({x: -x}), start={x: [1.0]}, time=(0, 1), interpreted=True, **given)


def test_a_study_too_large_for_any_disk_is_refused_at_once(tmp_path):
    study = my.study(my.model({x: -x}), {x: my.linspace(1, 2, 10**15)}, time=(0, 1), interpreted=True)
    begin = time.process_time()
    with pytest.raises(my.Error, match="that are left take .* free: free space"):
        study.run(tmp_path / "store")
    assert time.process_time() - begin < 5 and not (tmp_path / "store").exists()


def test_results_that_live_until_the_end_are_no_page_of_warnings():
    script = ("import ctypes, myriad_ode as my; x = my.state('x')\n"
              "run = my.solve(my.model({x: -x}), start={x: [1.0]}, time=(0, 1), interpreted=True)\n"
              "ctypes.pythonapi.Py_IncRef(ctypes.py_object(run))  # as by another library that has an array")
    told = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert told.stderr == ""


@pytest.mark.parametrize("change, message", [
    (dict(start={}), "the initial value of 'v' is missing"),
    (dict(sweep={k: 1}), "the value of 'B' is missing|initial value"),
    (dict(time=3), "time is 3"),
    (dict(keep=["y"]), "'y' is no component"),
    (dict(keep=dict(ends=[x])), "'ends' is no choice of keep="),
    (dict(reduce=["mean"]), "give reductions"),
    (dict(reduce=[my.reduce.Reduction("mean_of", "q_end")]), 'of "q_end", which is not computed'),
    (dict(start={v: [1, 2]}), "beside a grid"),
    (dict(start={v: 0, x: 1}), "in the sweep and in start="),
    (dict(samples=np.zeros((2, 2))), "no sample times for each instance"),
    (dict(method="runge_kutta_4"), "give step="),
    (dict(draws=0), "draws= is given 0 values"),
    (dict(rtol=-1), "rtol is -1"),
    (dict(max_steps=2**40), "max_steps is 1099511627776"),
])
def test_a_study_that_is_refused_leaves_no_folder(tmp_path, change, message):
    with pytest.raises(my.Error, match=message):
        my.study(duffing(), **{"sweep": grid(), **call, **change}).run(tmp_path / "store")
    assert not (tmp_path / "store").exists()


def test_messages_of_axes():
    with pytest.raises(my.Error, match="is no axis"):
        my.linspace("a", 1, 2)
    with pytest.raises(my.Error):
        my.linspace(0, 1, 0)
    with pytest.raises(my.Error, match="shared by all instances and has 2 values"):
        my.study(duffing(), my.grid({k: 1, B: [1, 2]}), start={x: 1, v: 0}, time=(0, 1))
    with pytest.raises(my.Error, match="'k' has 3 values and 'x' has 2"):
        my.study(duffing(), {k: [1, 2, 3], B: 1}, start={x: [1, 2], v: 0}, time=(0, 1))
    with pytest.raises(my.Error, match=r"exp\(normal\(0, 1\)\).*my.study in a dict"):
        my.grid({k: my.exp(my.normal(0, 1)), B: 1})


def test_an_exception_of_the_progress_function_ends_the_run():
    def refuse(done, total):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        my.study(duffing(), grid(), **call).run(progress=refuse)


def test_an_exception_of_a_sum_arrives():
    study = my.study(duffing(), grid(), reduce=my.reduce.total("wrong", [], 1, lambda c: 1 / 0), **call)
    with pytest.raises(ZeroDivisionError):
        study.run()
    with pytest.raises(my.Error, match="gives 2 numbers, and 1 are expected"):
        my.study(duffing(), grid(), reduce=my.reduce.total("wrong", [], 1, lambda c: [1, 2]), **call).run()


def test_other_threads_run_meanwhile():
    study = my.study(duffing(), grid(400), **{**call, "phases": 300})
    turns, over = [], threading.Event()
    counter = threading.Thread(target=lambda: [turns.append(1) for _ in iter(lambda: over.wait(0.001), True)])
    counter.start()
    study.run(device="cpu:1")
    over.set()
    counter.join()
    assert len(turns) > 3


@pytest.mark.skipif(not my._core.no_gpu(), reason="there is a GPU")
def test_a_gpu_that_is_not_there_is_refused_for_a_study():
    study = my.study(duffing(), grid(), keep=[x], **call)
    for devices in ("cuda", ["cpu", "cuda:1"]):
        with pytest.raises(my.Error, match="device \"cuda.*does not exist|no NVIDIA driver"):
            study.run(device=devices)
    assert study.run(device="auto").complete
