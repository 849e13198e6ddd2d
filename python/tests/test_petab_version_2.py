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
    ({"observables": TABLES["observables"].replace("log-normal", "laplace")},
     "row 'logged', column noiseDistribution: laplace"),
    ({"parameters": table("parameterId lowerBound upperBound nominalValue estimate priorDistribution priorParameters\n"
                          "k 0.01 10 0.5 true cauchy 3;5\na 0.1 20 2 true - -\nscale 0.1 20 1.5 true - -\n"
                          "wide - - 0.4 false - -")}, "row 'k', column priorDistribution: cauchy"),
    ({"experiments": TABLES["experiments"] + "alone\t-inf\tless\n",
      "measurements": TABLES["measurements"] + "logged\talone\t1\t1\t\t\n"}, "experiment 'alone' at 1: .* alone"),
    ({"measurements": TABLES["measurements"] + "logged\tdoses\t0.5\t1\t\t\n"}, "'doses' at 0.5: it begins at 1"),
    ({"measurements": TABLES["measurements"] + "logged\tdoses\tinf\t1\t\t\n"}, "'doses' at inf: a steady"),
    ({"conditions": TABLES["conditions"] + "less\tnothing\t1\n"}, "nothing"),
    ({"extra": "extensions:\n  sciml:\n    version: 1.0.0\n    required: true\n"}, "extension sciml"),
])
def test_what_is_not_supported_is_refused_by_name(tmp_path, tables, message):
    with pytest.raises(my.Error, match=message):
        my.read_petab(write(tmp_path, **tables))


def test_priors_of_the_standard_are_those_of_version_1(tmp_path):
    stats = pytest.importorskip("scipy.stats")
    head, *rows = TABLES["parameters"].splitlines()
    priors = ["laplace\t0.5;0.2", "log-normal\t0.3;0.4", "uniform\t0.5;3", "\t"]
    with_priors = "\n".join([f"{head}\tpriorDistribution\tpriorParameters", *map("\t".join, zip(rows, priors))]) + "\n"
    problem = my.read_petab(write(tmp_path, parameters=with_priors))
    assert problem.free["scale"] == (0.5, 3.0)
    likelihood = problem.likelihood(**tight)
    densities = stats.laplace.logpdf(AT[0], 0.5, 0.2) + stats.lognorm.logpdf(AT[1], 0.4, scale=np.exp(0.3))
    assert likelihood.loss(AT) == pytest.approx(-likelihood.log_likelihood(AT) - densities, rel=1e-7)


NAMED = sbml.document([sbml.compartment("c", 1.0), sbml.species("Pi", concentration=4.0), sbml.parameter("Time", 2.0),
                       sbml.parameter("k", 0.5), sbml.reaction("loss", "Pi ->", "k * Pi")])


@pytest.mark.parametrize("formula, expected", [
    ("k*sqrt(Pi)", lambda t: 0.5 * 2 * np.exp(-0.25 * t)), ("Pi^(1/3)/sqrt(k)", lambda t: (
        (4 * np.exp(-0.5 * t))**(1 / 3) / 0.5**0.5)),
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
