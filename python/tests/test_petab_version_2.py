# SPDX-License-Identifier: MIT
"""Problems in version 2 of PEtab, written as files, compared with closed forms."""

import numpy as np
import pytest

import myriad_ode as my

pytest.importorskip("petab.v2")
import sbml_models as sbml  # noqa: E402, which needs libsbml
from differences import by_differences  # noqa: E402
from test_petab import level, table, tight  # noqa: E402

# A is lost at the rate k and made at the rate b: A = b / k + (A0 - b / k) exp(-k t).
MODEL = sbml.document([sbml.compartment("c", 2.0), sbml.species("A", concentration=1.5), sbml.parameter("k", 9.0),
                       sbml.parameter("b", 0.3), sbml.reaction("loss", "A ->", "k * A * c"),
                       sbml.reaction("making", "-> A", "b * c")])
TABLES = {
    "parameters": table("""
parameterId lowerBound upperBound nominalValue estimate
k           0.01       10         0.5          true
a           0.1        20         2            true
scale       0.1        20         1.5          true
wide        -          -          0.4          false"""),
    "conditions": table("""
conditionId targetId targetValue
start       A        a+scale
start       b        wide
more        A        A+a
less        b        0.1"""),
    "experiments": table("""
experimentId time conditionId
short        0    start
doses        1    start
doses        3    more
doses        3    less
rested       -inf less
rested       2    more
rested       4    -"""),
    "observables": table("""
observableId observableFormula noiseFormula noiseDistribution observablePlaceholders noisePlaceholders
seen         factor*A+offset   width        normal            factor;offset          width
logged       A+b               0.1+A/10     log-normal        -                      -"""),
    "measurements": table("""
observableId experimentId time measurement observableParameters noiseParameters
seen         short        0    3           scale;0.1            0.2
seen         short        2    2           2;a                  wide
logged       short        2    1.2         -                    -
logged       doses        1    1.2         -                    -
seen         doses        2    2           1;0                  0.2
seen         doses        3    2           1;0                  0.2
logged       doses        5    1.2         -                    -
logged       rested       2    1.2         -                    -
logged       rested       5    1.2         -                    -
seen         -            1    1           1;0                  0.2"""),
}
AT = np.array([0.6, 1.2, 0.8])


def write(folder, model=MODEL, extra="", **tables):
    """A problem's files; returns the path of its YAML."""
    (folder / "model.xml").write_text(model)
    names = {**TABLES, **tables}
    for name, text in names.items():
        (folder / f"{name}.tsv").write_text(text)
    (folder / "problem.yaml").write_text("format_version: 2.0.0\nmodel_files:\n  m:\n    language: sbml\n"
                                         "    location: model.xml\n" + "".join(
        f"{name.rstrip('s')}_files: [{name}.tsv]\n" for name in names) + extra)
    return folder / "problem.yaml"


def expected(k, a, scale):
    """The observables at the measurements."""
    first = level(2, k, 0.4, a + scale)  # at the time 3 of an experiment that begins at 1
    dosed = level(2, k, 0.1, first + a)
    rest = 0.1 / k
    return np.array([scale * (a + scale) + 0.1, 2 * first + a, first + 0.4, a + scale + 0.4,
                     level(1, k, 0.4, a + scale), first + a, dosed + 0.1, rest + a + 0.1,
                     level(3, k, 0.1, rest + a) + 0.1, level(1, k, 0.3, 1.5)])


def test_experiments_of_several_periods_are_simulated(tmp_path):
    problem = my.read_petab(write(tmp_path))
    assert problem.free == {"k": (0.01, 10.0), "a": (0.1, 20.0), "scale": (0.1, 20.0)}
    assert problem.conditions == ["short", "doses", "rested", ""]
    simulated = problem.simulate(AT, interpreted=True, **tight)
    np.testing.assert_allclose(simulated["simulation"], expected(*AT), rtol=1e-8)
    assert list(simulated["experimentId"].dropna().unique()) == ["short", "doses", "rested"]


