# SPDX-License-Identifier: MIT
"""Models from files of SBML: what their elements mean, and what is refused."""

import argparse
import importlib.util
import pathlib
import sys
import time

import numpy as np
import pytest

import myriad_ode as my

pytest.importorskip("libsbml", reason="models of SBML are read by the package python-libsbml")

import sbml_models  # noqa: E402
from sbml_models import (Case, always, compartment, event, initially, parameter, rate, reaction, species,  # noqa: E402
                         variable)

_script = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "sbml_suite.py"
_specification = importlib.util.spec_from_file_location("sbml_suite", _script)
suite = importlib.util.module_from_spec(_specification)
_specification.loader.exec_module(suite)
_options = argparse.Namespace(device="cpu:1", compiled=False, method="dormand_prince_5", time_limit=60.0)


def _split(case):
    """Cases that check one species both as amount and as concentration, as two: a table has one column for it."""
    def kind(name):
        return name.rpartition("_")[2] if name.endswith(("_amount", "_concentration")) else ""

    both = {n.rpartition("_")[0] for n in case.results if kind(n) == "amount"} & {
        n.rpartition("_")[0] for n in case.results if kind(n) == "concentration"}
    if not both:
        return [case]
    return [Case(case.name, case.parts, {n: f for n, f in case.results.items() if kind(n) != other}, case.end,
                 case.attributes) for other in ("amount", "concentration")]


@pytest.mark.parametrize("case", sbml_models.cases, ids=lambda case: case.name)
def test_a_model_means_what_sbml_says(case, tmp_path):
    for number, part in enumerate(_split(case)):
        folder = sbml_models.write(tmp_path, part, number)
        outcome, why = suite.outcome_of(folder, suite.models_of(folder, False)[0], _options)
        assert outcome == "right", why


@pytest.mark.parametrize("parts, said", sbml_models.refused, ids=lambda value: value if isinstance(value, str) else "")
def test_what_is_not_supported_is_refused_with_its_element(parts, said):
    with pytest.raises(my.Error) as error:
        my.read_sbml(sbml_models.document(parts))
    assert said in str(error.value)


_decay = sbml_models.document([
    compartment("c", 2), species("A", amount=3), species("B", concentration=1), parameter("k", 0.5), parameter("k2"),
    initially("k2", "2 * k"), reaction("R", "A -> B", "c * k2 * A"), variable("total"), always("total", "A + B")])


def test_initial_values_follow_what_they_depend_on():
    model = my.read_sbml(_decay)
    assert model.start() == {"c": 2, "k": 0.5, "k2": 1, "A": 1.5, "B": 1}
    volumes, rates = np.array([1.0, 2.0, 4.0]), np.array([0.5, 0.25, 0.125])
    run = my.solve(model, {"c": volumes, "k": rates}, time=(0, 1), interpreted=True, rtol=1e-10, atol=1e-12)
    np.testing.assert_allclose(run["A"], 3 / volumes * np.exp(-2 * rates), rtol=1e-8)
    np.testing.assert_allclose(run["total"], 3 / volumes + 1, rtol=1e-8)
    grid = my.solve(model, my.grid(c=volumes, k=rates), time=(0, 1), interpreted=True, rtol=1e-10, atol=1e-12)
    np.testing.assert_allclose(grid["A"].reshape(3, 3), 3 / volumes[:, None] * np.exp(-2 * rates), rtol=1e-8)


def test_values_that_are_given_come_before_initial_assignments():
    run = my.solve(my.read_sbml(_decay), {"k2": [1.0, 2.0]}, start={"A": 5}, time=(0, 1), interpreted=True, rtol=1e-10)
    np.testing.assert_allclose(run["A"], 5 * np.exp([-1.0, -2.0]), rtol=1e-8)
    np.testing.assert_array_equal(run["k"], 0.5)


def test_outputs_are_where_the_states_are():
    model = my.read_sbml(_decay)
    run = my.solve(model, time=(0, 1), samples=11, interpreted=True)
    np.testing.assert_array_equal(run["R"], 2 * run["k2"][:, None] * run["A"])
    assert run["total"].shape == (1, 11)
    phases = my.solve(model, time=(0, 1), phases=3, record=["A"], interpreted=True)
    assert phases["R"].shape == (1, 3)  # of what is recorded
    assert phases["total"].shape == (1,)  # of what is known at the end alone
    table = my.solve(model, {"k": [0.5, 0.25]}, time=(0, 1), samples=11, interpreted=True).to_xarray()
    assert table["R_sample"].dims == ("instance", "sample") and table["total_sample"].dims == ("instance", "sample")


def test_constants_that_are_not_swept_are_written_into_the_equations():
    model = my.read_sbml(_decay, parameters="k")
    assert model.parameters == ["k", "k2"]  # which follows from k
    run = my.solve(model, {"k": [0.5, 0.25]}, time=(0, 1), interpreted=True, rtol=1e-10)
    np.testing.assert_allclose(run["A"], 1.5 * np.exp([-1.0, -0.5]), rtol=1e-8)
    assert my.read_sbml(_decay, parameters=()).parameters == []


def test_a_model_is_read_from_a_file_as_from_its_text(tmp_path):
    (tmp_path / "model.xml").write_text(_decay)
    assert my.read_sbml(tmp_path / "model.xml").hash == my.read_sbml(_decay).hash
    with pytest.raises(my.Error, match="there is no file"):
        my.read_sbml(tmp_path / "missing.xml")


def test_compiled_and_interpreted_models_agree():
    parts = [variable("x", 0), variable("n", 0), rate("x", "1"), event("x > 0.73", {"x": "0", "n": "n + 1"}),
             event("n >= 2", {"x": "0.5"})]
    model = my.read_sbml(sbml_models.document(parts))
    runs = [my.solve(model, start={"x": [0, 0.73]}, time=(0, 3), samples=31, interpreted=interpreted, device="cpu")
            for interpreted in (True, False)]
    assert not runs[0].failed.any() and not runs[1].failed.any()  # the second begins with an event
    runs = [{name: run[name] for name in model.states} for run in runs]
    np.testing.assert_allclose(runs[0]["x"], runs[1]["x"], rtol=1e-9, atol=1e-9)
    np.testing.assert_array_equal(runs[0]["n"], runs[1]["n"])
    assert runs[0]["n"][:, -1].min() >= 3


