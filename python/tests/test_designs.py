# SPDX-License-Identifier: MIT
"""Designs of global sensitivity analyses, and indices in closed form: of Ishigami's function, which an ODE integrates,
and of exponential decay; SALib's analyses give the same."""

import numpy as np
import pytest

import myriad_ode as my

pytest.importorskip("scipy.stats")

x = my.state("x")
a, b, c, k = my.parameters("a b c k")
# x(1) is Ishigami's function of angles from -pi to pi.
ishigami = my.model({x: my.sin(a) + 7 * my.sin(b)**2 + 0.1 * c**4 * my.sin(a)}, name="ishigami")
angles = {name: (-np.pi, np.pi) for name in (a, b, c)}
variance = 49 / 8 + 0.1 * np.pi**4 / 5 + 0.01 * np.pi**8 / 18 + 0.5
first = {"a": 0.5 * (1 + 0.1 * np.pi**4 / 5)**2 / variance, "b": 49 / 8 / variance, "c": 0}
total = {"a": 1 - first["b"], "b": first["b"], "c": 8 * 0.01 * np.pi**8 / 225 / variance}

simulate = my.batched(ishigami, free=[a, b, c], of=x, start={x: 0}, time=(0, 1), interpreted=True)


def test_sobols_indices_of_ishigamis_function():
    design = my.designs.sobol(angles, 4096, seed=1)
    assert len(design) == 5 * 4096 and design.points.shape == (5 * 4096, 3)
    indices = design.indices(simulate(design.points)[:, 0])
    for name in "abc":
        assert indices["first"][name] == pytest.approx(first[name], abs=0.02)
        assert indices["total"][name] == pytest.approx(total[name], abs=0.02)
        assert 0 < indices["first_error"][name] < 0.03 and 0 < indices["total_error"][name] < 0.03
    assert indices.notes == [] and "first_error" in str(indices)


def test_a_design_is_the_sweep_of_a_study_and_of_a_call():
    # x(1) = x(0) exp(-k), of which x(0) and k are independent: V = E[u^2] E[g^2] - E[u]^2 E[g]^2
    decay = my.model({x: -k * x}, name="decay")
    design = my.designs.sobol({x: (1, 3), k: (0.5, 2)}, 2048)
    study = my.study(decay, design.sweep, time=(0, 1), keep=dict(end=[x]), rtol=1e-9, atol=1e-9, interpreted=True)
    by_study = design.indices(study.run()[x])
    run = my.solve(decay, design.sweep, time=(0, 1), rtol=1e-9, atol=1e-9, interpreted=True)
    by_call = design.indices(run[x])
    mean_u, square_u = 2, 13 / 3
    mean_g = (np.exp(-0.5) - np.exp(-2)) / 1.5
    square_g = (np.exp(-1) - np.exp(-4)) / 3
    whole = square_u * square_g - mean_u**2 * mean_g**2
    of_u, of_g = (square_u - mean_u**2) * mean_g**2, (square_g - mean_g**2) * mean_u**2
    for indices in (by_study, by_call):
        assert indices["first"]["x"] == pytest.approx(of_u / whole, abs=0.01)
        assert indices["first"]["k"] == pytest.approx(of_g / whole, abs=0.01)
        assert indices["total"]["x"] == pytest.approx(1 - of_g / whole, abs=0.01)


def test_indices_of_several_results_have_their_shape():
    design = my.designs.sobol({"k": (0, 1), "a": (1, 100, "log")}, 64)
    assert design.points[:, 1].min() < 1.2 and np.median(design.points[:, 1]) == pytest.approx(10, rel=0.1)
    one, two = design.points[:, 0], np.log(design.points[:, 1])
    indices = design.indices(np.stack([one, two, 3 * one], axis=1).reshape(-1, 3, 1))
    assert indices["total"]["k"].shape == (3, 1)
    np.testing.assert_allclose(indices["total"]["k"].ravel(), [1, 0, 1], atol=0.05)
    np.testing.assert_allclose(indices["first"]["a"].ravel(), [0, 1, 0], atol=0.05)
    assert "(3, 1)" in str(indices)


def test_sets_without_a_solution_are_left_out_and_counted():
    design = my.designs.sobol(angles, 4096, seed=1)
    results = simulate(design.points)[:, 0]
    results[[7, 12]] = np.nan, np.inf
    indices = design.indices(results)
    assert indices.notes == ["2 of 4096 parts of the design were left out, as they have results that are not finite"]
    assert indices["first"]["b"] == pytest.approx(first["b"], abs=0.01)
    assert indices.notes[0] in str(indices)
    with pytest.raises(my.Error, match="4096 of 4096 parts of the design have results that are not finite"):
        design.indices(np.full(len(design), np.nan))
    of_trajectories = my.designs.morris(angles, 5)
    results = of_trajectories.places @ [1.0, -2.0, 0.0]
    results[0] = np.nan
    np.testing.assert_allclose(list(of_trajectories.indices(results)["mean"].values()), [1, -2, 0], atol=1e-12)


