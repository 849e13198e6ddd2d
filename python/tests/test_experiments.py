# SPDX-License-Identifier: MIT
"""Fits of several experiments: shared and own components, conditions, noise models, limits, priors, long tables. The
model is a drug that is absorbed and eliminated, whose solution is known."""

import numpy as np
import pytest
from differences import by_differences

import myriad_ode as my

gut, blood = my.states("gut blood")
ka, ke = my.parameters("ka ke")
model = my.model({gut: -ka * gut, blood: ka * gut - ke * blood}, name="drug_of_experiments")
tight = {"rtol": 1e-10, "atol": 1e-10, "start": {blood: 0}}
times = np.array([0.5, 1, 2, 4, 8, 12, 24])
free = {ka: (0.3, 10, "log"), ke: (0.01, 1, "log")}
KA, KE = 1.2, 0.15


def level(t, dose, a=KA, e=KE):
    """The blood level after a dose that was swallowed at t = 0."""
    return dose * a / (a - e) * (np.exp(-e * t) - np.exp(-a * t))


def measured(doses=(25, 50, 100), noise=0.3, e=None, seed=1, times=times):
    """Experiments of several lengths, one for each dose, with errors."""
    random = np.random.default_rng(seed)
    found = []
    for n, (dose, own) in enumerate(zip(doses, e or [KE] * len(doses))):
        t = times[:times.size - 2 * n]
        found.append(my.experiment({"t": t, blood: level(t, dose, e=own) + noise * random.standard_normal(t.size)},
                                   start={gut: dose}, name=f"{dose} mg"))
    return found


def test_shared_components_are_recovered_from_experiments_of_several_doses_and_lengths():
    fit = my.fit(model, measured(noise=0), free=free, starts=6, **tight)
    np.testing.assert_allclose([fit.best["ka"], fit.best["ke"]], [KA, KE], rtol=1e-7)
    noisy = my.fit(model, measured(), free=free, starts=6, **tight)
    for name, true in (("ka", KA), ("ke", KE)):
        assert abs(noisy.best[name] - true) < 4 * noisy.standard_errors[name]
    assert noisy.problem.experiments == ["25 mg", "50 mg", "100 mg"] and noisy.residuals.shape == (7 + 5 + 3,)
    assert noisy.problem.labels[7] == ("50 mg", "blood", 0.5)
    low, high = noisy.profile("ke").intervals["ke"]
    np.testing.assert_allclose([low, high], noisy.confidence()["ke"], rtol=0.01)


def test_own_components_have_a_value_for_each_experiment():
    fit = my.fit(model, measured(noise=0, e=[0.1, 0.2, 0.4]), free=free, own=ke, starts=6, **tight)
    assert list(fit.best) == ["ka", "ke[25 mg]", "ke[50 mg]", "ke[100 mg]"]
    np.testing.assert_allclose(list(fit.best.values()), [KA, 0.1, 0.2, 0.4], rtol=1e-6)


def test_a_fit_in_which_nothing_is_shared_is_that_of_each_experiment():
    experiments = measured(e=[0.1, 0.2, 0.4])
    together = my.fit(model, experiments, free=free, own=[ka, ke], starts=8, sigma=0.3, **tight)
    losses = 0.0
    for e in experiments:
        alone = my.fit(model, e.data, free=free, starts=8, sigma=0.3, **{**tight, "start": {blood: 0, **e.start}})
        losses += alone.loss.min()
        for name in ("ka", "ke"):
            assert together.best[f"{name}[{e.name}]"] == pytest.approx(alone.best[name], rel=1e-5)
            assert together.standard_errors[f"{name}[{e.name}]"] == pytest.approx(alone.standard_errors[name], rel=1e-4)
    assert together.loss.min() == pytest.approx(losses, rel=1e-8)