def test_events_that_happen_to_be_at_one_instant_are_executed_in_some_order():
    parts = [variable("x", 1), variable("y", 1), parameter("p", 1.5), event("time > 1", {"x": "y + 1"}),
             event("time > p", {"y": "x + 1"})]
    model = my.read_sbml(sbml_models.document(parts))
    run = my.solve(model, {"p": [1.5, 1.0, 0.5]}, time=(0, 2), interpreted=True)
    assert not run.failed.any()
    assert run["x"][[0, 2]].tolist() == [2, 3] and run["y"][[0, 2]].tolist() == [3, 2]
    assert (run["x"][1], run["y"][1]) in [(2, 3), (3, 2), (2, 2)]


def test_events_of_equal_priority_are_executed_in_a_random_order():
    parts = [variable("x", 1), variable("y", 1), event("time > 1", {"x": "y + 1"}, priority="3"),
             event("time > 1", {"y": "x + 1"}, priority="3", at_trigger=False)]
    model = my.read_sbml(sbml_models.document(parts))
    runs = [my.solve(model, time=(0, 2), size=4000, interpreted=True) for _ in range(2)]
    assert not runs[0].failed.any()
    second = runs[0]["y"] == 3  # of two, the other order gives y = 2
    assert set(runs[0]["y"].tolist()) == {2, 3} and runs[0]["x"].tolist() == [2 if s else 3 for s in second] or (
        set(runs[0]["x"].tolist()) == {2})
    assert abs(second.mean() - 0.5) < 5 * 0.5 / np.sqrt(4000)
    np.testing.assert_array_equal(runs[0]["y"], runs[1]["y"])  # from a stream of each instance


def test_every_order_of_three_events_comes_as_often():
    parts = [variable("order", 0), *(event("time > 1", {"order": f"10 * order + {i}"}, at_trigger=False)
                                     for i in (1, 2, 3))]
    run = my.solve(my.read_sbml(sbml_models.document(parts)), time=(0, 2), size=6000, interpreted=True)
    orders, counts = np.unique(run["order"], return_counts=True)
    assert orders.tolist() == [123, 132, 213, 231, 312, 321]
    assert np.abs(counts - 1000).max() < 5 * np.sqrt(1000 * 5 / 6)


def test_compiled_models_have_the_same_random_order():
    parts = [variable("order", 0), *(event("time > 1", {"order": f"10 * order + {i}"}, at_trigger=False)
                                     for i in (1, 2, 3)),
             variable("first", 0), *(event("time >= 0", {"first": f"10 * first + {i}"}, at_trigger=False, before=False)
                                     for i in (1, 2, 3))]
    model = my.read_sbml(sbml_models.document(parts))
    interpreted, compiled = (my.solve(model, time=(0, 2), size=200, interpreted=interpreted, device="cpu")
                             for interpreted in (True, False))
    for name in ("first", "order"):
        np.testing.assert_array_equal(interpreted[name], compiled[name])
        assert len(set(interpreted[name].tolist())) == 6


def test_events_of_a_model_with_short_times_are_not_at_one_instant():
    parts = [variable("x", 1), variable("y", 1), parameter("p", 1.5), event("time > 1e-11", {"x": "y + 1"}),
             event("time > p", {"y": "x + 1"})]
    run = my.solve(my.read_sbml(sbml_models.document(parts)), {"p": [1.5e-11, 1e-11, 0.5e-11]}, time=(0, 2e-11),
                   interpreted=True)
    assert not run.failed.any()
    assert run["x"][[0, 2]].tolist() == [2, 3] and run["y"][[0, 2]].tolist() == [3, 2]


def test_a_trigger_that_holds_right_after_the_start_happens_there():
    """x > 1 does not hold where x is 1, but right afterwards if x rises: no crossing shows it."""
    parts = [variable("x", 1), variable("y", 1), parameter("p", 1), rate("x", "p"), event("x > 1", {"y": "2 + time"})]
    run = my.solve(my.read_sbml(sbml_models.document(parts)), {"p": [1, 1, 1, -1, 0]},
                   start={"x": [0.5, 1.0, 1.5, 1.0, 1.0]}, time=(0, 2), interpreted=True)
    assert not run.failed.any()
    np.testing.assert_allclose(run["y"], [2.5, 2, 1, 1, 1])


def test_a_rate_with_a_pole_keeps_a_species_on_its_side():
    """As in BIOMD0000000111: its solution stays right before the pole, which a step with a large tolerance may
    pass, in any program. Here x' = c / x - 1, which comes to rest at c."""
    parts = [variable("x", 1), parameter("c", 1e-3), rate("x", "c / x - 1")]
    run = my.solve(my.read_sbml(sbml_models.document(parts)), time=(0, 2), samples=21, rtol=1e-8, atol=1e-12,
                   interpreted=True)
    t, x = run.t_sample[0], run["x"][0]
    before = t < 0.95
    np.testing.assert_allclose(1 - x[before] + 1e-3 * np.log((1 - 1e-3) / (x[before] - 1e-3)), t[before], rtol=1e-7)
    np.testing.assert_allclose(x[t > 1.05], 1e-3, rtol=1e-7)


def test_a_sample_at_the_time_of_an_event_is_from_before_it():
    run = my.solve(my.read_sbml(sbml_models.document([variable("x", 1), event("time >= 1", {"x": "2"})])), time=(0, 2),
                   samples=[0.5, 1.0, 1.5], interpreted=True)
    assert run["x"].tolist() == [[1, 1, 2]]