def test_the_likelihood_is_the_formula_of_the_standard(tmp_path):
    likelihood = my.read_petab(write(tmp_path)).likelihood(interpreted=True, **tight)
    m, y = expected(*AT), np.array([3, 2, 1.2, 1.2, 2, 2, 1.2, 1.2, 1.2, 1])
    logged = np.array([0, 0, 1, 1, 0, 0, 1, 1, 1, 0], bool)
    b = np.array([0, 0, 0.4, 0.4, 0, 0, 0.1, 0.1, 0.1, 0])
    s = np.where(logged, 0.1 + (m - b) / 10, np.array([0.2, 0.4, 0, 0, 0.2, 0.2, 0, 0, 0, 0.2]))
    r = np.where(logged, np.log(m) - np.log(y), m - y) / s
    loss = 0.5 * r**2 + np.log(s * np.sqrt(2 * np.pi)) + np.where(logged, np.log(y), 0)
    assert likelihood.log_likelihood(AT) == pytest.approx(-loss.sum(), rel=1e-8)
    assert ("seen", "doses", 3.0) in likelihood.labels


def test_gradients_go_through_periods(tmp_path):
    likelihood = my.read_petab(write(tmp_path)).likelihood(**tight)
    np.testing.assert_allclose(likelihood.gradient(AT), by_differences(likelihood.loss, AT), rtol=1e-5)


RESIZED = sbml.document([
    sbml.compartment("c", 2.0), sbml.species("A", concentration=3.0), sbml.parameter("k", 1.0),
    sbml.reaction("loss", "A ->", "k * A * c")])


def test_a_compartment_changes_and_concentrations_stay(tmp_path):
    # Of what is not changed too the concentration stays; the event of a model comes after a period's changes.
    simple = {"parameters": table("parameterId lowerBound upperBound nominalValue estimate\nk 0.1 10 0.5 true"),
              "conditions": table("conditionId targetId targetValue\ngrow c 5"),
              "experiments": table("experimentId time conditionId\ne 0 -\ne 2 grow"),
              "observables": table("observableId observableFormula noiseFormula\nlevel A 1\nsize c 1"),
              "measurements": table("observableId experimentId time measurement\nlevel e 2 1\nlevel e 3 1\nsize e 1 1\n"
                                    "size e 2 1")}
    model = RESIZED.replace('id="c" size="2.0" constant="true"', 'id="c" size="2.0" constant="false"')
    simulated = my.read_petab(write(tmp_path, model, **simple)).simulate(interpreted=True, **tight)["simulation"]
    np.testing.assert_allclose(simulated, [3 * np.exp(-1), 3 * np.exp(-1.5), 2, 5], rtol=1e-8)


@pytest.mark.parametrize("tables, message", [
    ({"parameters": table("parameterId lowerBound upperBound nominalValue estimate priorDistribution priorParameters\n"
                          "k 0.01 10 0.5 true gamma 3;-5\na 0.1 20 2 true - -\nscale 0.1 20 1.5 true - -\n"
                          "wide - - 0.4 false - -")}, "Prior parameters .*-5"),
    ({"measurements": TABLES["measurements"] + "logged\tdoses\t0.5\t1\t\t\n"}, "'doses' at 0.5: it begins at 1"),
    ({"measurements": TABLES["measurements"] + "logged\tdoses\tinf\t1\t\t\n"}, "'doses' at inf: a steady"),
    ({"conditions": TABLES["conditions"] + "less\tnothing\t1\n"}, "nothing"),
    ({"extra": "extensions:\n  sciml:\n    version: 1.0.0\n    required: true\n"}, "extension sciml"),
])
def test_what_is_not_supported_is_refused_by_name(tmp_path, tables, message):
    with pytest.raises(my.Error, match=message):
        my.read_petab(write(tmp_path, **tables))


def with_priors(*priors):
    head, *rows = TABLES["parameters"].splitlines()
    return "\n".join([f"{head}\tpriorDistribution\tpriorParameters", *map("\t".join, zip(rows, priors))]) + "\n"