def test_experiments_may_fix_what_is_free_in_others_or_name_another_free_component():
    first, second, third = measured(noise=0, e=[0.1, 0.1, 0.4])
    first = my.experiment(first.data, start=first.start, sweep={ka: KA})
    third = my.experiment(third.data, start=third.start, sweep={ke: "ke of mutants"})
    fit = my.fit(model, [first, second, third], free={**free, "ke of mutants": (0.01, 1, "log")}, starts=6, **tight)
    np.testing.assert_allclose([fit.best[name] for name in ("ka", "ke", "ke of mutants")], [KA, 0.1, 0.4], rtol=1e-6)
    second = my.experiment(second.data, start=second.start, name="50 mg")
    own = my.likelihood(model, [first, second], free=free, own=ka, **tight)
    assert own.names == ["ka[50 mg]", "ke"]


def test_experiments_may_begin_at_other_times_and_with_free_initial_values():
    experiments = [my.experiment({"t": times + begin, blood: level(times, dose)}, begin=begin)
                   for begin, dose in ((0, 25), (10, 50))]
    fit = my.fit(model, experiments, free={**free, gut: (1, 200, "log")}, own=gut, starts=6, **tight)
    np.testing.assert_allclose(list(fit.best.values()), [KA, KE, 25, 50], rtol=1e-6)


def test_all_experiments_of_all_sets_are_one_ensemble(monkeypatch):
    sizes = []
    monkeypatch.setattr("myriad_ode.gradients.forward.solve",
                        lambda *a, **o: sizes.append(o["size"]) or my.solve(*a, **o))
    problem = my.likelihood(model, measured(), free=free, **tight)
    several = problem.loss([[1.0, 0.1], [2.0, 0.2], [1.0, 0.3], [3.0, 0.1]])
    assert sizes == [12] and several.shape == (4,)
    assert problem.loss([2.0, 0.2]) == pytest.approx(several[1], rel=1e-12)


def everything(sigma, **more):
    """A likelihood of three experiments with a noise model of the parameters a and b."""
    names = {name: (0.01, 5, "log") for name in sigma.names}
    return my.likelihood(model, measured(), free={**free, **names}, sigma={blood: sigma}, **{**tight, **more})


def doses_and_data():
    for dose, e in zip((25, 50, 100), measured()):
        yield dose, e.data["t"], e.data[blood]


noise_models = [
    (my.noise_models.constant("a"), lambda stats, y, f, a, b: stats.norm.logpdf(y, f, a)),
    (my.noise_models.proportional("b"), lambda stats, y, f, a, b: stats.norm.logpdf(y, f, b * f)),
    (my.noise_models.combined("a", "b"), lambda stats, y, f, a, b: stats.norm.logpdf(y, f, np.hypot(a, b * f))),
    (my.noise_models.combined(0.4, "b"), lambda stats, y, f, a, b: stats.norm.logpdf(y, f, np.hypot(0.4, b * f))),
    (my.noise_models.log_normal("a"), lambda stats, y, f, a, b: stats.lognorm.logpdf(y, a, scale=f)),
]


@pytest.mark.parametrize("sigma, density", noise_models)
def test_the_likelihood_of_noise_models_is_the_sum_of_scipys_densities(sigma, density):
    stats = pytest.importorskip("scipy.stats")
    problem = everything(sigma)
    of = {"ka": 1.1, "ke": 0.17, "a": 0.4, "b": 0.1}
    at = np.array([of[name] for name in problem.names])
    expected = -sum(density(stats, y, level(t, dose, 1.1, 0.17), 0.4, 0.1).sum() for dose, t, y in doses_and_data())
    assert problem.loss(at) == pytest.approx(expected, rel=1e-8)
    np.testing.assert_allclose(problem.gradient(at), by_differences(problem.loss, at), rtol=1e-6, atol=1e-6)
    assert len(problem.labels) == problem.evaluate(at)[1].shape[1]