def test_a_value_that_the_file_leaves_out_has_to_be_given():
    text = sbml_models.document([variable("x", 1), parameter("k"), rate("x", "k")])
    with pytest.raises(my.Error, match="the value of 'k' is missing"):
        my.solve(my.read_sbml(text), time=(0, 1), interpreted=True)
    assert my.solve(my.read_sbml(text), {"k": 2}, time=(0, 1), interpreted=True)["x"] == pytest.approx(3)


def test_a_study_takes_the_values_of_the_file():
    model = my.read_sbml(_decay)
    result = my.study(model, {"k2": my.linspace(0.5, 1, 3)}, time=(0, 1), keep=["A"]).run()
    np.testing.assert_allclose(result["A_end"], 1.5 * np.exp([-0.5, -0.75, -1]), rtol=1e-5)
    with pytest.raises(my.Error, match="'k2' follows from what differs between the instances"):
        my.study(model, {"k": my.linspace(0.5, 1, 3)}, time=(0, 1), keep=["A"])


def test_a_value_that_follows_from_an_axis_by_a_comparison_is_refused_in_a_study():
    text = sbml_models.document([variable("x", 1), parameter("k", 1), parameter("high"), rate("x", "high"),
                                 initially("high", "piecewise(1, k > 2, 0)")])
    with pytest.raises(my.Error, match="'high' follows from what differs between the instances"):
        my.study(my.read_sbml(text), {"k": my.linspace(1, 3, 3)}, time=(0, 1), keep=["x"])


def test_outputs_at_samples_take_nothing_from_records():
    text = sbml_models.document([variable("x", 1), rate("x", "2"), variable("twice"), always("twice", "2 * x + time")])
    run = my.solve(my.read_sbml(text), time=(0, 1), samples=11, record=dict(states=["x"], time=True), interpreted=True)
    np.testing.assert_allclose(run["twice_sample"], 2 * run["x_sample"] + run.t_sample, rtol=1e-12)
    np.testing.assert_allclose(run["twice"], 2 * run["x"] + run["t"], rtol=1e-12)


def test_tangents_keep_the_outputs_of_a_model():
    run = my.solve(my.with_tangents(my.read_sbml(_decay)), time=(0, 1))
    np.testing.assert_allclose(run["total"], run["A"] + run["B"])


def _with_units(level3_units):
    """A model in millimoles, millilitres and minutes."""
    def unit(id, *factors):
        return sbml_models.element("unitDefinition", sbml_models.several("listOfUnits", [
            sbml_models.element("unit", kind=kind, exponent=exponent, scale=scale, multiplier=multiplier)
            for kind, exponent, scale, multiplier in factors]), id=id)

    definitions = sbml_models.several("listOfUnitDefinitions", [
        unit("mmol", ("mole", 1, -3, 1)), unit("ml", ("litre", 1, -3, 1)), unit("min", ("second", 1, 0, 60)),
        unit("per_min", ("second", -1, 0, 60))])
    text = sbml_models.document([
        compartment("c", 2), species("A", concentration=3), species("B", amount=1, only_amounts=True),
        sbml_models.Part("Parameters", sbml_models.element("parameter", id="k", value=0.5, constant=True,
                                                           units="per_min")),
        parameter("plain", 1), reaction("R", "A -> B", "c * k * A")], **level3_units)
    return text.replace("<listOfCompartments>", definitions + "<listOfCompartments>")


def test_units_of_the_file_are_in_the_labels_of_results():
    plt = pytest.importorskip("matplotlib.pyplot")
    text = _with_units(dict(substanceUnits="mmol", volumeUnits="ml", timeUnits="min", extentUnits="mmol"))
    model = my.read_sbml(text)
    assert model.time_unit == "min"
    assert model.units == {"c": "ml", "A": "mmol/ml", "A_amount": "mmol", "A_concentration": "mmol/ml", "B": "mmol",
                           "B_amount": "mmol", "B_concentration": "mmol/ml", "k": "1/min", "R": "mmol/min"}
    run = my.solve(model, {"k": [0.5, 1.0]}, time=(0, 1), samples=5, interpreted=True)
    axes = run.plot.time_series("A")
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("t (min)", "A (mmol/ml)")
    plt.close("all")
    table = run.to_xarray()
    assert table["A_sample"].attrs["units"] == "mmol/ml" and table["R_sample"].attrs["units"] == "mmol/min"
    assert table["t_sample"].attrs["units"] == "min" and table["k"].attrs["units"] == "1/min"
    assert "units" not in table["status"].attrs and "units" not in table["plain"].attrs
    study = my.study(model, {"k": [0.5, 1.0]}, time=(0, 1), interpreted=True).run().to_xarray()
    assert study["A_end"].attrs["units"] == "mmol/ml" and study["R_end"].attrs["units"] == "mmol/min"
    assert study["k"].attrs["units"] == "1/min" and "units" not in study["status"].attrs


_enzyme = [compartment("c", 2), species("S", concentration=3), species("E", concentration=0.5),
           species("C", concentration=0.25), species("P", concentration=0), parameter("on", 1.5), parameter("off", 0.5),
           parameter("cat", 0.7), reaction("bind", "S + E -> C", "c * (on * S * E - off * C)"),
           reaction("make", "C -> E + P", "c * cat * C")]


def test_species_that_follow_from_others_are_left_out_if_asked_for():
    whole, reduced = (my.read_sbml(sbml_models.document(_enzyme), reduce=reduce) for reduce in (False, True))
    assert whole.states == ["S", "E", "C", "P"] and len(reduced.states) == 2
    arguments = dict(start={"S": [3.0, 5.0]}, time=(0, 4), samples=9, interpreted=True, rtol=1e-10, atol=1e-12)
    runs = [my.solve(model, {"c": [2.0, 1.0], "cat": 0.6}, **arguments) for model in (whole, reduced)]
    for name in ("S", "E", "C", "P", "E_amount", "bind", "make"):
        np.testing.assert_allclose(runs[1][name], runs[0][name], rtol=1e-7, atol=1e-9)
    np.testing.assert_allclose(runs[1]["conserved_C"], [1.5, 0.75])  # of the enzyme, free and bound
    swept = my.solve(reduced, {"conserved_C": [1.5, 3.0]}, time=(0, 4), interpreted=True, rtol=1e-10)
    np.testing.assert_allclose(swept["E_amount"] + swept["C_amount"], [1.5, 3.0])


