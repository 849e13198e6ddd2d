# SPDX-License-Identifier: MIT
"""Fits of models to data, compared with SciPy's and with linear regression; profile likelihoods in closed form."""

import os
import signal

import numpy as np
import pytest

import myriad_ode as my
from myriad_ode.inference.least_squares import LeastSquares
from myriad_ode.inference.student_t import student_quantile

x, w = my.states("x w")
k, a, B, unused = my.parameters("k a B unused")
model = my.model({x: B - a * k * x, w: a * k * x - 0.3 * w}, parameters=[unused], name="two_pools")
others = {a: 1, unused: 0}
times = np.linspace(0.5, 8, 30)


def measured(noise=0.01, seed=1, **values):
    """Data of the model for k = 0.7, B = 0.4, x(0) = 2, with errors."""
    run = my.solve(model, {k: 0.7, B: 0.4, **others, **values}, start={x: 2, w: 0}, time=(0, 8), samples=times,
                   rtol=1e-10, atol=1e-10)
    errors = noise * np.random.default_rng(seed).standard_normal((2, times.size))
    return {"t": times, x: run[x][0] + errors[0], w: run[w][0] + errors[1]}


free = {k: (1e-2, 1e2, "log"), B: (0, 5), x: (0, 10)}
usual = {"start": {w: 0}, "sweep": others}


@pytest.mark.long
def test_a_fit_from_many_starts_is_scipys():
    optimize = pytest.importorskip("scipy.optimize")
    fit = my.fit(model, measured(), free=free, starts=20, **usual)
    problem = fit.problem
    scipys = optimize.least_squares(problem.residuals, [1, 1, 1], problem.jacobian, bounds=problem.bounds, ftol=1e-12,
                                    xtol=1e-12, gtol=1e-12)
    assert fit.status == ["converged"] * 20 and fit.notes == []
    np.testing.assert_allclose(list(fit.best.values()), scipys.x, rtol=1e-6)
    assert fit.loss[fit.index] == pytest.approx(scipys.cost, rel=1e-6)
    assert fit.loss.shape == (20,) and fit.values["k"].shape == (20,)
    # within four standard errors of what the data were made with
    for name, true in (("k", 0.7), ("B", 0.4), ("x", 2.0)):
        assert abs(fit.best[name] - true) < 4 * fit.standard_errors[name]
        low, high = fit.confidence(0.9999)[name]
        assert low < true < high


def test_the_jacobian_is_that_of_central_differences():
    problem = my.least_squares(model, measured(), free=free, sigma={x: 0.5, w: 2}, rtol=1e-10, atol=1e-10, **usual)
    at = np.array([0.9, 0.3, 1.5])
    steps = 1e-4 * np.eye(3)
    differences = np.stack([(problem.residuals(at + d) - problem.residuals(at - d)) / 2e-4 for d in steps], axis=1)
    np.testing.assert_allclose(problem.jacobian(at), differences, rtol=1e-6, atol=1e-6)  # d^2 and rounding over d
    gradient = [(problem.loss(at + d) - problem.loss(at - d)) / 2e-4 for d in steps]
    np.testing.assert_allclose(problem.gradient(at), gradient, rtol=1e-5)
    several = problem.residuals(np.stack([at, 2 * at]))
    np.testing.assert_array_equal(several[0], problem.residuals(at))


def test_noiseless_data_give_back_what_made_them():
    fit = my.fit(model, measured(noise=0), free=free, starts=5, rtol=1e-10, atol=1e-10, **usual)
    np.testing.assert_allclose(list(fit.best.values()), [0.7, 0.4, 2], rtol=1e-7)


def test_a_fit_that_ends_at_a_bound_says_so():
    fit = my.fit(model, measured(), free={**free, B: (0.5, 5)}, starts=5, **usual)
    assert fit.at_bound == ["B"] and fit.best["B"] == 0.5
    assert any("ended at a bound of B" in note for note in fit.notes)


# With k = 0, x = x(0) + B t.
line = {"free": {x: (-10, 10), B: (-10, 10)}, "sweep": {**others, k: 0}, "start": {w: 0}, "starts": 3}


def test_intervals_of_a_straight_line_are_those_of_linear_regression():
    stats = pytest.importorskip("scipy.stats")
    rng = np.random.default_rng(3)
    values = 1 + 0.5 * times + 0.1 * rng.standard_normal(times.size)
    values[4] = np.nan
    there = ~np.isnan(values)
    fit = my.fit(model, {"t": times, x: values}, **line)
    design = np.stack([np.ones(there.sum()), times[there]], axis=1)
    best, (squares,), *_ = np.linalg.lstsq(design, values[there], rcond=None)
    np.testing.assert_allclose([fit.best["x"], fit.best["B"]], best, rtol=1e-7)
    covariance = np.linalg.inv(design.T @ design) * squares / (there.sum() - 2)
    np.testing.assert_allclose(fit.covariance, covariance, rtol=1e-6)
    np.testing.assert_allclose(fit.fisher_information, np.linalg.inv(covariance), rtol=1e-6)
    half = stats.t.ppf(0.975, there.sum() - 2) * np.sqrt(covariance[1, 1])
    np.testing.assert_allclose(fit.confidence(0.95)["B"], [best[1] - half, best[1] + half], rtol=1e-5)


