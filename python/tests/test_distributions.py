# SPDX-License-Identifier: MIT
"""Distributions of what differs between the instances of a study, and expressions in its sweep."""

import pickle

import numpy as np
import pytest

import myriad_ode as my

x, y = my.states("x y")
k, clearance, volume, weight, dose = my.parameters("k clearance volume weight dose")
decay = my.model({x: -k * x, y: -clearance / volume * y}, name="decay")
size = 20_000


def values_of(*names, sweep=None, start=None, model=decay, **options):
    """A row of values for each name, of so many instances."""
    options = dict(draws=size, time=(0, 0.1), keep=list(names), interpreted=True, seed=1) | options
    found = my.study(model, sweep, start={x: 1.0, y: 1.0} | (start or {}), **options).run()
    return [np.ravel(found[f"{name}_end"]) for name in names]


def test_logarithms_of_lognormal_values_are_normally_distributed():
    values, = values_of("k", sweep={k: my.lognormal(5, 0.3), clearance: 1, volume: 1})
    logarithms = np.log(values)
    assert abs(logarithms.mean() - np.log(5)) < 5 * 0.3 / np.sqrt(size)
    assert abs(logarithms.std() - 0.3) < 5 * 0.3 / np.sqrt(2 * size)


@pytest.mark.parametrize("covariance", [[[0.09, 0.03, 0], [0.03, 0.04, -0.02], [0, -0.02, 0.25]],
                                        [[1, 2, 0], [2, 4, 0], [0, 0, 0]]])
def test_correlated_values_have_their_means_and_covariance(covariance):
    a, b, c = my.multivariate_normal([1, -2, 3], covariance)
    drawn = np.array(values_of("k", "clearance", "volume", sweep={k: a, clearance: b, volume: c}))
    deviations = np.sqrt(np.diag(covariance))
    assert (np.abs(drawn.mean(axis=1) - [1, -2, 3]) <= 5 * deviations / np.sqrt(size)).all()
    scale = np.outer(deviations, deviations) * np.sqrt(2 / size)
    assert (np.abs(np.cov(drawn) - covariance) <= 5 * scale + 1e-12).all()


def test_an_expression_in_a_sweep_may_have_other_components_and_draws_that_others_have():
    common = my.normal(0, 0.1)
    found = values_of("k", "clearance", "volume", "weight", "x", draws=50, sweep={
        dose: [1.0, 3.0], weight: my.uniform(50, 90), k: 0.5 * my.exp(common), volume: 40 * my.exp(common),
        clearance: 5 * (weight / 70)**0.75}, start={x: 2 * dose},
        model=my.model({x: -k * x + 0 * dose, y: -clearance / volume * y}))
    rates, clearances, volumes, weights, ends = found
    np.testing.assert_allclose(volumes, 80 * rates, rtol=1e-14)
    np.testing.assert_allclose(clearances, 5 * (weights / 70)**0.75, rtol=1e-14)
    np.testing.assert_allclose(ends, np.repeat([2, 6], 50) * np.exp(-0.1 * rates), rtol=1e-6)
    assert len(set(rates)) == 100


def test_draws_in_a_sweep_depend_on_the_seed_and_the_instance_alone():
    study = dict(sweep={k: my.lognormal(1, 0.2), clearance: 1, volume: 1})
    whole, = values_of("k", **study)
    parts = my.study(decay, study["sweep"], start={x: 1.0, y: 1.0}, draws=size, time=(0, 0.1), keep=[k],
                     interpreted=True, seed=1)
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(parts)).run(chunk=333)["k_end"].ravel(), whole)
    assert not np.array_equal(values_of("k", **study, seed=2)[0], whole)


def test_models_from_files_have_expressions_in_their_sweeps_by_name():
    read = my.read_xpp("par k=.5,v=2\nx'=-k*x\ninit x=1\n")
    found = my.study(read, {"k": my.lognormal(0.5, 0.1)}, draws=5, time=(0, 1), keep=["k", "x"],
                     interpreted=True).run()
    np.testing.assert_allclose(found["x_end"], np.exp(-found["k_end"]), rtol=1e-4)
    assert len(set(found["k_end"].ravel())) == 5


@pytest.mark.parametrize("wrong, message", [
    (lambda: my.multivariate_normal([0, 0], [[1]]), "give a matrix with a row and a column for each mean"),
    (lambda: my.multivariate_normal([0, 0], [[1, 0], [1, 1]]), "is not symmetric"),
    (lambda: my.multivariate_normal([0, 0], [[1, np.nan], [np.nan, 1]]), "is not symmetric"),
    (lambda: my.multivariate_normal([0, 0], [[1, 2], [2, 1]]), "has the eigenvalue -1.*cannot be that large together"),
    (lambda: my.study(my.CppModel("struct m {};", "m", "x", "k"), {"k": my.lognormal(1, 1)}, draws=2, time=(0, 1)),
     "k are expressions in the sweep of a study.*is no recorded one"),
    (lambda: my.solve(decay, {k: my.lognormal(1, 1)}, time=(0, 1)), "give it to a study, in the dict of its sweep"),
    (lambda: my.study(decay, {"nothing": my.lognormal(1, 1)}, draws=2, time=(0, 1)), "nothing"),
    (lambda: my.study(decay, {k: my.lognormal(1, 1), clearance: 1, volume: 1}, start={x: 1, y: 1}, time=(0, 1)),
     "nothing says how many: give draws="),
])
def test_what_does_not_fit_is_refused(wrong, message):
    with pytest.raises(my.Error, match=message):
        wrong()
