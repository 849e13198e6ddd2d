# SPDX-License-Identifier: MIT
"""Models with tangent vectors; examples/lyapunov.py checks exponents."""

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
    (lambda: my.solve(my.with_tangents(decay), {"k": 1.0}, start={x: 1, v: 1}, time=(0, 1), record=["exponent_1"]),
     "'exponent_1' is an output, .*: name the components that it follows from"),
    (lambda: my.study(my.with_tangents(decay), {"k": 1.0}, start={x: 1, v: 1}, time=(0, 1), keep=["exponent_1"]),
     "'exponent_1' is an output"),
])
def test_wrong_tangents_are_refused(make, message):
    with pytest.raises(my.Error, match=message):
        make()


def test_results_without_tangents_have_no_exponents():
    run = my.solve(decay, {"k": 1.0}, start={x: 1, v: 1}, time=(0, 1))
    with pytest.raises(my.Error, match=r"no growth of tangents.*solve my.with_tangents\(model\)"):
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


def test_recorded_growth_shows_how_exponents_converge():
    recorded = dict(from_phase=18, accessories=["growth_1", "time_summed"])
    run = my.solve(my.with_tangents(decay, 1, transient_phases=20), {"k": [1.0, 2.0]}, record=recorded, **plane)
    assert np.isnan(run["exponent_1"][:, :2]).all() and not np.isnan(run["exponent_1"][:, 2:]).any()
    assert np.array_equal(run["exponent_1"][:, -1:], my.exponents(run))
    pytest.importorskip("matplotlib").use("Agg")
    assert len(run.plot.bifurcation("k", "exponent_1").lines) == 1


def test_a_study_has_the_exponents_of_what_it_keeps():
    model = my.with_tangents(decay, 2, transient_phases=20)
    for keep in (None, ["growth_2", "growth_1", "time_summed"]):
        result = my.study(model, my.grid(k=[1.0, 2.0, 3.0]), keep=keep, **plane).run()
        np.testing.assert_allclose(my.exponents(result), [[-1, -3], [-2, -3], [-3, -3]], atol=1e-8)
    with pytest.raises(my.Error, match="let a study keep all, or growth_1"):
        my.exponents(my.study(model, {"k": 1.0}, keep=[x], **plane).run())