@pytest.mark.parametrize("kind, numbers, frozen", [
    ("normal", "0.5;0.2", lambda s: s.norm(0.5, 0.2)), ("laplace", "0.5;0.2", lambda s: s.laplace(0.5, 0.2)),
    ("cauchy", "0.5;0.2", lambda s: s.cauchy(0.5, 0.2)), ("gamma", "3;0.2", lambda s: s.gamma(3, scale=0.2)),
    ("gamma", "0.5;2", lambda s: s.gamma(0.5, scale=2)), ("exponential", "0.7", lambda s: s.expon(scale=0.7)),
    ("chisquare", "4", lambda s: s.chi2(4)), ("rayleigh", "0.7", lambda s: s.rayleigh(scale=0.7)),
    ("log-normal", "0.3;0.4", lambda s: s.lognorm(0.4, scale=np.exp(0.3))),
    ("log-laplace", "0.3;0.4", lambda s: s.loglaplace(1 / 0.4, scale=np.exp(0.3))),
    ("log-uniform", "0.02;3", lambda s: s.loguniform(0.02, 3)), ("uniform", "0.5;3", lambda s: s.uniform(0.5, 2.5)),
])
def test_priors_have_their_densities_between_the_bounds(tmp_path, kind, numbers, frozen):
    # Parameters without a prior have a uniform one where another has one.
    stats = pytest.importorskip("scipy.stats")
    problem = my.read_petab(write(tmp_path, parameters=with_priors(f"{kind}\t{numbers}", "\t", "\t", "\t")))
    prior = frozen(stats)
    if kind not in ("normal", "laplace", "cauchy"):
        assert problem.free["k"] == (max(0.01, prior.ppf(0)), pytest.approx(min(10, prior.ppf(1))))
    likelihood = problem.likelihood(**tight)
    for k in (0.55, 0.9, 2.7):
        at = [k, *AT[1:]]
        density = prior.logpdf(k) - np.log(prior.cdf(10) - prior.cdf(0.01)) - 2 * np.log(20 - 0.1)
        assert likelihood.loss(at) == pytest.approx(-likelihood.log_likelihood(at) - density, abs=1e-7)
    (component, found), *_ = likelihood._experiment.priors
    assert component == 0
    np.testing.assert_allclose(prior_slope(found, 0.9), by_differences(lambda k: prior_loss(found, k[0]), [0.9])[0],
                               rtol=1e-6, atol=1e-7)
    assert np.isinf(prior_loss(found, -0.1)) or kind in ("normal", "laplace", "cauchy", "uniform")


def prior_loss(prior, k):
    with np.errstate(invalid="ignore"):
        loss = prior.terms(np.array([[k]]))[0].item()
    return np.inf if np.isnan(loss) else loss


def prior_slope(prior, k):
    _, r, inner = prior.terms(np.array([[k]]))
    return (r * inner).item()


@pytest.mark.parametrize("prior", ["uniform\t11;12", "gamma\t3;1e-9"])
def test_a_prior_that_the_bounds_cut_off_whole_is_refused(tmp_path, prior):
    with pytest.raises(my.Error, match="row 'k', column priorDistribution: the prior is zero between the bounds"):
        my.read_petab(write(tmp_path, parameters=with_priors(prior, "\t", "\t", "\t")))


def test_a_prior_without_bounds_has_quantiles_for_a_fit_to_begin_between(tmp_path):
    stats = pytest.importorskip("scipy.stats")
    parameters = with_priors("log-normal\t0;0.2", "normal\t2;1", "\t", "\t").replace("0.01\t10", "0\tinf").replace(
        "a\t0.1\t20", "a\t-inf\tinf")
    problem = my.read_petab(write(tmp_path, parameters=parameters))
    assert problem.free["k"] == (0.0, pytest.approx(stats.lognorm.ppf(1 - 1e-9, 0.2)))
    assert problem.free["a"] == pytest.approx(stats.norm.ppf([1e-9, 1 - 1e-9], 2, 1))
    likelihood = problem.likelihood(**tight)
    density = stats.lognorm.logpdf(AT[0], 0.2) + stats.norm.logpdf(AT[1], 2, 1) - np.log(19.9)
    assert likelihood.loss(AT) == pytest.approx(-likelihood.log_likelihood(AT) - density, rel=1e-7)


def test_a_steady_state_alone_is_measured_at_any_time(tmp_path):
    problem = my.read_petab(write(
        tmp_path, experiments=table("experimentId time conditionId\nshort 0 start\nalone -inf less"),
        measurements=TABLES["measurements"].split("logged\tdoses")[0] + "logged\talone\t1\t1\t\t\n"
        "logged\talone\tinf\t1\t\t\n"))
    likelihood = problem.likelihood(interpreted=True, **tight)
    np.testing.assert_allclose(likelihood.simulate(AT), [*expected(*AT)[:3], *[0.1 / AT[0] + 0.1] * 2], rtol=1e-7)
    np.testing.assert_allclose(likelihood.gradient(AT), by_differences(likelihood.loss, AT), rtol=1e-5)


