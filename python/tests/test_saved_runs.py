# SPDX-License-Identifier: MIT
"""Runs that last: files of their own, pickles, netCDF, tables and MAT files, and files that are none."""

import copy
import functools
import io
import json
import pickle
import subprocess
import sys
import zipfile

import numpy as np
import pytest

import myriad_ode as my
from myriad_ode.sweeps.gpu_inputs import DeviceInput

x, v = my.states("x v")
k, B = my.parameter("k"), my.shared("B")
peak, count, mode = my.accessory("peak"), my.integer_accessory("count"), my.shared_integer("mode")
model = my.model({x: v, v: -k * x + B * mode}, name="spring", accessories={count: None}, finalise={peak: x * x},
                 events=my.event(x, name="crossing", direction="falling", do={count: count + 1}))
sweep = my.grid({k: [1.0, 4.0], x: [1.0, 2.0, 3.0]}, {B: 0.5, mode: 2})
call = dict(start={v: 0.25, count: 0}, time=(0, 2), rtol=1e-9, interpreted=True, device="cpu")
both = dict(phases=2, record=dict(states=[x], accessories=[peak, count], time=True), samples=3)


def solved(**more):
    return my.solve(model, sweep, **{**call, **both, **more})


@functools.cache
def solved_compiled(name):
    """What no interpreted model has."""
    more = {"sensitivities": dict(free=[k, x]), "single precision": dict(precision="float", rtol=1e-4, atol=1e-4)}
    return solved(interpreted=None, **more[name])


def solved_with_failures():
    """Two of three instances fail, at different times."""
    y, rate = my.state("y"), my.parameter("rate")
    return my.solve(my.model({y: rate * y * y}), {rate: [0.1, 1.0, 2.0]}, start={y: 1.0}, time=(0, 5), samples=4,
                    max_steps=200, interpreted=True, device="cpu")


def solved_from_a_file():
    """A model with outputs, units and other names of components."""
    return my.solve(my.read_sbml(SBML), size=2, time=(0, 2), samples=3, record=["A"], interpreted=True, device="cpu")


SBML = """<sbml xmlns="http://www.sbml.org/sbml/level3/version1/core" level="3" version="1"><model>
<listOfCompartments><compartment id="c" size="2" constant="true"/></listOfCompartments>
<listOfSpecies><species id="A" compartment="c" initialAmount="3" hasOnlySubstanceUnits="true"
boundaryCondition="false" constant="false" substanceUnits="mole"/></listOfSpecies>
<listOfParameters><parameter id="k" value="0.5" constant="true"/>
<parameter id="double_A" constant="false"/></listOfParameters>
<listOfRules><assignmentRule variable="double_A"><math xmlns="http://www.w3.org/1998/Math/MathML"><apply><times/>
<ci>k</ci><ci>A</ci></apply></math></assignmentRule>
<rateRule variable="A"><math xmlns="http://www.w3.org/1998/Math/MathML"><apply><times/><cn>-1</cn><ci>k</ci>
<ci>A</ci></apply></math></rateRule></listOfRules></model></sbml>"""

runs = {
    "records and samples": solved,
    "ends": lambda: my.solve(model, sweep, **call),
    "single precision": lambda: solved_compiled("single precision"),
    "sensitivities": lambda: solved_compiled("sensitivities"),
    "failures": solved_with_failures,
    "columns": lambda: my.solve(model, {k: [1.0, 2.0], B: 1, mode: 1}, **{**call, "start": {x: [1, 2], v: 0, count: 1},
                                                                         "time": (0, [1.0, 2.0])}),
    "values together": lambda: my.solve(model, my.zip({k: [1.0, 2.0], x: [3.0, 4.0]}, B=1, mode=1), **call),
    "no instances": lambda: my.solve(model, {k: [], B: 1, mode: 1}, **{**call, **both, "start": {
        x: 1, v: 0, count: 0}}),
}