@pytest.mark.parametrize("sigma, cumulative", [
    (my.noise_models.constant("a"), lambda stats, limit, f: stats.norm.logcdf((limit - f) / 0.4)),
    (my.noise_models.combined("a", "b"),
     lambda stats, limit, f: stats.norm.logcdf((limit - f) / np.hypot(0.4, 0.1 * f))),
    (my.noise_models.log_normal("a"), lambda stats, limit, f: stats.norm.logcdf(np.log(limit / f) / 0.4)),
])
def test_values_beyond_limits_have_the_probability_of_that(sigma, cumulative):
    stats = pytest.importorskip("scipy.stats")
    low, high = 12.0, 60.0
    problem, plain = everything(sigma, limits={blood: (low, high)}), everything(sigma)
    of = {"ka": 1.1, "ke": 0.17, "a": 0.4, "b": 0.1}
    at = np.array([of[name] for name in problem.names])
    expected = plain.loss(at)
    cut = 0
    density = next(d for s, d in noise_models if s == sigma)
    for dose, t, y in doses_and_data():
        f = level(t, dose, 1.1, 0.17)
        for value, mean in zip(y, f):
            if low < value < high:
                continue
            cut += 1
            expected += density(stats, value, mean, 0.4, 0.1)
            if value <= low:
                expected -= cumulative(stats, low, mean)
            else:  # the other side: reflected
                z = (np.log(mean / high) / 0.4 if sigma.scale == "log" else
                     (mean - high) / np.hypot(0.4, 0.1 * mean if "b" in sigma.names else 0))
                expected -= stats.norm.logcdf(z)
    assert cut > 4
    assert problem.loss(at) == pytest.approx(expected, rel=1e-8)
    np.testing.assert_allclose(problem.gradient(at), by_differences(problem.loss, at), rtol=1e-5, atol=1e-6)
    assert len(problem.labels) == problem.evaluate(at)[1].shape[1]


def test_the_logarithm_of_the_normal_integral_is_scipys_far_out_too():
    special = pytest.importorskip("scipy.special")
    from myriad_ode.inference.measurements import _log_probability
    z = np.array([-1e5, -300, -40, -25.01, -24.99, -5, -1, 0, 2, 9])
    loss, slope, bend = _log_probability(z)
    np.testing.assert_allclose(loss, -special.log_ndtr(z), rtol=1e-10)
    ratio = np.exp(-z**2 / 2 - special.log_ndtr(z)) / np.sqrt(2 * np.pi)
    np.testing.assert_allclose(slope[1:], -ratio[1:], rtol=1e-9)
    np.testing.assert_allclose(bend[2:], (ratio * (ratio + z))[2:], rtol=1e-8)
    np.testing.assert_allclose(bend[:2], 1, rtol=1e-4)


def test_estimated_noise_is_the_root_mean_square_of_the_residuals():
    fit = my.fit(model, measured(), free={**free, "a": (0.01, 5, "log")}, sigma="a", starts=6, **tight)
    residuals = np.concatenate([y - level(t, dose, fit.best["ka"], fit.best["ke"]) for dose, t, y in doses_and_data()])
    assert fit.best["a"] == pytest.approx(np.sqrt(np.mean(residuals**2)), rel=1e-5)
    assert fit.standard_errors["a"] == pytest.approx(fit.best["a"] / np.sqrt(2 * residuals.size), rel=1e-5)
    squares = my.fit(model, measured(), free=free, starts=6, **tight)
    assert fit.best["ke"] == pytest.approx(squares.best["ke"], rel=1e-5)
    own = my.fit(model, measured(), free={**free, "a": (1e-3, 5, "log")}, own="a", sigma="a", starts=6, **tight)
    assert list(own.best) == ["ka", "ke", "a[25 mg]", "a[50 mg]", "a[100 mg]"]