def test_morris_effects_of_a_line_are_its_slopes_and_interactions_deviate():
    design = my.designs.morris({"a": (0, 2), "b": (-1, 1), "c": (5, 6)}, 30, levels=6, seed=2)
    assert design.points.shape == (120, 3) and design.places.min() == 0 and design.places.max() == 1
    changes = np.abs(np.diff(design.places.reshape(30, 4, 3), axis=1))
    np.testing.assert_allclose(np.sort(changes, axis=2), np.broadcast_to([0, 0, 0.6], (30, 3, 3)), atol=1e-12)
    assert (changes > 0.5).any(axis=1).all()  # each component once in each trajectory
    p, q, r = design.points.T
    line = design.indices(3 * p - q)
    np.testing.assert_allclose(list(line["mean"].values()), [6, -2, 0], atol=1e-12)
    np.testing.assert_allclose(list(line["mean_size"].values()), [6, 2, 0], atol=1e-12)
    np.testing.assert_allclose(list(line["deviation"].values()), 0, atol=1e-12)
    product = design.indices(p * q)
    assert product["deviation"]["a"] > 0.5 and product["deviation"]["c"] == 0


def test_rank_correlations_are_those_of_monotonic_functions():
    design = my.designs.latin_hypercube({"a": (0, 1), "b": (0, 1), "c": (1, 10, "log")}, 200, seed=3)
    for column in design.places.T:
        np.testing.assert_array_equal(np.sort(np.floor(column * 200)), np.arange(200))
    p, q, r = design.points.T
    alone = design.indices(np.exp(-5 * q))["rank_correlation"]
    np.testing.assert_allclose([alone["a"], alone["b"], alone["c"]], [0, -1, 0], atol=1e-9)
    both = design.indices(np.stack([p + 3 * np.log(r), np.ones(200)], axis=1))["rank_correlation"]
    assert both["c"][0] > both["a"][0] > 0.8 and abs(both["b"][0]) < 0.2
    assert np.isnan(both["a"][1])


def test_salibs_analyses_of_the_designs_give_the_same():
    analyses = {name: pytest.importorskip(f"SALib.analyze.{name}").analyze for name in ("sobol", "morris")}
    design = my.designs.sobol(angles, 256)
    results = simulate(design.points)[:, 0]
    indices = design.indices(results)
    theirs = analyses["sobol"](design.problem, results, calc_second_order=False)
    np.testing.assert_allclose(list(indices["first"].values()), theirs["S1"], rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(list(indices["total"].values()), theirs["ST"], rtol=1e-9)
    np.testing.assert_allclose(1.96 * np.array(list(indices["total_error"].values())), theirs["ST_conf"], rtol=0.4)

    design = my.designs.morris(angles, 25)
    results = simulate(design.points)[:, 0]
    indices = design.indices(results)
    theirs = analyses["morris"](design.problem, design.places, results, num_levels=4)
    np.testing.assert_allclose(list(indices["mean"].values()), theirs["mu"], rtol=1e-9)
    np.testing.assert_allclose(list(indices["mean_size"].values()), theirs["mu_star"], rtol=1e-9)
    np.testing.assert_allclose(list(indices["deviation"].values()), theirs["sigma"], rtol=1e-9)


@pytest.mark.parametrize("make, message", [
    (lambda: my.designs.sobol(angles, 1000), "size is 1000: Sobol points are even in powers of two"),
    (lambda: my.designs.sobol({}, 16), "the bounds name no component"),
    (lambda: my.designs.sobol({k: 3}, 16), "the bounds of 'k' are 3: give"),
    (lambda: my.designs.sobol({k: (0, 1, "log")}, 16), "the lower bound of 'k' is 0"),
    (lambda: my.designs.morris(angles, 1), "trajectories is 1"),
    (lambda: my.designs.morris(angles, 10, levels=5), "levels is 5"),
    (lambda: my.designs.latin_hypercube(angles, 4), "size is 4: give more than 4 sets"),
    (lambda: my.designs.sobol(angles, 16).indices([1, 2]), r"the results have the shape \(2,\): give one for each of "
                                                           "the 80 sets"),
])
def test_designs_that_cannot_be_are_refused(make, message):
    with pytest.raises(my.Error, match=message):
        make()