def test_sums_that_an_event_changes_are_not_conserved():
    parts = [*_enzyme, event("time > 1", {"E": "E + 1", "on": "2"})]
    parts[5] = variable("on", 1.5)
    whole, reduced = (my.read_sbml(sbml_models.document(parts), reduce=reduce) for reduce in (False, True))
    assert len(whole.states) == 5 and len(reduced.states) == 4
    runs = [my.solve(model, time=(0, 2), interpreted=True, rtol=1e-10, atol=1e-12) for model in (whole, reduced)]
    for name in ("S", "E", "C", "P"):
        np.testing.assert_allclose(runs[1][name], runs[0][name], rtol=1e-7)


def test_models_without_units_have_none():
    model = my.read_sbml(_decay)
    assert model.units == {} and model.time_unit == ""


def test_without_libsbml_the_message_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "libsbml", None)
    with pytest.raises(my.Error, match="pip install python-libsbml"):
        my.read_sbml(_decay)


def test_all_cases_have_names_of_their_own():
    names = [case.name for case in sbml_models.cases]
    assert len(names) == len(set(names)) >= 60


def test_a_text_in_antimony_is_a_model():
    pytest.importorskip("antimony", reason="the notation is read by the package antimony")
    model = my.read_antimony("R: S1 -> S2; k*S1; k = 0.5; S1 = 10; S2 = 0; total := S1 + S2")
    run = my.solve(model, {"k": [0.5, 1.0]}, time=(0, 1), interpreted=True, rtol=1e-10)
    np.testing.assert_allclose(run["S1"], 10 * np.exp([-0.5, -1.0]), rtol=1e-8)
    np.testing.assert_allclose(run["total"], 10, rtol=1e-8)
    with pytest.raises(my.Error, match="no Antimony"):
        my.read_antimony("S1 -> -> S2")


def test_external_models_are_found_beside_a_file_given_by_a_relative_path(tmp_path, monkeypatch):
    (tmp_path / "models").mkdir()
    inner = sbml_models.document([parameter("k", 0.5), variable("x", 1), rate("x", "-k * x")])
    (tmp_path / "models" / "inner.xml").write_text(inner)
    name = "http://www.sbml.org/sbml/level3/version1/comp/version1"
    (tmp_path / "models" / "outer.xml").write_text(
        f'''<?xml version="1.0" encoding="UTF-8"?>
<sbml xmlns="http://www.sbml.org/sbml/level3/version2/core" xmlns:comp="{name}" level="3" version="2"
      comp:required="true">
  <model id="outer"><comp:listOfSubmodels><comp:submodel comp:id="A" comp:modelRef="M"/></comp:listOfSubmodels></model>
  <comp:listOfExternalModelDefinitions>
    <comp:externalModelDefinition comp:id="M" comp:source="inner.xml"/>
  </comp:listOfExternalModelDefinitions>
</sbml>''')
    monkeypatch.chdir(tmp_path)
    run = my.solve(my.read_sbml("models/outer.xml"), time=(0, 2), rtol=1e-9, interpreted=True)
    assert run["A__x"][0] == pytest.approx(np.exp(-1), rel=1e-7)


_pulses = {
    "constants": ("piecewise(1, time > on && time < on + 0.001, 0)", 0.001),
    "absolute value": ("piecewise(1, abs(time - on) < 0.001, 0)", 0.002),
    "remainder": ("piecewise(1, rem(time + 1, on) < 0.001, 0)", 0.004),
    "whole part": ("piecewise(1, time / on - floor(time / on) < 0.001, 0)", 0.001 * 10.2),
    "sine": ("piecewise(1, sin(2 * pi * time / on) > cos(0.001 * pi), 0)", 0.001 * 2.55 * 4),
    "nested": ("piecewise(piecewise(1, time < on + 0.001, 3), time > on && time < on + 0.002, 0)", 0.004),
}


@pytest.mark.parametrize("backward", [False, True], ids=["forward", "backward"])
@pytest.mark.parametrize("pulse", _pulses)
def test_a_pulse_in_time_is_not_passed_over(pulse, backward):
    formula, area = _pulses[pulse]
    model = my.read_sbml(sbml_models.document([variable("x", 0), parameter("on", 2.55), rate("x", formula)]))
    run = my.solve(model, time=(9.99, -0.01) if backward else (-0.01, 9.99), interpreted=True)
    if pulse in ("remainder", "whole part", "sine"):
        run = my.solve(model, time=(10.2, 0) if backward else (0, 10.2), interpreted=True)
    np.testing.assert_allclose(run["x"], -area if backward else area, rtol=1e-7)
    assert run.report.notes == []


def test_a_pulse_in_time_has_derivatives_by_its_ends():
    model = my.read_sbml(sbml_models.document([variable("x", 0), parameter("on", 3), parameter("off", 3.5), rate(
        "x", "piecewise(2, time > on && time < off, 0) - 0.3 * x")]))
    run = my.solve(model, time=(0, 10), free=["on", "off"], rtol=1e-10, device="cpu")
    np.testing.assert_allclose(run.sensitivity["x", "on"], -2 * np.exp(-0.3 * 7), rtol=1e-7)
    np.testing.assert_allclose(run.sensitivity["x", "off"], 2 * np.exp(-0.3 * 6.5), rtol=1e-7)


