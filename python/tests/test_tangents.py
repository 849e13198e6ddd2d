# SPDX-License-Identifier: MIT
"""Models with tangent vectors; examples/lyapunov.py checks exponents."""

import importlib.util

import numpy as np
import pytest

import myriad_ode as my

x, v = my.states("x v")
decay = my.model({x: -my.parameter("k") * x, v: -3 * v}, name="decay")


def test_tangents_are_states_that_start_orthonormal():
    model = my.with_tangents(decay, 2)
    tangents = ["x_tangent_1", "v_tangent_1", "x_tangent_2", "v_tangent_2"]
    assert model.states == ["x", "v", *tangents]
    start = np.array([model.defaults[name] for name in tangents]).reshape(2, 2)
    np.testing.assert_allclose(start @ start.T, np.eye(2), atol=1e-15)


def test_exponents_of_linear_equations_are_their_eigenvalues():
    # In the transient phases, ten units of time, tangents turn towards the eigenvectors up to e^-20 at the least.
    run = my.solve(my.with_tangents(decay, 2, transient_phases=20), {"k": [1.0, 2.0]}, start={x: 1, v: 1},
                   time=(0, 0.5), phases=50, rtol=1e-10, atol=1e-14)
    np.testing.assert_allclose(my.exponents(run), [[-1, -3], [-2, -3]], atol=1e-8)


def test_a_sweep_may_set_the_number_of_transient_phases():
    options = dict(start={x: 1, v: 1}, time=(0, 0.5), phases=4)
    model = my.with_tangents(decay, 1, transient_phases=1)
    one = my.exponents(my.solve(model, {"k": [1.0, 2.0]}, **options))
    two = my.exponents(my.solve(model, {"k": [1.0, 2.0], "transient_phases": 2}, **options))
    assert np.array_equal(two, my.exponents(my.solve(my.with_tangents(decay, 1, transient_phases=2), {"k": [1.0, 2.0]},
                                                     **options)))
    assert (one != two).all()


def test_stiff_methods_take_tangents_of_networks():
    """A chain of decays at rates of 1 to 1e5: the exponents of the two slowest ones. With eight states the model has a
    Jacobian and a pattern of its own, which hold for the states without tangents."""
    c = my.states([f"c{i}" for i in range(8)])
    rates = [1, 3, 10, 1e2, 1e3, 1e4, 1e4, 1e5]
    chain = my.model({s: -rate * s + (before * before if i else 0) for i, (s, before, rate) in
                      enumerate(zip(c, [c[0], *c[:-1]], rates))})
    run = my.solve(my.with_tangents(chain, 2, transient_phases=20), start={s: 1 for s in c}, time=(0, 0.5),
                   phases=50, method="rodas_5p", rtol=1e-7, atol=1e-9)
    np.testing.assert_allclose(my.exponents(run), [[-1, -3]], atol=1e-5)
    assert run.report.matrix.states == 24
    assert run.report.matrix.factor_entries < 24 * 24 / 3


@pytest.mark.parametrize("make, message", [
    (lambda: my.with_tangents(my.model({x: -x, v: x - v}, mass_matrix={v: 0})), "has a mass matrix"),
    (lambda: my.with_tangents(decay, 3), "a model of 2 states has from 1 to 2"),
    (lambda: my.with_tangents(decay, 0), "from 1 to 2"),
    (lambda: my.with_tangents(decay, transient_phases=-1), "transient_phases is -1.*0 or more"),
    (lambda: my.with_tangents(my.model({my.state("growth_1"): 1})), "component 'growth_1'"),
    (lambda: my.with_tangents(my.model({my.state("exponent_1"): 1})), "component 'exponent_1'"),
])
def test_wrong_tangents_are_refused(make, message):
    with pytest.raises(my.Error, match=message):
        make()


def test_results_without_tangents_have_no_exponents():
    run = my.solve(decay, {"k": 1.0}, start={x: 1, v: 1}, time=(0, 1))
    with pytest.raises(my.Error, match=r"no exponents in this result.*solve my.with_tangents\(model\)"):
        my.exponents(run)


plane = dict(start={x: 1, v: 1}, time=(0, 0.5), phases=50, rtol=1e-10, atol=1e-14)