@pytest.mark.parametrize("kind", ["laplace", "log-laplace"])
def test_noise_of_laplaces_distribution(tmp_path, kind):
    stats = pytest.importorskip("scipy.stats")
    problem = my.read_petab(write(tmp_path, observables=TABLES["observables"].replace("log-normal", kind)))
    likelihood = problem.likelihood(**tight)
    logged = (problem.measurements["observableId"] == "logged").to_numpy()
    m, y = expected(*AT), problem.measurements["measurement"].to_numpy(float)
    b = np.array([0, 0, 0.4, 0.4, 0, 0, 0.1, 0.1, 0.1, 0])
    s = np.where(logged, 0.1 + (m - b) / 10, np.array([0.2, 0.4, 0, 0, 0.2, 0.2, 0, 0, 0, 0.2]))
    density = (stats.laplace.logpdf(y, m, s) if kind == "laplace" else
               stats.laplace.logpdf(np.log(y), np.log(m), s) - np.log(y))
    log_likelihood = np.where(logged, density, stats.norm.logpdf(y, m, s)).sum()
    assert likelihood.log_likelihood(AT) == pytest.approx(log_likelihood, rel=1e-8)
    assert likelihood.loss(AT) == pytest.approx(-log_likelihood, rel=1e-8)
    np.testing.assert_allclose(likelihood.gradient(AT), by_differences(likelihood.loss, AT), rtol=1e-5)
    with pytest.raises(my.Error, match="Laplace"):
        likelihood.residuals(AT)


NAMED = sbml.document([sbml.compartment("c", 1.0), sbml.species("Pi", concentration=4.0), sbml.parameter("Time", 2.0),
                       sbml.parameter("k", 0.5), sbml.reaction("loss", "Pi ->", "k * Pi")])


@pytest.mark.parametrize("formula, expected", [
    ("k*sqrt(Pi)", lambda t: 0.5 * 2 * np.exp(-0.25 * t)), ("Pi^(1/3)/sqrt(k)", lambda t: (
        (4 * np.exp(-0.5 * t))**(1 / 3) / 0.5**0.5)),
    ("log(Pi, 2)+sign(Pi-2)", lambda t: 2 - 0.5 * t / np.log(2) + np.sign(4 * np.exp(-0.5 * t) - 2)),
    ("Pi+0*Time", lambda t: 4 * np.exp(-0.5 * t)), ("Time*k", lambda t: 1 + 0 * t),
    ("piecewise(7, (time >= 1 && k < 1) || k > 8, 3)", lambda t: np.where(t >= 1, 7, 3)),
])
def test_roots_names_like_constants_and_logic_are_read_as_they_stand(tmp_path, formula, expected):
    simple = {"parameters": table("parameterId lowerBound upperBound nominalValue estimate\nk 0.1 10 0.5 true"),
              "conditions": table("conditionId targetId targetValue\nstart Pi 4*sqrt(4*k*k)"),
              "experiments": table("experimentId time conditionId\ne 0 start"),
              "observables": f"observableId\tobservableFormula\tnoiseFormula\nseen\t{formula}\t1\n",
              "measurements": table("observableId experimentId time measurement\nseen e 0.5 1\nseen e 2 1")}
    model = NAMED.replace("<pi/>", "<ci>Pi</ci>")
    simulated = my.read_petab(write(tmp_path, model, **simple)).simulate(interpreted=True, **tight)["simulation"]
    np.testing.assert_allclose(simulated, expected(np.array([0.5, 2.0])), rtol=1e-8)


def test_a_measurement_at_the_begin_of_a_later_period_at_zero_is_of_after_its_changes(tmp_path):
    simple = {"parameters": table("parameterId lowerBound upperBound nominalValue estimate\nk 0.1 10 0.5 true"),
              "conditions": table("conditionId targetId targetValue\nmore A A+2"),
              "experiments": table("experimentId time conditionId\ne -3 -\ne 0 more"),
              "observables": table("observableId observableFormula noiseFormula\nlevel A 1"),
              "measurements": table("observableId experimentId time measurement\nlevel e 0 1")}
    simulated = my.read_petab(write(tmp_path, RESIZED, **simple)).simulate(interpreted=True, **tight)["simulation"]
    np.testing.assert_allclose(simulated, [3 * np.exp(-1.5) + 2], rtol=1e-8)