def test_a_window_that_an_event_opens_later_is_not_passed_over():
    model = my.read_sbml(sbml_models.document([
        variable("x", 0), variable("last", -100), parameter("at", 3), event("time > at", {"last": "time"}),
        rate("x", "piecewise(1, time > last + 2 && time < last + 2.001, 0)")]))
    run = my.solve(model, {"at": [-1, 3, 4.5, 9]}, time=(0, 10), interpreted=True)
    np.testing.assert_allclose(run["x"], [0, 0.001, 0.001, 0], rtol=1e-7)


@pytest.mark.parametrize("trigger, times", [
    ("pulse > 0.5", [3]), ("pulse < 0.5", [3.001]), ("clock * pulse > 0.5", [3]), ("rem(time, 2) > 1.999", [
        1.999, 3.999, 5.999, 7.999]), ("sin(pi * time / 2) > 0.999999", [4 * k + 2 * np.arcsin(0.999999) / np.pi
                                                                        for k in range(3)]),
    ("floor(time / 3) > count", [3, 6, 9]), ("floor(time / 2) > 2", [6]), ("rem(floor(time), 4) == 3", [3, 7]),
    ("floor(time) != 3", [4])])
def test_triggers_that_time_alone_decides_are_not_missed(trigger, times):
    model = my.read_sbml(sbml_models.document([
        variable("pulse"), always("pulse", "piecewise(1, time > 3 && time < 3.001, 0)"), variable("clock", 0),
        rate("clock", "1"), variable("count", 0), variable("sum", 0),
        event(trigger, {"count": "count + 1", "sum": "sum + time"})]))
    run = my.solve(model, time=(0, 9.9), interpreted=True)
    assert run["count"] == len(times)
    np.testing.assert_allclose(run["sum"], sum(times), rtol=1e-9)


def test_a_window_of_a_state_that_measures_time_is_not_passed_over():
    model = my.read_sbml(sbml_models.document([
        variable("clock", 1), variable("speed", 0.5), variable("x", 0), variable("n", 0), rate("clock", "speed"),
        rate("x", "piecewise(1, clock > 3 && clock < 3.001, 0)"), event("sin(3 * clock) > 0.5", {"n": "n + 1"}),
        event("time > 7", {"clock": "clock - 2", "speed": "0.25"})]))
    run = my.solve(model, time=(0, 20), interpreted=True)
    np.testing.assert_allclose(run["x"], 0.002 + 0.004, rtol=1e-7)
    assert run["n"] == 3  # from 1 to 4.5, and from 2.5 to 5.75: at 2.269 and 4.363, and at 4.363


@pytest.mark.parametrize("formula, given, end, area", [
    ("piecewise(1, g * time < 3, 0)", 0, 10, 10), ("piecewise(1, sin(time) < 2, 0)", 0, 10, 10),
    ("piecewise(1, (time - 3) * g >= 0, 0)", 0, 10, 10), ("piecewise(1, time > 5 && time < g, 0)", np.inf, 10, 5),
    ("piecewise(1, time < 5, 0)", 0, 1e15, 5), ("piecewise(1, time > 5 && time < 5.05, 0)", 0, 1e12, 0.05)])
def test_a_rate_is_right_after_its_last_jump_and_in_long_domains(formula, given, end, area):
    model = my.read_sbml(sbml_models.document([variable("x", 0), parameter("g", given), rate("x", formula)]))
    run = my.solve(model, time=(0, end), interpreted=True)
    np.testing.assert_allclose(run["x"], area, rtol=1e-7)


def test_a_dosing_interval_of_zero_means_no_repeat():
    model = my.read_sbml(sbml_models.document([
        variable("x", 0), parameter("tau", 0), rate("x", "piecewise(1, phase < 1, 0)"), variable("phase"),
        always("phase", "piecewise(rem(time, tau), tau > 0, time)")]))
    run = my.solve(model, {"tau": [0, 4, 2.5]}, time=(0, 9), interpreted=True)
    np.testing.assert_allclose(run["x"], [1, 3, 4], rtol=1e-7)


@pytest.mark.parametrize("trigger, at", [
    ("piecewise(1, time < 5, 0) * (time - 4.5) > 0.1", 4.6), ("piecewise(1, rem(time, 10) < 5, 0) * x > 4.95", 4.95),
    ("piecewise(10, time < 5, 0) + x > 14.9", 4.9),
    ("piecewise(1, time >= 5 && time < 6, 0) * (x - 5.9) > 0.01", 5.91)])
def test_a_trigger_that_jumps_in_time_is_not_missed_before_the_jump(trigger, at):
    model = my.read_sbml(sbml_models.document([
        variable("x", 0), rate("x", "1 + 1e-9 * x"), variable("n", 0), variable("when", 0),
        event(trigger, {"n": "n + 1", "when": "time"})]))
    run = my.solve(model, time=(0, 9), interpreted=True)
    assert run["n"] == 1
    np.testing.assert_allclose(run["when"], at, rtol=1e-7)


def test_a_constant_that_is_infinite_in_the_file_can_be_swept():
    model = my.read_sbml(sbml_models.document([variable("x", 0), parameter("off", np.inf), rate(
        "x", "piecewise(1, time < off, 0)")]), parameters="off")
    np.testing.assert_allclose(my.solve(model, {"off": [7, 2]}, time=(0, 10), interpreted=True)["x"], [7, 2], rtol=1e-7)


def test_a_comparison_begins_to_hold_where_its_opposite_ceases_to():
    model = my.read_sbml(sbml_models.document([
        variable("x", 0), rate("x", "cos(time)"), variable("n", 0), variable("m", 0), variable("waited", 0),
        event("xor(x > 0.3, x > -0.5)", {"n": "n + 1"}),
        event("(0.3 < x && time <= 2) || (x <= 0.3 && time > 2)", {"m": "m + 1"}),
        event("xor(x > 0.3, x > -0.5)", {"waited": "waited + 1"}, delay="0.7", persistent=False)]))
    run = my.solve(model, time=(0, 9.9), interpreted=True)
    assert run.status[0] == "success"
    # sin(t) rises through 0.3 at 0.30, and comes into (-0.5, 0.3] at 2.84, 5.76 and 9.12, each time for 0.83
    assert [run["n"], run["m"], run["waited"]] == [3, 3, 3]