def test_exponents_have_one_name_in_a_run_its_files_and_its_pictures(tmp_path):
    pandas, xarray, io = (pytest.importorskip(name) for name in ("pandas", "xarray", "scipy.io"))
    model = my.with_tangents(decay, 2, transient_phases=20)
    run = my.solve(model, my.grid({"k": [1.0, 2.0], "v": [1.0, 2.0, 3.0]}), **{**plane, "start": {x: 1}})
    known = my.exponents(run)
    assert np.array_equal(np.stack([run["exponent_1_end"], run["exponent_2"]], axis=1), known)
    run.to_csv(tmp_path / "run.csv")
    run.to_netcdf(tmp_path / "run.nc")
    run.to_mat(tmp_path / "run.mat")
    run.save(tmp_path / "run.npz")
    np.testing.assert_allclose(pandas.read_csv(tmp_path / "run.csv")["exponent_2_end"], known[:, 1], rtol=1e-15)
    with xarray.open_dataset(tmp_path / "run.nc") as data:
        assert data["exponent_1_end"].dims == ("k", "v_start")
        assert np.array_equal(data["exponent_1_end"].values.ravel(), known[:, 0])
    assert np.array_equal(io.loadmat(tmp_path / "run.mat")["exponent_1_end"].ravel(), known[:, 0])
    saved = my.load(tmp_path / "run.npz")
    assert np.array_equal(saved["exponent_1"], known[:, 0]) and np.array_equal(my.exponents(saved), known)
    pytest.importorskip("matplotlib").use("Agg")
    drawn = run.plot.map("k", "v", "exponent_1").collections[0].get_array()
    assert sorted(np.ravel(drawn)) == sorted(known[:, 0])


def test_recorded_exponents_show_how_they_converge():
    run = my.solve(my.with_tangents(decay, 1, transient_phases=20), {"k": [1.0, 2.0]},
                   record=dict(from_phase=18, accessories=["exponent_1", "growth_1", "time_summed"]), **plane)
    assert np.isnan(run["exponent_1"][:, :2]).all() and not np.isnan(run["exponent_1"][:, 2:]).any()
    assert np.array_equal(run["exponent_1"][:, 2:], run["growth_1"][:, 2:] / run["time_summed"][:, 2:])
    assert np.array_equal(run["exponent_1"][:, -1:], my.exponents(run))
    pytest.importorskip("matplotlib").use("Agg")
    assert len(run.plot.bifurcation("k", "exponent_1").lines) == 1


def test_exponents_have_one_name_in_a_study_and_its_files(tmp_path):
    xarray = pytest.importorskip("xarray")
    model = my.with_tangents(decay, 2, transient_phases=20)
    values = {"k": [1.0, 2.0, 3.0]}
    known = my.exponents(my.solve(model, values, **plane))
    for keep in (None, ["exponent_2", "exponent_1"]):
        folder = tmp_path / str(keep is None)
        result = my.study(model, my.grid(values), keep=keep, **plane).run(folder, device="cpu")
        assert np.array_equal(my.exponents(result), known) and np.array_equal(result["exponent_2"], known[:, 1])
        named = {name for name in result.names if "growth" in name or "exponent" in name}
        assert named == {"exponent_1_end", "exponent_2_end"}
        assert not [path for path in folder.iterdir() if "growth" in path.name] and (folder / "exponent_1_end").is_dir()
        assert named <= set(result.to_xarray()) and "growth" not in str(result.to_xarray())
        result.to_csv(tmp_path / "study.csv")
        header = (tmp_path / "study.csv").read_text().splitlines()[0].split(",")
        assert named <= set(header) and not [name for name in header if "growth" in name]
        if importlib.util.find_spec("netCDF4"):
            result.to_netcdf(tmp_path / "study.nc")
            with xarray.open_dataset(tmp_path / "study.nc") as data:
                assert np.array_equal(data["exponent_1_end"].values, known[:, 0]) and "growth_1_end" not in data
    mean = my.study(model, my.grid(values), reduce=my.reduce.mean("exponent_1_end"), **plane).run(device="cpu")
    assert float(mean["exponent_1_end_mean"]) == pytest.approx(-2, abs=1e-8)
    with pytest.raises(my.Error, match="let a study keep all, or exponent_1"):
        my.exponents(my.study(model, {"k": 1.0}, keep=[x], **plane).run())


def test_a_study_that_keeps_the_sums_of_growth_alone_has_its_exponents():
    """As the stores of studies that were begun before exponents had a name."""
    model = my.with_tangents(decay, 2, transient_phases=20)
    result = my.study(model, my.grid(k=[1.0, 2.0, 3.0]), keep=["growth_2", "growth_1", "time_summed"], **plane).run()
    np.testing.assert_allclose(my.exponents(result), [[-1, -3], [-2, -3], [-3, -3]], atol=1e-8)