def test_intervals_of_few_data_are_students():
    stats = pytest.importorskip("scipy.stats")
    values = np.array([1.1, 1.4, 2.2, 2.3])
    fit = my.fit(model, {"t": [1, 2, 3, 4], x: values}, **line)
    regression = stats.linregress([1, 2, 3, 4], values)
    half = stats.t.ppf(0.95, 2) * regression.stderr
    np.testing.assert_allclose(fit.confidence(0.9)["B"], [regression.slope - half, regression.slope + half], rtol=1e-5)
    known = my.fit(model, {"t": [1, 2, 3, 4], x: values}, sigma=0.3, **line)
    half = stats.norm.ppf(0.95) * 0.3 / np.sqrt(5)  # sum of (t - 2.5)^2
    np.testing.assert_allclose(known.confidence(0.9)["B"], [regression.slope - half, regression.slope + half],
                               rtol=1e-5)


def test_quantiles_of_students_distribution_are_scipys():
    stats = pytest.importorskip("scipy.stats")
    for degrees in (1, 2, 3, 4, 5, 30, 31, 1000, 99_999):
        for probability in (0.5, 0.75, 0.975, 0.99999):
            assert student_quantile(probability, degrees) == pytest.approx(stats.t.ppf(probability, degrees), rel=1e-9,
                                                                           abs=1e-12)
    assert student_quantile(0.975, np.inf) == pytest.approx(1.959963984540054)
    assert np.isnan(student_quantile(0.975, 0))


def test_the_profile_of_a_linear_model_is_a_parabola():
    values = 1 + 0.5 * times + 0.1 * np.random.default_rng(3).standard_normal(times.size)
    for sigma in (None, 0.2):
        fit = my.fit(model, {"t": times, x: values}, sigma=sigma, **line)
        profile = fit.profile(level=0.9)
        for i, name in enumerate(fit.problem.names):
            away = profile.values[name] - fit.best[name]
            assert (np.diff(away) > 0).all() and away.size >= 17
            parabola = fit.loss[fit.index] + 0.5 * fit.variance * away**2 / fit.covariance[i, i]
            np.testing.assert_allclose(profile.loss[name], parabola, rtol=1e-7)
            # the other component is where the regression line has it
            other = 1 - i
            np.testing.assert_allclose(profile.components[name][:, other], fit.best[fit.problem.names[other]]
                                       + away * fit.covariance[0, 1] / fit.covariance[i, i], rtol=1e-5)
            np.testing.assert_allclose(profile.intervals[name], fit.confidence(0.9)[name], rtol=1e-5)
        assert profile.notes == []


def test_intervals_of_a_profile_do_not_depend_on_what_varies():
    # x = 0.2 + B t: those of B are symmetric about it, also when its logarithm varies, by a factor of 20.
    values = 0.2 + 0.05 * times[::6] + 0.1 * np.random.default_rng(1).standard_normal(5)
    call = {"sweep": {**others, k: 0}, "start": {x: 0.2, w: 0}, "sigma": 0.1, "starts": 3}
    fit = my.fit(model, {"t": times[::6], x: values}, free={B: (1e-4, 10, "log")}, **call)
    profile = fit.profile("B")
    half = 1.959964 * 0.1 / np.sqrt(np.sum(times[::6]**2))
    np.testing.assert_allclose(profile.intervals["B"], [fit.best["B"] - half, fit.best["B"] + half], rtol=1e-5)
    assert fit.confidence()["B"][1] > fit.best["B"] + 1.1 * half
    np.testing.assert_allclose(profile.loss["B"] - fit.loss[fit.index],
                               0.5 * ((profile.values["B"] - fit.best["B"]) / half * 1.959964)**2, atol=1e-6)


@pytest.mark.long
def test_a_profile_tells_what_the_data_do_not_bound():
    # a k is determined alone, and a may be between 0.1 and 10: k between 0.07, which is below its bound, and 7.
    fit = my.fit(model, measured(), free={k: (0.1, 20), a: (0.1, 10)}, sweep={B: 0.4, unused: 0}, start={x: 2, w: 0},
                 starts=3)
    product = my.fit(model, measured(), free={k: (0.1, 20)}, sweep={B: 0.4, **others}, start={x: 2, w: 0}, starts=3)
    profile = fit.profile(k)
    low, high = profile.intervals["k"]
    assert low == -np.inf and list(profile.values) == ["k"]
    assert high == pytest.approx(10 * product.profile().intervals["k"][1], rel=1e-3)
    note, = profile.notes
    assert "do not bound k from below" in note and "the bound 0.1" in note
    assert "[-inf, " in str(profile) and note in str(profile)