def assert_equal_runs(again, run):
    assert list(again) == list(run) and again.shape == run.shape and again.units == run.units
    for name in [*run, "status_codes", "phases_done", "accepted_steps", "rhs_evaluations"]:
        assert again[name].dtype == run[name].dtype, name
        np.testing.assert_array_equal(again[name], run[name], err_msg=name)
    for key in (x, v, my.time):
        if key is my.time or key.value[1] in run.states:
            np.testing.assert_array_equal(again[key], run[key])
    for of in ("states", "accessories", "parameters", "shared", "start", "records", "samples"):
        assert list(getattr(again, of)) == list(getattr(run, of))
        for name, values in getattr(run, of).items():
            np.testing.assert_array_equal(getattr(again, of)[name], values, err_msg=name)
    assert str(again.report) == str(run.report) and again.report.by_status == run.report.by_status
    assert again.report.accepted_steps == run.report.accepted_steps and again.report.notes == run.report.notes
    assert again.done == run.done and again._repr_html_() == run._repr_html_() and repr(again) == repr(run)
    assert again.description == run.description


@pytest.mark.parametrize("kind", runs)
def test_a_run_is_the_same_after_its_file_and_after_a_pickle(kind, tmp_path):
    run = runs[kind]()
    run.save(tmp_path / "run.myriad")
    for again in (my.load(tmp_path / "run.myriad"), pickle.loads(pickle.dumps(run)), copy.deepcopy(run)):
        assert_equal_runs(again, run)
        again.save(tmp_path / "again")  # what was read lasts too
        assert_equal_runs(my.load(str(tmp_path / "again")), run)


def test_failures_are_kept(tmp_path):
    run = solved_with_failures()
    run.save(tmp_path / "run")
    again = my.load(tmp_path / "run")
    assert list(again.failed) == [False, True, True] and set(again.status) == set(run.status)


def test_sensitivities_are_kept(tmp_path):
    run = solved_compiled("sensitivities")
    run.save(tmp_path / "run")
    again = my.load(tmp_path / "run")
    assert again.sensitivity.free == ["k", "x"] and list(again.sensitivity) == list(run.sensitivity)
    for key in ((x, k), (x, x), ("x_end", k), (peak, k), x):
        assert np.any(run.sensitivity[key])
        np.testing.assert_array_equal(again.sensitivity[key], run.sensitivity[key])


def test_outputs_of_models_from_files_are_kept(tmp_path):
    pytest.importorskip("libsbml")
    run = solved_from_a_file()
    run.save(tmp_path / "run")
    again = my.load(tmp_path / "run")
    assert_equal_runs(again, run)
    np.testing.assert_array_equal(again["double_A_sample"], 0.5 * run["A_sample"])