def test_a_trigger_at_its_threshold_is_left_alone_by_events_that_do_not_happen():
    model = my.read_sbml(sbml_models.document([
        variable("c", 1), rate("c", "0.5"), variable("k", 0), event("c > 1", {"k": "2"}),
        event("time > 4.5", {"c": "0.3"})]))
    run = my.solve(model, time=(0, 10), interpreted=True)
    assert run.status[0] == "success" and run["k"] == 2


def test_events_that_make_each_other_happen_without_an_end_end_the_instance():
    model = my.read_sbml(sbml_models.document([
        variable("c", 0), rate("c", "1"), variable("on", 0), event("c > 2 && on < 0.5", {"on": "1"}),
        event("on > 0.5", {"on": "0"})]))
    run = my.solve(model, time=(0, 10), interpreted=True)
    assert run.status[0] == "event_accumulation" and run.t_last[0] == pytest.approx(2)


def test_more_executions_of_an_event_than_there_is_room_for_end_the_instance():
    model = my.read_sbml(sbml_models.document([
        variable("n", 0), event("sin(10 * time) > 0", {"n": "n + 1"}, delay="20", at_trigger=False)]))
    run = my.solve(model, time=(0, 30), interpreted=True)
    assert run.status[0] == "queue_overflow"


def test_events_are_triggers_of_the_library():
    model = my.read_sbml(sbml_models.document([
        variable("x", 0), rate("x", "1"), variable("n", 0), event("x > 0.5", {"n": "n + x"}, id="E")]))
    text = model.cpp()
    assert "return positive[E_side_1]" not in text and "return !positive[E_side_1];" in text
    assert "queue" not in text and "initialise" not in text  # no event has to wait for another


def test_jumps_at_times_without_a_formula_are_noted():
    model = my.read_sbml(sbml_models.document([variable("x", 0), rate("x", "piecewise(1, exp(-time) > 0.1, 0)")]))
    note, = my.solve(model, time=(0, 10), interpreted=True).report.notes
    assert "`exp(-time) > 0.1`" in note and "maximum_step=" in note
    assert my.solve(model, time=(0, 10), interpreted=True, maximum_step=0.1).report.notes == []


@pytest.mark.parametrize("rate_of_x, expected", [
    ("piecewise(1, floor(time ^ 2) > 3, 0)", 8), ("piecewise(1, piecewise(2, exp(-time) < exp(-2), 0) > 1, 0)", 8),
    ("floor(sqrt(time))", 16), ("piecewise(floor(exp(time - 2)), time < 2.5, 0)", 0.5)])
def test_jumps_at_times_without_a_formula_are_where_they_are(rate_of_x, expected):
    model = my.read_sbml(sbml_models.document([variable("x", 0), rate("x", rate_of_x)]))
    run = my.solve(model, time=(0, 10), interpreted=True, maximum_step=0.1, rtol=1e-9)
    np.testing.assert_allclose(run["x"], expected, rtol=1e-6)


def test_a_constant_may_be_infinite():
    model = my.read_sbml(sbml_models.document([parameter("most", "INF"), variable("x", 0), rate("x", "min(most, 2)")]))
    np.testing.assert_allclose(my.solve(model, time=(0, 1), interpreted=True)["x"], 2)


def test_what_parameters_names_is_a_constant():
    with pytest.raises(my.Error, match="'A' is no constant of the file that parameters= can name: there are c, k, k2"):
        my.read_sbml(_decay, parameters="k A")


def test_messages_have_no_names_that_no_user_knows():
    model = my.read_sbml(sbml_models.document([
        variable("x", 0), parameter("k", 1), rate("x", "piecewise(k * k, time > 1, 0)"),
        event("x > 0.5", {"x": "0"}, delay="1")]))
    with pytest.raises(my.Error, match="there are x, k$"):
        my.solve(model, {"what": 1}, time=(0, 2))
    run = my.solve(model, time=(0, 2), interpreted=True)
    names = {"x_end", "x_start", "k", "t_last", "t_begin", "t_end", "status"}
    assert set(run) == names
    with pytest.raises(KeyError, match="there are x_end, "):
        run["what"]


def test_a_file_without_an_encoding_is_read_and_checked():
    text = _decay.replace(' encoding="UTF-8"', "")
    assert text != _decay and my.read_sbml(text).hash == my.read_sbml(_decay).hash
    with pytest.raises(my.Error, match="no valid SBML"):
        my.read_sbml(text.replace('variable="total"', 'variable="what"'))


def test_ids_that_differ_in_underscores_are_not_mixed_up():
    model = my.read_sbml(sbml_models.document([
        parameter("k__", 1), parameter("k", 2), parameter("_k", 3), variable("x", 0), variable("next_jump", 4),
        rate("x", "piecewise(k + 10 * k__ + 100 * _k, time > 1, 0)"), rate("next_jump", "1")]))
    run = my.solve(model, {"k__": [1, 5]}, time=(0, 2), interpreted=True)
    for name, values in (("k__", [1, 5]), ("k", [2, 2]), ("_k", [3, 3]), ("x", [312, 352]), ("next_jump", [6, 6])):
        np.testing.assert_allclose(run[name], values, rtol=1e-9, err_msg=name)


def switched(given, *parts):
    """dA/dt = E - k A, A = 1 at the start, with an input E."""
    return my.read_sbml(sbml_models.document([
        compartment("c"), species("A", concentration=1.0), parameter("k", 0.5), sbml_models.variable("E"), *parts,
        always("E", given), reaction("loss", "A ->", "k * A * c"), reaction("gain", "-> A", "E * c")]))


def of_steps(steps, t, k=0.5):
    """A at times, for an input that is the sum of steps (height, time)."""
    after = [np.maximum(t - at, 0) for _, at in steps]
    return np.exp(-k * t) + sum(height / k * (1 - np.exp(-k * s)) for (height, _), s in zip(steps, after))