def test_a_profile_below_the_fit_says_so():
    fit = my.fit(model, {"t": times, x: 1 + 0.5 * times + 0.1 * np.cos(7 * times)}, iterations=1,
                 **{**line, "starts": {x: [5.0], B: [-3.0]}})
    note, = fit.profile().notes
    assert "a profile found the loss" in note and "more starts=" in note


def test_profiles_that_cannot_be_are_refused():
    fit = my.fit(model, measured(), free=free, starts=3, **usual)
    for names, changed, message in ((["z"], {}, "'z' is no free component of the fit"),
                                    (None, {"level": 1}, "the level of confidence is 1"),
                                    (None, {"points": 0}, "points is 0"), ([], {}, "nothing to profile")):
        with pytest.raises(my.Error, match=message):
            fit.profile(names, **changed)
    two = my.fit(model, {"t": [1, 2], x: [1, 2]}, **line)
    with pytest.raises(my.Error, match="give the fit sigma="):
        two.profile()


def test_a_waterfall_has_the_losses_in_order_and_counts_what_failed():
    pytest.importorskip("matplotlib").use("Agg")
    from matplotlib import pyplot

    explosive = my.model({x: k * x * x}, name="explosive")
    t = np.array([0.5, 0.8, 1.0])
    fit = my.fit(explosive, {"t": t, x: 1 / (2 - 0.5 * t) + [0, 1e-3, 0]}, free={k: (0.1, 10)},
                 starts={k: [0.2, 8.0, 0.4]}, start={x: 0.5})
    axes = fit.waterfall()
    drawn, = axes.lines
    assert drawn.get_ydata().tolist() == [fit.loss.min()] * 2 and drawn.get_xdata().tolist() == [1, 2]  # one minimum
    assert axes.get_xlabel() == "starts (1 without a solution)" and axes.get_yscale() == "linear"
    panels = my.fit(model, measured(), free=free, starts=3, **usual).profile().plot()
    assert [a.get_xlabel() for a in panels] == ["k", "B", "x"] and all(len(a.lines) == 2 for a in panels)
    pyplot.close("all")


def test_a_picture_of_a_fit_has_data_over_a_smooth_model():
    pytest.importorskip("matplotlib").use("Agg")
    from matplotlib import pyplot

    sparse = {name: values[::6] for name, values in measured().items()}
    fit = my.fit(model, sparse, free=free, starts=3, sigma=0.01, **usual)
    of_x, of_w = fit.plot()
    line, points = of_x.lines[0], of_x.lines[1]
    assert points.get_ydata().tolist() == sparse[x].tolist() and points.get_xdata().tolist() == times[::6].tolist()
    assert points.get_zorder() > line.get_zorder() and len(line.get_xdata()) > 20 * len(times[::6])
    dense = fit.run()
    at = np.isin(line.get_xdata(), dense.t_sample[0])
    np.testing.assert_allclose(line.get_ydata()[at], dense["x_sample"][0], rtol=1e-4)
    assert (of_x.get_xlabel(), of_x.get_ylabel(), of_w.get_ylabel()) == ("t", "x", "w")
    with pytest.raises(my.Error, match="there are 3 axes for x, w"):
        fit.plot(axes=pyplot.subplots(3)[1])
    pyplot.close("all")


def test_parameters_without_influence_and_mere_products_are_named():
    fit = my.fit(model, measured(), free={k: (0.1, 10), a: (0.1, 10), unused: (-1, 1)}, sweep={B: 0.4},
                 start={x: 2, w: 0}, starts=3)
    assert fit.without_influence == ["unused"]
    assert any("depends on unused" in note for note in fit.notes)
    assert any("combinations of k, a alone" in note for note in fit.notes)
    assert fit.best["k"] * fit.best["a"] == pytest.approx(0.7, rel=0.05)
    assert np.isnan(fit.standard_errors["k"])
    assert "nan" in str(fit)


good = {"t": [1, 2, 3], x: [1, 1, 1]}