def test_noise_that_is_known_weighs_the_data_of_each_experiment():
    one, two, three = measured()
    two = my.experiment(two.data, start=two.start, sigma=np.linspace(1, 2, 5))
    problem = my.likelihood(model, [one, two], free=free, sigma=0.5, **tight)
    (dose1, t1, y1), (dose2, t2, y2), _ = doses_and_data()
    expected = np.concatenate([(level(t1, dose1, 1.0, 0.2) - y1) / 0.5,
                               (level(t2, dose2, 1.0, 0.2) - y2) / np.linspace(1, 2, 5)])
    np.testing.assert_allclose(problem.residuals([1.0, 0.2]), expected, rtol=1e-6)
    np.testing.assert_allclose(problem.jacobian([1.0, 0.2]),
                               by_differences(problem.residuals, np.array([1.0, 0.2])), rtol=1e-5, atol=1e-6)
    assert problem.has_sigma and problem.loss([1.0, 0.2]) == pytest.approx(0.5 * expected @ expected, rel=1e-8)


def test_censored_values_take_part_in_a_fit():
    random = np.random.default_rng(2)
    t = np.linspace(0.5, 30, 60)
    y = level(t, 50) + 0.5 * random.standard_normal(t.size)
    cut = np.maximum(y, 2.0)  # as laboratories report what is below the limit
    call = {"free": {**free, "a": (0.01, 5, "log")}, "sigma": "a", "starts": 6, **tight, "start": {gut: 50, blood: 0}}
    censored = my.fit(model, {"t": t, blood: cut}, limits={blood: (2.0, None)}, **call)
    naive = my.fit(model, {"t": t, blood: cut}, **call)
    assert abs(censored.best["ke"] - KE) < 3 * censored.standard_errors["ke"]
    assert abs(naive.best["ke"] - KE) > 3 * abs(censored.best["ke"] - KE)


@pytest.mark.parametrize("prior, density", [
    (my.priors.normal(0.2, 0.05), lambda stats, k: stats.norm.logpdf(k, 0.2, 0.05)),
    (my.priors.log_normal(0.2, 0.3), lambda stats, k: stats.lognorm.logpdf(k, 0.3, scale=0.2)),
    (my.priors.laplace(0.2, 0.05), lambda stats, k: stats.laplace.logpdf(k, 0.2, 0.05)),
    (my.priors.log_laplace(0.2, 0.3), lambda stats, k: stats.loglaplace.logpdf(k, 1 / 0.3, scale=0.2)),
    (my.priors.cauchy(0.2, 0.05), lambda stats, k: stats.cauchy.logpdf(k, 0.2, 0.05)),
    (my.priors.gamma(3, 0.1), lambda stats, k: stats.gamma.logpdf(k, 3, scale=0.1)),
    (my.priors.exponential(0.3), lambda stats, k: stats.expon.logpdf(k, scale=0.3)),
    (my.priors.chi_squared(3), lambda stats, k: stats.chi2.logpdf(k, 3)),
    (my.priors.rayleigh(0.2), lambda stats, k: stats.rayleigh.logpdf(k, scale=0.2)),
    (my.priors.log_uniform(0.05, 0.6), lambda stats, k: stats.loguniform.logpdf(k, 0.05, 0.6)),
])
def test_a_prior_adds_the_logarithm_of_its_density(prior, density):
    stats = pytest.importorskip("scipy.stats")
    plain = everything(my.noise_models.constant("a"))
    problem = everything(my.noise_models.constant("a"), priors={ke: prior})
    for k in (0.1, 0.17, 0.3):
        at = np.array([1.1, k, 0.4])
        assert problem.loss(at) - plain.loss(at) == pytest.approx(-density(stats, k), rel=1e-6, abs=1e-6)
    np.testing.assert_allclose(problem.gradient(at), by_differences(problem.loss, at), rtol=1e-5)
    assert problem.labels[-1] == ("prior", "ke")
    own = everything(my.noise_models.constant("a"), priors={ke: prior}, own=ke)
    at = np.array([1.1, 0.1, 0.2, 0.3, 0.4])
    rest = everything(my.noise_models.constant("a"), own=ke).loss(at)
    assert own.loss(at) - rest == pytest.approx(-sum(density(stats, k) for k in (0.1, 0.2, 0.3)), rel=1e-3)