@pytest.mark.parametrize("call", [{"interpreted": True}, {}, {"free": ["on", "off"]}], ids=str)
def test_a_pulse_is_not_stepped_over(call):
    model = switched("piecewise(u, (time > on) && (time <= off), 0)", parameter("u", 1000), parameter("on", 10),
                     parameter("off", 10.001))
    run = my.solve(model, time=(0, 20), samples=21, rtol=1e-9, atol=1e-11, **call)
    t = np.linspace(0, 20, 21)
    np.testing.assert_allclose(run["A"][0], of_steps([(1000, 10), (-1000, 10.001)], t), rtol=1e-7)
    np.testing.assert_array_equal(run["E"][0], 0)  # at the samples, none of which is in the pulse
    assert run.accepted_steps[0] < 400
    assert not [name for name in run.accessories if name.startswith("switch")]
    if "free" in call:
        ends = np.array([10, 10.001])
        np.testing.assert_allclose(run.sensitivity["A"][0, -1], [-1000, 1000] * np.exp(-0.5 * (20 - ends)), rtol=1e-7)


def test_switches_at_many_times_act_in_every_phase_and_backwards():
    text = "0"
    for i in range(20):
        text = f"piecewise({i % 3 + 1}, (time >= {i}) && (10 * time < {10 * i + 1}), {text})"
    model = switched(text)
    steps = [(sign * (i % 3 + 1), i + late) for i in range(20) for sign, late in ((1, 0), (-1, 0.1))]
    call = {"rtol": 1e-10, "atol": 1e-12, "interpreted": True}
    expected = of_steps(steps, np.array([1.0, 2, 3, 20]))
    run = my.solve(model, time=(0, 20), phases=3, phase_length=1, record=["A"], **call)  # which end at switches
    np.testing.assert_allclose(run["A"][0], expected[:3], rtol=1e-8)
    twice = my.solve(model, time=(0, 20), phases=2, record=["A"], **call)  # the second starts at 0 again
    np.testing.assert_allclose(twice["A"][0], [expected[3], expected[3] + np.exp(-10) * (expected[3] - 1)],
                               rtol=1e-8)
    back = my.solve(model, time=(3, 1), start={"A": expected[2]}, **call)
    np.testing.assert_allclose(back["A"], expected[0], rtol=1e-7)
    single = my.solve(model, time=(0.1, 3), start={"A": of_steps(steps, 0.1)}, precision="float", rtol=1e-5, atol=1e-6)
    np.testing.assert_allclose(single["A"], expected[2], rtol=1e-4)


def test_switch_times_follow_from_parameters_of_each_instance():
    model = switched("piecewise(2, 3 - 2 * time <= p / 4, 0) + piecewise(1, not(time > p), 0)", parameter("p", 1))
    p = np.array([1.0, 2.0, 30.0, -1.0])
    run = my.solve(model, {"p": p}, time=(0, 4), rtol=1e-9, atol=1e-11, interpreted=True)
    expected = [of_steps([(2, max(1.5 - at / 8, 0)), (at > 0, 0), (-(at > 0), at)], 4.0) for at in p.tolist()]
    np.testing.assert_allclose(run["A"], expected, rtol=1e-7)


def test_functions_that_call_twice_deep_sums_and_long_chains_of_rules_are_read():
    pytest.importorskip("libsbml")
    math = '<math xmlns="http://www.w3.org/1998/Math/MathML">{}</math>'
    half = "<apply><times/><cn>0.5</cn>{}</apply>"
    functions = "".join(
        f'<functionDefinition id="f{i}">' + math.format("<lambda><bvar><ci>x</ci></bvar>" + half.format(
            "<ci>x</ci>" if i == 0 else f"<apply><plus/>{f'<apply><ci>f{i - 1}</ci><ci>x</ci></apply>' * 2}</apply>")
            + "</lambda>") + "</functionDefinition>" for i in range(40))
    chain = "".join(f'<assignmentRule variable="a{i}">' + math.format(f"<ci>{f'a{i + 1}' if i < 199 else 'y'}</ci>") +
                    "</assignmentRule>" for i in range(200))
    deep = "<apply><ci>f39</ci><ci>a0</ci></apply>"
    for _ in range(400):
        deep = f"<apply><plus/>{deep}<cn>0.001</cn></apply>"
    names = ["y", *(f"a{i}" for i in range(200))]
    model = my.read_sbml(
        '<sbml xmlns="http://www.sbml.org/sbml/level3/version1/core" level="3" version="1"><model id="m">'
        f"<listOfFunctionDefinitions>{functions}</listOfFunctionDefinitions><listOfParameters>" +
        "".join(f'<parameter id="{n}" value="1" constant="false"/>' for n in names) +
        f'</listOfParameters><listOfRules>{chain}<rateRule variable="y">{math.format(deep)}</rateRule></listOfRules>'
        "</model></sbml>")
    run = my.solve(model, {}, time=(0, 1), interpreted=True, rtol=1e-10, atol=1e-12)
    np.testing.assert_allclose(run["y"], np.exp(0.5) + 0.8 * (np.exp(0.5) - 1), rtol=1e-8)  # y' = y / 2 + 0.4


