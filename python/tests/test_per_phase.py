# SPDX-License-Identifier: MIT
"""What follows from constants alone is computed once per phase, in models from files."""

import numpy as np
import pytest

pytest.importorskip("libsbml")

import myriad_ode as my  # noqa: E402
from myriad_ode.symbolic.operations import cost  # noqa: E402
from myriad_ode.models.once_per_phase import most_accessories, prepared  # noqa: E402
from sbml_models import compartment, document, event, parameter, rate, reaction, species, variable  # noqa: E402

_hill = [compartment("c", 2), species("S", concentration=3), species("P", concentration=0),
         parameter("Vmax", 1.5), parameter("K", 0.7), parameter("n", 2.5), parameter("enzyme", 0.4),
         reaction("R", "S -> P", "c * Vmax * enzyme * pow(S, n) / (pow(K, n) + pow(S, n))")]


def hill(*more, **options):
    return my.read_sbml(document([*_hill, *more]), **options)


def _exact(t, y, c, Vmax, K, n, enzyme):
    rate = c * Vmax * enzyme * y[0]**n / (K**n + y[0]**n)
    return [-rate / c, rate / c]


def test_powers_products_and_reciprocals_of_constants_are_no_part_of_the_equations():
    model = hill()
    made = prepared(model)
    assert sorted(map(str, (value for _, value in made.initialise))) == [
        "1 / c", "c * Vmax * enzyme", "pow(K, n)"]
    assert cost(model.rhs) >= cost(made.rhs) + 40  # the instructions of a power
    assert prepared(model) is made
    assert "per_phase" not in model.cpp() and model.accessories == []


def test_models_that_users_write_stay_as_they_are():
    x, k, q = my.state("x"), *my.parameters("k q")
    model = my.model({x: -x / (k * q)})
    assert prepared(model) is model


@pytest.mark.parametrize("interpreted", [True, False])
def test_runs_are_those_of_the_equations_as_they_are_written(interpreted):
    values = {"K": np.linspace(0.2, 2, 7), "c": np.linspace(1, 4, 7)}
    run = my.solve(hill(), values, time=(0, 4), samples=9, rtol=1e-10, interpreted=interpreted)
    plain = my.model(_exact, states="S P", name="plain")
    expected = my.solve(plain, {**values, "Vmax": 1.5, "n": 2.5, "enzyme": 0.4}, start={"S": 3, "P": 0}, time=(0, 4),
                        samples=9, rtol=1e-10, interpreted=interpreted)
    np.testing.assert_allclose(run["P"], expected["P"], rtol=1e-8, atol=1e-12)
    assert run.accessories == {}
    rate = values["c"][:, None] * 0.6 * run["S"]**2.5 / (values["K"][:, None]**2.5 + run["S"]**2.5)
    np.testing.assert_allclose(run["R"], rate, rtol=1e-12)  # an output


def test_a_study_draws_the_constants_and_keeps_what_users_have_named():
    result = my.study(hill(), {"K": my.uniform(0.2, 2)}, draws=40, seed=3, time=(0, 4), rtol=1e-9).run()
    assert not any("per_phase" in name for name in result.names)
    run = my.solve(hill(), {"K": result["K"]}, time=(0, 4), rtol=1e-9)
    np.testing.assert_allclose(result["P_end"], run["P"], rtol=1e-13)


def test_constants_that_an_event_changes_are_read_at_every_evaluation(tmp_path):
    path = tmp_path / "switch.ode"
    path.write_text("par a=2, b=3, c=5\nx'=-x*a*b/(b*c)\ninit x=1\nglobal 1 t-1 {a=4}\n@ total=2\ndone\n")
    model = my.read_xpp(path)
    made = prepared(model)
    assert [str(value) for _, value in made.initialise] == ["1 / (b * c)"]
    run = my.solve(model, time=(0, 2), rtol=1e-10)
    assert run["x"][0] == pytest.approx(np.exp(-2 / 5 - 4 / 5), rel=1e-8)


def test_values_follow_a_constant_that_changes_between_calls_and_phases():
    model = hill()
    whole = my.solve(model, {"K": 0.5}, time=(0, 4), rtol=1e-10)
    parts = my.solve(model, {"K": 0.5}, time=(0, 4), phases=2, phase_length=2, rtol=1e-10)
    np.testing.assert_allclose(parts["P"], whole["P"], rtol=1e-8)
    assert abs(my.solve(model, {"K": 5.0}, time=(0, 4))["P"] - whole["P"]).max() > 0.1


def test_an_event_reads_what_is_computed_once():
    model = hill(parameter("share", 0.5), variable("seen", 0),
                 event("P > share * K * enzyme", {"seen": "time"}, id="reached"))
    run = my.solve(model, {"share": [0.5, 1, 2]}, time=(0, 6), rtol=1e-10, samples=2001)
    for i, share in enumerate([0.5, 1, 2]):
        threshold = share * 0.7 * 0.4
        at = np.interp(threshold, run["P"][i], run.t_sample[i])
        assert run["seen"][i, -1] == pytest.approx(at, rel=1e-5)


def test_a_small_model_keeps_few_accessories():
    room, count = most_accessories[0], 8
    parts = [parameter(f"{p}{i}", 1.5) for p in "ab" for i in range(count)]
    rates = [variable(f"x{i}", 1) for i in range(count)]
    model = my.read_sbml(document([*parts, *rates, *(rate(f"x{i}", f"-x{i} * pow(a{i}, b{i})")
                                                     for i in range(count))]))
    made = prepared(model)
    assert len(made.accessories) == room
    run = my.solve(model, time=(0, 1), interpreted=True)
    np.testing.assert_allclose(run["x7"], np.exp(-1.5**1.5), rtol=1e-5)


def test_divisions_stay_where_there_is_no_room_for_the_reciprocals():
    count = most_accessories[-1] + 5
    parts = [parameter(f"a{i}", 2) for i in range(count)] + [variable(f"x{i}", 1) for i in range(count)]
    model = my.read_sbml(document([*parts, *(rate(f"x{i}", f"-x{i} / a{i}") for i in range(count))]))
    made = prepared(model)
    assert len(made.accessories) == count - 5
    assert cost(made.rhs) == cost(model.rhs) - 7 * (count - 5)  # a multiplication takes 1 instruction, a division 8