def test_a_strong_prior_of_laplace_holds_a_component():
    fit = my.fit(model, measured(), free=free, sigma=3.0, starts=6, priors={ke: my.priors.laplace(0.2, 1e-4)}, **tight)
    assert fit.best["ke"] == pytest.approx(0.2, rel=1e-5) and fit.status[fit.index] == "converged"


@pytest.mark.parametrize("prior, mode", [
    (my.priors.gamma(1e6, 2e-7), 0.2), (my.priors.cauchy(0.2, 1e-4), 0.2), (my.priors.rayleigh(1e-4), None)])
def test_a_strong_prior_decides_and_a_weak_one_does_not(prior, mode):
    call = {"free": free, "sigma": 3.0, "starts": 6, **tight}
    plain = my.fit(model, measured(), **call).best["ke"]
    fit = my.fit(model, measured(), priors={ke: prior}, **call)
    assert fit.status[fit.index] == "converged"
    assert fit.best["ke"] == pytest.approx(mode, rel=1e-2) if mode else fit.best["ke"] < 0.1 * plain
    weak = my.fit(model, measured(), priors={ke: my.priors.exponential(1e9)}, **call)
    assert weak.best["ke"] == pytest.approx(plain, rel=1e-5)


def test_log_uniform_priors_need_two_ends():
    with pytest.raises(my.Error, match="log-uniform prior from 2 to 1: give the smaller number first"):
        my.priors.log_uniform(2, 1)
    assert np.isinf(my.priors.log_uniform(1, 2).terms(np.array([[3.0]]))[0]).all()


def long_table():
    rows = {"id": [], "time": [], "what": [], "conc": [], "dose": [], "sd": []}
    for dose, t, y in doses_and_data():
        for n in np.random.default_rng(dose).permutation(t.size):  # in any order
            for column, cell in zip(rows, (dose, t[n], "blood", y[n], dose if n == 0 else None, 0.3)):
                rows[column].append(cell)
    return rows


columns = {"t": "time", "quantity": "what", "value": "conc", "start": {gut: "dose"}}


@pytest.mark.parametrize("kind", ["dict", "pandas", "polars", "file"])
def test_a_long_table_gives_the_same_fit_as_its_experiments(kind, tmp_path):
    table = long_table()
    if kind == "file":
        rows = [",".join(table), *(",".join("" if c is None else str(c) for c in row) for row in zip(*table.values()))]
        (table := tmp_path / "data.csv").write_text("\n".join(rows))
    elif kind != "dict":
        table = pytest.importorskip(kind).DataFrame(table)
    experiments = my.experiments_from_table(table, sigma="sd", **columns)
    assert [e.name for e in experiments] == ["25", "50", "100"] and experiments[2].start == {"gut": 100.0}
    assert repr(experiments[0]) == "<myriad_ode.Experiment '25': gut=25.0>"
    ours = my.likelihood(model, experiments, free=free, **tight)
    theirs = my.likelihood(model, measured(), free=free, sigma=0.3, **tight)
    assert ours.loss([1.0, 0.2]) == pytest.approx(theirs.loss([1.0, 0.2]), rel=1e-8)


def test_a_table_of_several_quantities_may_leave_cells_empty():
    table = {"id": ["a"] * 5, "t": [1, 1, 2, 2, 3], "quantity": ["blood", "gut", "blood", "gut", "blood"],
             "value": [1.0, 2.0, None, 3.0, 4.0]}
    e, = my.experiments_from_table(table)
    np.testing.assert_array_equal(e.data["blood"], [1, np.nan, np.nan, 4])
    np.testing.assert_array_equal(e.data["gut"], [np.nan, 2, 3, np.nan])
    np.testing.assert_array_equal(e.data["t"], [1, 1, 2, 3])