def test_triggers_by_functions_that_call_twice_are_read_in_no_time():
    pytest.importorskip("libsbml")
    math = '<math xmlns="http://www.w3.org/1998/Math/MathML">{}</math>'
    argument = "<bvar><ci>{}</ci></bvar>"
    # c0 = x > 1/2, and then c = (c or t > 9) and (c or not (t < 19)), which is x > 1/2 until t = 19
    call = "<apply><ci>c{}</ci><ci>x</ci><ci>t</ci></apply>"
    functions = ["<apply><gt/><ci>x</ci><cn>0.5</cn></apply>"] + [
        f"<apply><and/><apply><or/>{call.format(i)}<apply><gt/><ci>t</ci><cn>9</cn></apply></apply><apply><or/>"
        f"{call.format(i)}<apply><not/><apply><lt/><ci>t</ci><cn>19</cn></apply></apply></apply></apply>"
        for i in range(40)]
    written = "".join(
        f'<functionDefinition id="c{i}">' + math.format(
            f"<lambda>{argument.format('x')}{argument.format('t')}{body}</lambda>") + "</functionDefinition>"
        for i, body in enumerate(functions))
    time = '<csymbol encoding="text" definitionURL="http://www.sbml.org/sbml/symbols/time">t</csymbol>'
    trigger = f"<apply><not/><apply><not/><apply><ci>c40</ci><ci>y</ci>{time}</apply></apply></apply>"
    model = my.read_sbml(
        '<sbml xmlns="http://www.sbml.org/sbml/level3/version1/core" level="3" version="1"><model id="m">'
        f'<listOfFunctionDefinitions>{written}</listOfFunctionDefinitions><listOfParameters>'
        '<parameter id="y" value="0" constant="false"/></listOfParameters><listOfRules>'
        f'<rateRule variable="y">{math.format("<cn>1</cn>")}</rateRule></listOfRules><listOfEvents>'
        '<event id="e" useValuesFromTriggerTime="true"><trigger initialValue="true" persistent="true">'
        f'{math.format(trigger)}</trigger><listOfEventAssignments><eventAssignment variable="y">'
        f'{math.format("<cn>-1</cn>")}</eventAssignment></listOfEventAssignments></event></listOfEvents>'
        '</model></sbml>')
    run = my.solve(model, {}, time=(0, 3), interpreted=True)
    np.testing.assert_allclose(run["y"], 0, atol=1e-9)  # -1 at 1/2 and at 2


def test_files_of_many_reactions_are_read_in_time_that_grows_as_they_do():
    def seconds(count):
        parts = [compartment("c"), parameter("k", 1.0)]
        for i in range(count):
            parts.append(species(f"s{i}", concentration=1.0))
            parts.append(reaction(f"r{i}", f"s{i} -> s{(i + 1) % count}", f"k * s{i}"))
        text, taken = sbml_models.document(parts), []
        for _ in range(2):
            begin = time.process_time()
            my.read_sbml(text)
            taken.append(time.process_time() - begin)
        return min(taken)

    seconds(50)
    assert seconds(1200) < 25 * seconds(120)  # 12 to 14, and 49 where each species looked at all reactions


def test_a_compartment_without_a_size_has_the_size_one():
    parts = [compartment("c", size=None), species("A", concentration=3), species("B", amount=2),
             reaction("R", "A -> B", "A * c")]
    run = my.solve(my.read_sbml(sbml_models.document(parts)), time=(0, 1), rtol=1e-9, interpreted=True)
    assert run["A_amount"] == pytest.approx(3 * np.exp(-1)) and run["B"] == pytest.approx(5 - 3 * np.exp(-1))


_layout = "http://www.sbml.org/sbml/level3/version1/layout/version1"


def test_a_document_of_level_2_may_declare_the_layout_of_level_3():
    text = f"""<sbml xmlns="http://www.sbml.org/sbml/level2/version4" xmlns:layout="{_layout}" layout:required="false"
        level="2" version="4"><model id="m"><listOfParameters><parameter id="x" value="3" constant="false"/>
        </listOfParameters><listOfRules><rateRule variable="x"><math xmlns="http://www.w3.org/1998/Math/MathML">
        <ci>x</ci></math></rateRule></listOfRules></model></sbml>"""
    assert my.read_sbml(text).start() == {"x": 3}


def test_errors_in_how_a_model_is_drawn_do_not_matter():
    text = f"""<sbml xmlns="http://www.sbml.org/sbml/level3/version1/core" xmlns:layout="{_layout}"
        xmlns:render="http://www.sbml.org/sbml/level3/version1/render/version1" layout:required="false"
        render:required="false" level="3" version="1"><model id="m">
        <layout:listOfLayouts><layout:layout layout:id="l"><layout:dimensions layout:width="1" layout:height="1"/>
        </layout:layout><render:listOfGlobalRenderInformation><render:globalRenderInformation render:id="g"/>
        </render:listOfGlobalRenderInformation></layout:listOfLayouts>
        <listOfParameters><parameter id="x" value="3" constant="false"/></listOfParameters>
        <listOfRules><rateRule variable="x"><math xmlns="http://www.w3.org/1998/Math/MathML"><ci>x</ci></math>
        </rateRule></listOfRules></model></sbml>"""
    assert my.read_sbml(text).start() == {"x": 3}


def test_the_script_for_collections_tells_what_became_of_a_model(tmp_path, monkeypatch):
    pytest.importorskip("roadrunner")
    monkeypatch.syspath_prepend(str(_script.parent))
    import biomodels
    options = argparse.Namespace(end=10.0, samples=11, rtol=1e-8, atol=1e-12, methods="rodas_5p", time_limit=20.0,
                                 keep=None)

    def outcome(*parts):
        (tmp_path / "model.xml").write_text(sbml_models.document([*parts]))
        return biomodels.outcome_of(tmp_path / "model.xml", options)

    cell, decay = sbml_models.compartment("c", 1.0), reaction("loss", "S ->", "k * S")
    assert outcome(cell, species("S", concentration=2.0), parameter("k", 0.3), decay) == ("right", "")
    grows = reaction("growth", "-> S", "k")
    what, why = outcome(cell, species("S"), parameter("k", 0.3), grows)
    assert what == "right" and why.startswith("with 0 for 'S'")
    assert outcome(cell, species("S", concentration=2.0), parameter("k"), decay)[0] == "neither"
    blows_up = reaction("growth", "-> S", "k * S * S", modifiers="S")
    assert outcome(cell, species("S", concentration=2.0), parameter("k", 0.3), blows_up)[0] == "neither"