@pytest.mark.parametrize("data, changed, message", [
    ({x: [1, 1, 1]}, {}, "data has no times"),
    ({"t": [1, 2, 3]}, {}, "data has times alone"),
    ({"t": [1, 2, 3], "z": [1, 1, 1]}, {}, "'z' is no state or output of the model"),
    ({"t": [1, 2], x: [1, 1, 1]}, {}, "3 values of 'x' and 2 times"),
    ({"t": [-1, 2, 3], x: [1, 1, 1]}, {}, "data has the time -1, and the model begins at 0"),
    ({"t": [1, np.nan, 3], x: [1, 1, 1]}, {}, "data has the time nan"),
    ({"t": [0, 0, 0], x: [1, 1, 1]}, {}, "all times of data are 0"),
    ({"t": [1, 2, 3], x: [1, np.inf, 1]}, {}, "infinite values"),
    ({"t": [1, 2, 3], x: ["a", "b", "c"]}, {}, "data of 'x' has values that are no numbers"),
    ({"t": [1, 2, 3], x: [1, 1, 1], "x": [1, 1, 1]}, {}, "data has 'x' twice"),
    ([1, 2, 3], {}, "data is a list"),
    (good, {"free": {}}, "free= names no component"),
    (good, {"free": {k: 1}}, "the bounds of 'k' are 1"),
    (good, {"free": {k: (2, 1)}}, "the bounds of 'k' are 2 and 1"),
    (good, {"free": {k: (0, 1, "log")}}, "the lower bound of 'k' is 0, and its logarithm varies"),
    (good, {"free": {"z": (0, 1)}}, "'z' is no component that free= can name"),
    (good, {"sweep": {k: 1}}, "'k' is in free= and has a value in sweep="),
    (good, {"sweep": {B: [1, 2]}}, "'B' has several values"),
    (good, {"sigma": {w: 1}}, "'w' is no quantity in data"),
    (good, {"sigma": 0}, "sigma of 'x' has values that are not positive"),
    (good, {"samples": 3}, "a fit chooses samples= itself"),
    (good, {"starts": 0}, "starts is 0"),
    (good, {"starts": {k: [20]}}, "values outside the bounds"),
    (good, {"starts": {B: [20]}}, "starts= has B: give values of k"),
])
def test_what_does_not_fit_together_is_refused(data, changed, message):
    with pytest.raises(my.Error, match=message):
        my.fit(model, data, **{"free": {k: (0.1, 10)}, "start": {x: 1, w: 0}, **changed})


def test_starts_without_a_solution_are_counted_and_none_at_all_is_an_error():
    # x = 1 / (1/x(0) - k t) is infinite at t = 1 / (k x(0)).
    explosive = my.model({x: k * x * x}, name="explosive")
    t = np.array([0.5, 1.0])
    data = {"t": t, x: 1 / (2 - 0.5 * t)}
    call = {"start": {x: 0.5}, "rtol": 1e-9, "atol": 1e-9}
    fit = my.fit(explosive, data, free={k: (0.1, 10)}, starts={k: [0.2, 8.0]}, **call)
    assert fit.status == ["converged", "failed"] and fit.loss[1] == np.inf
    assert fit.best["k"] == pytest.approx(0.5, rel=1e-7)
    assert any("1 of 2 starts had no solution" in note for note in fit.notes)
    with pytest.raises(my.Error, match="no start of the fit has a solution"):
        my.fit(explosive, data, free={k: (0.1, 10)}, starts={k: [8.0]}, **call)


def test_ctrl_c_in_a_fit_keeps_the_best_point(monkeypatch):
    evaluate, losses = LeastSquares.evaluate, []

    def interrupted(self, values):
        if len(losses) == 4:
            losses.append(np.inf)
            os.kill(os.getpid(), signal.SIGINT)
        result = evaluate(self, values)
        losses.append(result[0].min())
        return result

    monkeypatch.setattr(LeastSquares, "evaluate", interrupted)
    given = {"free": free, **usual}
    with pytest.raises(my.Interrupted, match=r"the least loss so far is .*; \.fit has its values") as raised:
        my.fit(model, measured(), starts=5, **given)
    fit = raised.value.fit
    assert len(losses) == 5 and fit.loss[fit.index] == min(losses) and raised.value.run is None
    assert fit.status[fit.index] == "interrupted" and any("Ctrl-C ended the fit" in note for note in fit.notes)
    best = list(fit.best.values())
    assert fit.problem.loss(best) == pytest.approx(min(losses), rel=1e-12)
    np.testing.assert_allclose(fit.residuals, fit.problem.residuals(best), rtol=1e-9)
    whole = my.fit(model, measured(), starts=fit.values, **given)
    assert whole.status[whole.index] == "converged" and whole.loss[whole.index] < min(losses[:4])


def test_ctrl_c_before_a_fit_has_a_solution_is_a_mere_interrupt(monkeypatch):
    monkeypatch.setattr(LeastSquares, "evaluate", lambda self, values: os.kill(os.getpid(), signal.SIGINT))
    with pytest.raises(KeyboardInterrupt) as raised:
        my.fit(model, good, free={k: (0.1, 10)}, start={x: 1, w: 0}, interpreted=True)
    assert not isinstance(raised.value, my.Interrupted)