@pytest.mark.parametrize("changed, options, message", [
    ({}, {"t": "Time"}, "no column 'Time' for t=, but id, time, what, conc, dose, sd: name the right one"),
    ({}, {"quantity": "dvid"}, "no column 'dvid' for quantity=, .* or give of=x if all values are of x"),
    ({}, {"start": {gut: "DOSE"}}, "no column 'DOSE' for start= of 'gut'"),
    ({"conc": ["low"] + 14 * [1]}, {}, "row 1 of the table .*has 'low' in the column 'conc': give a number"),
    ({"dose": 15 * [None]}, {}, "experiment '25' has no value in the column for start= of 'gut'"),
    ({"dose": [1, 2] + 13 * [3]}, {}, "experiment '25' has the values 1, 2, 3 in the column for start= of 'gut'"),
    ({"conc": 7 * [None] + 8 * [1]}, {}, "experiment '25' has no values in column 'conc': leave its rows out"),
    ({"id": [None] + 14 * [1]}, {}, "row 1 of the table .*has nothing in the column 'id'"),
    ({"what": [None] + 14 * ["blood"]}, {}, "row 1 of the table .*has nothing in the column 'what'"),
])
def test_tables_with_faults_are_refused_by_column_and_row(changed, options, message):
    with pytest.raises(my.Error, match=message):
        my.experiments_from_table({**long_table(), **changed}, **{**columns, **options})


def test_what_is_no_table_is_refused():
    with pytest.raises(my.Error, match="the table .*is no table: give a data frame"):
        my.experiments_from_table(3)
    with pytest.raises(my.Error, match="the columns of the table .* have 0 rows"):
        my.experiments_from_table({name: [] for name in long_table()}, **columns)


good = {"t": [1, 2, 3], blood: [1, 1, 1]}
one = my.experiment(good, start={gut: 1})


@pytest.mark.parametrize("data, changed, message", [
    ([], {"own": ke}, "the list of experiments is empty"),
    ([one, my.experiment(good)], {}, "experiment '2' has no value of 'gut', which others set: give it in its start="),
    ([one, my.experiment({"t": [], blood: []}, start={gut: 1})], {}, "data of experiment '2' of 'blood' has .* none"),
    ([one, my.experiment({"t": [1, 2], "bloood": [1, 1]}, start={gut: 1})], {}, "did you mean 'blood'"),
    ([one, my.experiment({"t": [-1, 2], blood: [1, 1]}, start={gut: 1})], {}, "data of experiment '2' has the time -1"),
    ([one, my.experiment({blood: [1, 1]}, start={gut: 1})], {}, "data of experiment '2' has no times"),
    ([my.experiment(good, name="a")] * 2, {}, "2 experiments with the name 'a'"),
    ([one, my.experiment(good, start={gut: 1}, sweep={"kr": 1})], {}, "'kr' is no parameter or state that an"),
    ([one, my.experiment(good, sweep={gut: 1})], {}, "'gut' is in sweep= of experiment '2': give it in start="),
    ([one, my.experiment(good, start={gut: "g"})], {}, "'gut' in experiment '2' is 'g', which free= does not have"),
    ([one, one], {"own": ka}, "'ka' is no component of free=, for own="),
    ([one], {"own": ke}, "own= is for several experiments"),
    ([one, one], {"sigma": "s"}, "sigma of 'blood' is 's', which free= does not have: give its bounds there"),
    ([one, one], {"free": {ke: (0.1, 1), "s": (0.1, 1)}}, "'s' is no component that free= can name"),
    ([my.experiment(good, start={gut: 1}, sweep={ke: 1})], {}, "'ke' is in free=, and all experiments have values"),
    ([one, one], {"limits": {blood: (2, None)}}, "limits= need the deviations of the data"),
    ([one, one], {"sigma": 1, "limits": {blood: 2}}, r"limits= of 'blood' is 2: give the lower and the upper one"),
    ([one, one], {"sigma": 1, "limits": {blood: (2, 1)}}, "limits= of 'blood' are 2 and 1: give the lower one first"),
    ([one, one], {"sigma": 1, "limits": {"x": (2, 1)}}, "'x' is no quantity in data"),
    ([one, one], {"priors": {ke: my.priors.normal(1, 1)}}, "priors= need the deviations of the data"),
    ([one, one], {"sigma": 1, "priors": {ke: 3}}, "the prior of 'ke' is 3: give one of my.priors"),
    ([one, one], {"sigma": 1, "priors": {"x": my.priors.normal(1, 1)}}, "'x' is no free component, for priors="),
    ([one, one], {"sigma": 1, "free": {ke: (0, 1)}, "priors": {ke: my.priors.log_normal(1, 1)}}, "lower bound of 'ke'"),
    ([one, my.experiment(good, start={gut: 1}, sigma=1)], {}, "sigma= is given for some data and not for others"),
    ([my.experiment({"t": [1, 2], blood: [0, 1]}, start={gut: 1})], {"sigma": my.noise_models.log_normal(1)},
     "'blood' in experiment '1' has values that are not positive, and log-normal"),
    ([one, one], {"time": (0, 3)}, "a fit chooses time= itself"),
])
def test_experiments_that_do_not_fit_together_are_refused(data, changed, message):
    with pytest.raises(my.Error, match=message):
        my.fit(model, data, **{"free": {ke: (0.1, 1)}, "sweep": {ka: 1}, "start": {blood: 0}, **changed})


