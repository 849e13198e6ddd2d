# SPDX-License-Identifier: MIT
"""Problems of PEtab whose experiments begin in steady states or are measured in them, compared with closed forms."""

import numpy as np
import pytest

import myriad_ode as my

pytest.importorskip("petab.v1")
import sbml_models as sbml  # noqa: E402, which needs libsbml
from differences import by_differences  # noqa: E402
from test_petab import table, tight, write  # noqa: E402

# A turns into B at the rate forth and back at the rate back; A + B is conserved.
REACTIONS = [
    sbml.compartment("c", 1.0), sbml.species("A", concentration=1.0), sbml.species("B", concentration=0.5),
    sbml.parameter("forth", 1.0), sbml.parameter("back", 0.6), sbml.reaction("there", "A -> B", "forth * A * c"),
    sbml.reaction("again", "B -> A", "back * B * c")]
MODEL = sbml.document(REACTIONS)
TABLES = {
    "parameters": table("""
parameterId parameterScale lowerBound upperBound nominalValue estimate
back        log10          0.01       10         0.6          1
k_before    log10          0.01       10         0.3          1
b_before    lin            0          10         2            1
b0          lin            0          10         1            1"""),
    "conditions": table("""
conditionId forth    A B
before      k_before - b_before
resting     0.2      - 0.5
kept        0.8      - -
anew        0.8      - b0"""),
    "observables": table("""
observableId observableFormula noiseFormula
a            A                 0.5
ratio        A/(A+B)           0.1"""),
    "measurements": table("""
observableId preequilibrationConditionId simulationConditionId time measurement
a     before  kept 0   0.5
a     before  kept 1   0.7
ratio before  kept 1   0.4
a     before  anew 0   0.5
a     before  anew 2   0.3
a     before  anew inf 0.3
ratio -       anew 2   0.3
a     -       anew inf 0.3
a     resting anew 1   0.3"""),
}
AT = np.array([0.5, 0.35, 1.7, 1.2])


def expected(back, k_before, b_before, b0):
    """A at the measurements."""
    def later(t, a, b, forth):
        end = (a + b) * back / (forth + back)
        return end + (a - end) * np.exp(-(forth + back) * t)

    def rest(forth, a, b):
        return (a + b) * back / (forth + back), (a + b) * forth / (forth + back)

    a, b = rest(k_before, 1.0, b_before)
    c, _ = rest(0.2, 1.0, 0.5)
    end = back / (0.8 + back)
    return np.array([a, later(1, a, b, 0.8), later(1, a, b, 0.8) / (a + b), a, later(2, a, b0, 0.8), (a + b0) * end,
                     later(2, 1, b0, 0.8) / (1 + b0), (1 + b0) * end, later(1, c, b0, 0.8)])


@pytest.fixture
def problem(tmp_path):
    return my.read_petab(write(tmp_path, MODEL, **TABLES))


def test_experiments_begin_in_steady_states_and_are_measured_in_them(problem):
    assert problem.conditions == ["kept after before", "anew after before", "anew", "anew after resting"]
    simulated = problem.simulate(AT, interpreted=True, **tight)["simulation"]
    np.testing.assert_allclose(simulated, expected(*AT), rtol=1e-9)


def test_derivatives_go_through_steady_states_of_conserved_sums(problem):
    likelihood = problem.likelihood(**tight)
    np.testing.assert_allclose(likelihood.gradient(AT), by_differences(likelihood.loss, AT), rtol=1e-6, atol=1e-8)
    by = np.stack([(expected(*(AT + e)) - expected(*(AT - e))) / 2e-6 for e in 1e-6 * np.eye(4)], axis=1)
    deviations = np.where([label[0] == "a" for label in likelihood.labels], 0.5, 0.1)
    order = [0, 1, 3, 4, 5, 7, 8, 2, 6]  # by observable
    np.testing.assert_allclose(likelihood.jacobian(AT) * deviations[:, None], by[order], rtol=1e-6, atol=1e-8)


def test_what_has_a_value_before_alone_needs_none_in_the_file(tmp_path):
    model = sbml.document([sbml.species("B") if part is REACTIONS[2] else part for part in REACTIONS])
    kept = "\n".join(TABLES["measurements"].splitlines()[:4]) + "\n"
    simulated = my.read_petab(write(tmp_path, model, **{**TABLES, "measurements": kept})).simulate(
        AT, interpreted=True, **tight)["simulation"]
    np.testing.assert_allclose(simulated, expected(*AT)[:3], rtol=1e-9)


def test_many_sets_are_as_one_by_one(problem):
    likelihood = problem.likelihood(interpreted=True, **tight)
    sets = np.stack([AT, 2 * AT, [0.6, 0.0, 2.0, 1.0]])
    np.testing.assert_allclose(likelihood.log_likelihood(sets), [likelihood.log_likelihood(s) for s in sets],
                               rtol=1e-9)


def test_steady_states_that_depend_on_the_way_there_have_derivatives(tmp_path):
    # x' = -k x y, y' = -y: x ends at x0 exp(-k y0), and anything else would be a steady state too.
    model = sbml.document([
        sbml.compartment("c", 1.0), sbml.species("x", concentration=2.0), sbml.species("y", concentration=1.5),
        sbml.parameter("k", 1.0), sbml.reaction("eaten", "x ->", "k * x * y * c", modifiers="y"),
        sbml.reaction("gone", "y ->", "y * c")])
    problem = my.read_petab(write(
        tmp_path, model, parameters=table("parameterId parameterScale lowerBound upperBound nominalValue estimate\n"
                                          "k log10 0.01 10 0.6 1"), conditions="conditionId\nusual\n",
        observables=table("observableId observableFormula noiseFormula\nseen x 1"),
        measurements=table("observableId simulationConditionId time measurement\nseen usual inf 0")))
    likelihood = problem.likelihood(**tight)
    assert problem.simulate([0.6], **tight)["simulation"][0] == pytest.approx(2 * np.exp(-0.9), rel=1e-6)
    assert likelihood.jacobian([0.6])[0, 0] == pytest.approx(-3 * np.exp(-0.9), rel=1e-5)


def test_a_condition_without_a_steady_state_has_no_likelihood(tmp_path):
    # Without a loss B grows for ever.
    tables = {**TABLES, "measurements": "\n".join(TABLES["measurements"].splitlines()[:4]) + "\n"}
    model = sbml.document([*REACTIONS, sbml.reaction("growth", "-> B", "0.1 * c")])
    likelihood = my.read_petab(write(tmp_path, model, **tables)).likelihood(interpreted=True, method="rodas_5p")
    assert np.isnan(likelihood.log_likelihood(AT))
    assert likelihood.steady_states(AT) == {"before": "no steady state"}


def test_each_steady_state_has_a_status(problem):
    assert problem.likelihood(interpreted=True).steady_states(AT) == {
        name: "steady state" for name in ("before", "resting", "anew after before", "anew")}