def test_expressions_with_tables_are_the_same_as_plain_values():
    from myriad_ode.symbolic.plain import from_plain, to_plain

    A = my.table("A", np.arange(400.0).reshape(20, 20))
    roots = [my.interpolate(x, [0, 1, 3.0], [1, 2, 5.0], name="data"), my.where(x > 1, my.sin(x), x // 2) + A[1, 2],
             my.floor(v) ** 2.5]
    plain, tables = to_plain(roots)
    again = from_plain(json.loads(json.dumps(plain)), tables)
    assert all(a is b for a, b in zip(again, roots))


def test_a_saved_run_has_datasets_pictures_and_the_models_text(tmp_path):
    run = solved()
    run.save(tmp_path / "run")
    again = my.load(tmp_path / "run")
    assert again.description["model"] == "spring" and again.description["source"] == model.source()[0]
    assert again.description["options"]["rtol"] == "1e-09" and again.description["method"] == "tsitouras_5"
    pytest.importorskip("xarray")
    assert again.to_xarray().identical(run.to_xarray())
    with pytest.raises(my.Error, match="a run that was saved has nothing on a GPU"):
        again.device["x_end"]


def test_parameters_from_a_gpu_are_kept_and_initial_states_are_left_out(tmp_path):
    class OnGpu:
        __cuda_array_interface__ = {"shape": (6,), "typestr": "<f8", "data": (8, False), "version": 3}

    run = solved()
    run._inputs.update({name: DeviceInput(OnGpu(), name) for name in "kv"})  # as `solve` has them of a GPU's arrays
    run.save(tmp_path / "run")
    again = my.load(tmp_path / "run")
    np.testing.assert_array_equal(again["k"], sweep.values("k"))
    assert list(again.start) == ["x"] and list(again) == list(run)


def test_a_file_is_read_by_numpy_without_pickles(tmp_path):
    solved().save(tmp_path / "run.npz")
    with np.load(tmp_path / "run.npz", allow_pickle=False) as file:
        assert file["ensemble.state.0"].shape == (6,)
        assert json.loads(file["header.json"])["format"] == 1


def test_a_pickle_is_read_in_another_process(tmp_path):
    run = solved()
    (tmp_path / "run.pickle").write_bytes(pickle.dumps(run))
    program = f"import pickle; print(pickle.load(open({str(tmp_path / 'run.pickle')!r}, 'rb'))['x_end'].sum())"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert float(done.stdout) == run["x_end"].sum()


def test_files_that_hold_no_run_are_refused(tmp_path):
    path = tmp_path / "file"
    with pytest.raises(my.Error, match="file' cannot be read: No such file"):
        my.load(path)
    with pytest.raises(my.Error, match="cannot be read: Is a directory"):
        my.load(tmp_path)
    np.savez(tmp_path / "other.npz", a=np.arange(3))
    for content in (b"", b"x,y\n1,2\n", pickle.dumps(1), (tmp_path / "other.npz").read_bytes()):
        path.write_bytes(content)
        with pytest.raises(my.Error, match=r"no file that run.save\(path\) has written"):
            my.load(path)


def test_a_file_that_was_cut_off_is_refused(tmp_path):
    solved().save(tmp_path / "run")
    content = (tmp_path / "run").read_bytes()
    for length in (10, len(content) // 2, len(content) - 1):
        (tmp_path / "run").write_bytes(content[:length])
        with pytest.raises(my.Error, match="is damaged or was cut off .*: use another copy, or integrate again"):
            my.load(tmp_path / "run")


def test_a_changed_byte_is_found(tmp_path):
    solved().save(tmp_path / "run")
    content = bytearray((tmp_path / "run").read_bytes())
    content[len(content) // 4] ^= 0x55
    (tmp_path / "run").write_bytes(content)
    with pytest.raises(my.Error, match="is damaged"):
        my.load(tmp_path / "run")


def changed(path, change, arrays=None):
    """Writes a file again with another header, or other arrays by name; None leaves one out."""
    arrays = arrays or {}
    with zipfile.ZipFile(path) as file:
        members = {name: file.read(name) for name in file.namelist()}
    header = json.loads(members["header.json"])
    change(header)
    members["header.json"] = json.dumps(header).encode()
    for name, content in arrays.items():
        members[f"{name}.npy"] = content
    with zipfile.ZipFile(path, "w") as file:
        for name, content in members.items():
            if content is not None:
                file.writestr(name, content)


def as_npy(array, allow_pickle=False):
    out = io.BytesIO()
    np.lib.format.write_array(out, np.asarray(array), version=(1, 0), allow_pickle=allow_pickle)
    return out.getvalue()


def test_a_file_of_a_newer_version_is_refused(tmp_path):
    solved().save(tmp_path / "run")
    changed(tmp_path / "run", lambda header: header.update(format=2, myriad_version="7.1"))
    with pytest.raises(my.Error, match="written by Myriad 7.1, whose files .* install a newer version"):
        my.load(tmp_path / "run")


class Hostile:
    def __reduce__(self):
        return pytest.fail, ("something in the file was executed",)


@pytest.mark.parametrize("arrays", [
    {"ensemble.state.0": as_npy(np.array([Hostile()] * 6, object), True)},  # pickles
    {"ensemble.state.0": None}, {"ensemble.state.0": as_npy(np.zeros(5))}, {"ensemble.state.0": as_npy(["a"] * 6)},
    {"ensemble.status.0": as_npy(np.full(6, 99, np.uint8))}, {"samples.state.0": as_npy(np.zeros(6))},
    {"t_end": as_npy([1.0, 2.0])}, {"axis.k": as_npy([1.0])}, {"stored_samples": as_npy([[1]])},
    {"ensemble.state.0": as_npy(np.zeros(6)).replace(b"(6,)", b"(6**9**9,)")},
    {"ensemble.state.0": as_npy(np.zeros(6)).replace(b"(6,), ", b"(9999999999,), ")},
])
def test_arrays_that_do_not_fit_are_refused_and_not_executed(tmp_path, arrays):
    solved().save(tmp_path / "run")
    changed(tmp_path / "run", lambda header: None, arrays)
    with pytest.raises(my.Error, match="is damaged"):
        my.load(tmp_path / "run")


@pytest.mark.parametrize("change", [
    lambda h: h.pop("model"), lambda h: h["model"].update(names={}), lambda h: h.update(report=3),
    lambda h: h.update(recorded={"x": ["state", 7]}), lambda h: h.update(inputs={"k": "elsewhere"}),
    lambda h: h.update(format="one"), lambda h: h["expressions"].update(nodes=[["exec", [], None, "real"]]),
    lambda h: h["expressions"].update(nodes=[["sin", [0], None, "real"]]), lambda h: h["report"].update(by_status=[]),
    lambda h: h.update(inputs=[1, 2]), lambda h: h.update(sweep={"axes": ["k"], "coordinates": {}, "constants": {}}),
])
def test_headers_that_do_not_fit_are_refused(tmp_path, change):
    solved().save(tmp_path / "run")
    changed(tmp_path / "run", change)
    with pytest.raises(my.Error, match="is damaged"):
        my.load(tmp_path / "run")


def test_a_failed_save_leaves_the_file_that_was_there(tmp_path, monkeypatch):
    run = solved()
    run.save(tmp_path / "run")
    before = (tmp_path / "run").read_bytes()
    monkeypatch.setattr("myriad_ode.results.saved_file.npy.write_array", lambda *_, **__: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        run.save(tmp_path / "run")
    assert (tmp_path / "run").read_bytes() == before and len(list(tmp_path.iterdir())) == 1


# Formats of other packages


@pytest.mark.parametrize("engine", ["netCDF4", "h5netcdf"])
def test_netcdf_is_read_by_xarray(tmp_path, engine, monkeypatch):
    xarray = pytest.importorskip("xarray")
    pytest.importorskip(engine)
    run = solved()
    with monkeypatch.context() as without:
        if engine == "h5netcdf":
            pytest.importorskip("h5py")
            without.setitem(sys.modules, "netCDF4", None)
        run.to_netcdf(tmp_path / "run.nc")
    with xarray.open_dataset(tmp_path / "run.nc") as data:
        expected = run.to_xarray()
        assert set(data.variables) == set(expected.variables) and dict(data.sizes) == dict(expected.sizes)
        for name in set(expected.variables) - {"status"}:
            np.testing.assert_array_equal(data[name], expected[name], err_msg=name)
            assert data[name].dtype == expected[name].dtype, name
        status = data["status"]
        assert [status.flag_meanings.split()[int(code)] for code in status.values.ravel()] == list(run.status)
        assert set(data.coords) == set(expected.coords)


@pytest.mark.parametrize("more", [dict(samples=None), dict(record=None), dict(record=None, samples=None)])
def test_tables_in_files_are_those_of_pandas(tmp_path, more):
    pandas = pytest.importorskip("pandas")
    run = solved(**more)
    run.to_csv(tmp_path / "run.csv")
    expected = run.to_pandas()
    pandas.testing.assert_frame_equal(pandas.read_csv(tmp_path / "run.csv"), expected.astype({"status": str}),
                                      check_dtype=False)


def test_parquet_is_read_by_pandas(tmp_path):
    pandas = pytest.importorskip("pandas")
    pytest.importorskip("pyarrow")
    run = solved(samples=None)
    run.to_parquet(tmp_path / "run.parquet")
    pandas.testing.assert_frame_equal(pandas.read_parquet(tmp_path / "run.parquet"), run.to_pandas())


def test_polars_writes_the_same_tables(tmp_path, monkeypatch):
    polars, pandas = pytest.importorskip("polars"), pytest.importorskip("pandas")
    run = solved(samples=None)
    expected = run.to_pandas()
    monkeypatch.setitem(sys.modules, "pandas", None)
    run.to_csv(tmp_path / "run.csv")
    run.to_parquet(tmp_path / "run.parquet")
    for table in (polars.read_csv(tmp_path / "run.csv"), polars.read_parquet(tmp_path / "run.parquet")):
        assert table.columns == list(expected)
        for name in table.columns:
            assert table[name].to_list() == expected[name].to_list()
    monkeypatch.undo()
    assert pandas.read_csv(tmp_path / "run.csv").shape == expected.shape


def test_mat_is_read_by_scipy(tmp_path):
    io_of_scipy = pytest.importorskip("scipy.io")
    run = solved()
    run.to_mat(tmp_path / "run")
    read = io_of_scipy.loadmat(tmp_path / "run", appendmat=False)
    names = [name for name in run if name != "status"]
    assert {name for name in read if not name.startswith("__")} == {*names, "status_codes", "status_names"}
    for name in names:
        values = run[name]
        np.testing.assert_array_equal(read[name], values if values.ndim == 2 else np.reshape(values, (-1, 1)))
        assert read[name].dtype == values.dtype, name
    assert [str(read["status_names"].ravel()[code].item()) for code in read["status_codes"].ravel()] == list(run.status)


def test_long_names_are_refused_in_mat_files(tmp_path):
    pytest.importorskip("scipy.io")
    long = my.state("y" * 60)
    run = my.solve(my.model({long: -long}), start={long: 1}, time=(0, 1), interpreted=True, device="cpu")
    with pytest.raises(my.Error, match="has 64 letters, and MATLAB takes names of at most 63"):
        run.to_mat(tmp_path / "run.mat")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("method, missing, message", [
    ("to_netcdf", ["netCDF4", "h5netcdf"], "to_netcdf needs the package netCDF4, or h5netcdf and h5py: `pip install"),
    ("to_csv", ["pandas", "polars"], "to_csv needs the package pandas or polars: `pip install pandas`"),
    ("to_parquet", ["pandas", "polars"], "to_parquet needs the packages pandas and pyarrow, or polars: `pip install"),
    ("to_parquet", ["pyarrow", "fastparquet", "polars"], "to_parquet needs the packages pandas and pyarrow"),
    ("to_mat", ["scipy.io"], "to_mat needs the package SciPy: `pip install scipy`"),
])
def test_missing_packages_are_named(tmp_path, method, missing, message, monkeypatch):
    if method == "to_netcdf":
        pytest.importorskip("xarray")
    run = solved()
    for package in missing:
        monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(my.Error, match=message):
        getattr(run, method)(tmp_path / "file")


@pytest.mark.parametrize("method", ["to_csv", "to_parquet"])
def test_records_and_samples_do_not_fit_into_one_table(tmp_path, method):
    pytest.importorskip("pandas" if method == "to_csv" else "pyarrow")
    with pytest.raises(my.Error, match=r"do not fit into one table: use to_netcdf\(path\)"):
        getattr(solved(), method)(tmp_path / "file")


@pytest.mark.parametrize("method", ["save", "to_mat", "to_netcdf", "to_csv"])
def test_a_path_that_cannot_be_written_to_is_told_by_its_own_name(tmp_path, method):
    for package in {"to_mat": ["scipy"], "to_netcdf": ["xarray", "netCDF4"], "to_csv": ["pandas"]}.get(method, ()):
        pytest.importorskip(package)
    x = my.state("x")
    run = my.solve(my.model({x: -x}), start={x: 1.0}, time=(0, 1))
    missing = tmp_path / "missing" / "run"
    with pytest.raises(my.Error, match=f"'{missing}' cannot be written: there is no folder '{missing.parent}'"):
        getattr(run, method)(missing)
    with pytest.raises(my.Error, match=f"'{tmp_path}' is a folder: give the path of a file in it"):
        getattr(run, method)(tmp_path)