def test_a_shared_value_cannot_differ_by_experiment():
    rate = my.shared("rate")
    drained = my.model({blood: -rate * blood}, name="drained")
    with pytest.raises(my.Error, match="experiments set 'rate', which is no parameter or state: make it a parameter"):
        my.fit(drained, [my.experiment(good, sweep={rate: 1})], free={blood: (0.1, 1)})


def test_values_that_no_experiment_can_have_are_refused_where_they_are_given():
    for call, message in ((lambda: my.experiment(good, start={gut: [1, 2]}), "'gut' has several values in start="),
                          (lambda: my.experiment(good, sweep={ka: np.nan}), "sweep= of 'ka' is nan"),
                          (lambda: my.experiment(good, sweep=3), "sweep is 3: give a dict"),
                          (lambda: my.priors.normal(1, 0), "deviation of a prior is 0: give a positive number"),
                          (lambda: my.noise_models.proportional(-1), "share of a noise model is -1")):
        with pytest.raises(my.Error, match=message):
            call()


def test_proportional_noise_where_the_model_is_zero_says_why_there_is_no_likelihood():
    with pytest.raises(my.Error, match="likelihood of 'blood' is zero at all starts, as where the model is zero"):
        my.fit(model, {"t": [0, *times], blood: [0.1, *level(times, 25)]}, free={**free, "b": (0.01, 1)}, starts=2,
               sigma=my.noise_models.proportional("b"), **{**tight, "start": {gut: 25, blood: 0}})


def test_a_likelihood_has_no_residuals_and_says_what_to_use():
    with pytest.raises(my.Error, match="which is no sum of squares: use loss and gradient"):
        everything(my.noise_models.constant("a")).residuals([1, 0.1, 0.1])


def test_a_picture_has_the_data_of_each_experiment_over_its_curve():
    pytest.importorskip("matplotlib").use("Agg")
    from matplotlib import pyplot

    experiments = measured()
    fit = my.fit(model, experiments, free=free, sigma=0.3, starts=4, limits={blood: (11.0, None)}, **tight)
    axes, = fit.plot()
    named = {line.get_label(): line for line in axes.lines if not line.get_label().startswith("_")}
    assert list(named) == ["25 mg", "50 mg", "100 mg"]
    assert [text.get_text() for text in axes.get_legend().get_texts()] == list(named)
    assert len({line.get_color() for line in named.values()}) == 3
    best = fit.best["ka"], fit.best["ke"]
    for (dose, t, _), line in zip(doses_and_data(), named.values()):
        assert len(line.get_xdata()) == 400 and line.get_xdata()[-1] == t[-1]
        np.testing.assert_allclose(line.get_ydata(), level(line.get_xdata(), dose, *best), rtol=1e-4, atol=1e-6)
    below = [line for line in axes.lines if line.get_marker() == "v"]
    assert below and all((line.get_ydata() == 11).all() for line in below)
    pyplot.close("all")
