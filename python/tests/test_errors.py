# SPDX-License-Identifier: MIT
"""What bad calls of `solve` get."""

import concurrent.futures

import numpy as np
import pytest

import myriad_ode as my
from myriad_ode import _core
from myriad_ode.base import core_words

CALL = dict(sweep={"w": [1.0, 2.0]}, start={"x": 1, "v": 0}, time=(0, 1))


@pytest.mark.parametrize("change, message", [
    (dict(start={"x": 1}), "initial value of 'v' is missing: give it in start="),
    (dict(sweep={}), "value of 'w' is missing: give it in the sweep"),
    (dict(sweep={"W": 1}), "'W' is no component of the model that the sweep can set: did you mean 'w'"),
    (dict(start={"x": 1, "v": 0, "w": 1}), "'w' is no component of the model that start= can set"),
    (dict(sweep={"w": [1.0, 2.0], "x": 1}), "'x' is given in the sweep and in start="),
    (dict(start={"x": [1, 2, 3], "v": 0}), "'w' has 2 values and 'x' has 3"),
    (dict(sweep={"w": [1.0, np.nan]}), r"parameter 0 \(w\) is not finite in 1 of 2 instances.*give invalid=\"mark\""),
    (dict(sweep={"w": [1j, 2]}), "'w' is complex"),
    (dict(sweep={"w": [[1.0, 2.0]]}), "'w' has 2 dimensions"),
    (dict(sweep={"w": "fast"}), "'w' is 'fast': give a number"),
    (dict(sweep=3), "the sweep is a int"),
    (dict(sweep={3: 3}), "3 is no component"),
    (dict(time=3), "time is 3: give begin and end"),
    (dict(rtol=0, atol=0), "rtol and atol are 0: give the error"),
    (dict(rtol=-1), "rtol is -1 .must be at least 0"),
    (dict(method="RK45"), "no method 'RK45': use \"dormand_prince_5\", or another of"),
    (dict(method="BDF"), "no method 'BDF': use \"rodas_5p\""),
    (dict(t_eval=[0, 1]), "solve has no option 't_eval' .*: give samples=times"),
    (dict(y0=[1, 0]), "solve has no option 'y0' .*: give start="),
    (dict(metod=3), "did you mean 'method'"),
    (dict(time=None), "time is missing: give begin and end"),
    (dict(atol=[1e-9, 1e-9, 1e-9]), "atol has 3 values, but the model has 2 state components"),
    (dict(rtol={"y": 1e-9}), "'y' is no state of the model"),
    (dict(phases=0), "phases is 0"),
    (dict(phases=1.5), "phases is 1.5: give a whole number"),
    (dict(record=["z"]), "'z' is no component of the model that record= can name"),
    (dict(record=dict(states=["x"], phase=1)), "'phase' is no choice of record="),
    (dict(record=dict(states=["x"], from_phase=1)), "nothing would be recorded"),
    (dict(method="euler"), "there is no method 'euler': choose one of runge_kutta_4"),
    (dict(method="runge_kutta_4"), "runge_kutta_4 takes fixed steps: give step="),
    (dict(method="runge_kutta_4", step=0.1, control="pi_control"), "has no step-size control to choose"),
    (dict(control="pi"), "there is no step-size control 'pi'"),
    (dict(events={"hit": {}}), "'hit' is no event of the model: there is none"),
    (dict(samples=dict(every=2)), "need capacity="),
    (dict(samples=[0.5, 2.0]), "sample"),
    (dict(device="cuda:999"), "is not available: .*use .cpu.|does not exist"),
    (dict(device="tpu"), 'device "tpu" is unknown'),
    (dict(invalid="ignore"), "give \"refuse\" or \"mark\""),
    (dict(precision="half"), "give \"double\" or \"float\""),
    (dict(size=3), "'w' has 2 values and 'size' has 3"),
    (dict(size=2**63), "size is 9223372036854775808: give a number up to"),
    (dict(phases=10**30), r"phases is 10+: give a number in \[1, 1000000000\]"),
    (dict(max_steps=2**63), r"max_steps is 9223372036854775808: give a number in 0 or \[1, 2000000000\]"),
    (dict(max_steps=2**40), r"max_steps is 1099511627776 .must be from 1 to 2000000000"),
    (dict(phases="two"), "phases is 'two': give a whole number"),
    (dict(step="short"), "step is 'short': give a number"),
    (dict(start=[1, 0]), r"start is \[1, 0\]: give a dict by name"),
    (dict(events=[1]), r"events is \[1\]: give a dict by name"),
    (dict(record=3), "record=3 names no components"),
    (dict(control=3), "there is no step-size control 3"),
    (dict(tolerance_scale=[1, 2, 3]), "'tolerance_scale' has 3 values for 2 instances"),
    (dict(time=(0, np.nan)), "t_end is NaN in all 2 instances.*; give it in time="),
    (dict(samples=0), "samples= asks for no samples"),
    (dict(samples=[]), "samples= asks for no samples"),
    (dict(samples=10**10), "samples capacity is 10000000000 .must be from 1 to 2000000000"),
    (dict(samples=2**63), r"samples evenly is 9223372036854775808: give a number in 0 or \[2, 2000000000\]"),
    (dict(device="cpu:9999"), 'device "cpu:9999" has 9999 threads .must be from 1 to 4096'),
])
def test_message(oscillator, change, message):
    with pytest.raises(my.Error, match=message):
        my.solve(oscillator, **{**CALL, **change})


def said_in_cpp(*parts):
    """A statement of the core: (kind, key, number), or a text that is the same everywhere. C++ says "@"."""
    return [(core_words._text, p, "", -1) if isinstance(p, str) else (p[0], "@", *p[1:], *[-1] * (3 - len(p)))
            for p in parts]


@pytest.mark.parametrize("parts, message", [
    ([(core_words._option, "relative_tolerance"), " and ", (core_words._option, "absolute_tolerance"), " are 0"],
     "rtol and atol are 0"),
    ([(core_words._option, "options.relative_tolerance"), ": 1 here"], "options.rtol: 1 here"),
    ([(core_words._option, "samples.times"), " is 1"], "samples times is 1"),
    ([(core_words._option, "ensemble"), " has 0 instances"], "the sweep has 0 instances"),
    (["of ", (core_words._event, "", 1)], "of event 'bottom'"),
    ([(core_words._component, "state", 0), ": ", (core_words._cure, "set_value")], "@: give it in start="),
    ([(core_words._component, "parameter", 0), ": ", (core_words._cure, "set_value")], "@: give it in the sweep"),
    ([(core_words._cure, "fewer_instances", 30)], "integrate the sweep in parts of at most 30 instances"),
    ([(core_words._cure, "fewer_instances")], "integrate the sweep in smaller parts"),
    ([(core_words._cure, "use_doubles")], 'give precision="double"'),
])
def test_what_the_core_says_is_told_by_its_keys_and_not_by_its_words(parts, message):
    assert core_words.in_words(said_in_cpp(*parts), ["top", "bottom"]) == message


def test_every_cure_of_the_core_has_words_in_python():
    assert set(core_words._cures) == set(_core.cures())
    for name in core_words._cures:
        words = core_words.in_words([(core_words._cure, "@", name, -1)])
        assert not any(piece in words for piece in ("@", "::", "{", "ensemble")), words


def test_notes_of_reports_name_pythons_options(oscillator):
    run = my.solve(oscillator, **CALL, rtol=1e-18)
    assert any(note.startswith("rtol 1e-18 is below what the precision can reach") for note in run.report.notes)
    assert str(run.report).count("note: rtol 1e-18 is below") == 1
    assert "relative_tolerance" not in str(run.report)


def test_notes_of_studies_name_pythons_options_also_where_an_executor_runs_them(oscillator, tmp_path):
    study = my.study(oscillator, {"w": [1.0, 2.0]}, start={"x": 1, "v": 0}, time=(0, 1), keep=["x"], rtol=1e-18)
    with concurrent.futures.ThreadPoolExecutor(1) as executor:
        for result in (study.run(), study.run(executor=executor)):
            assert [note.partition(" 1e-18")[0] for note in result.notes] == ["rtol"]


def test_equations_are_no_model():
    with pytest.raises(my.Error, match=r"the model is a dict: make it by my.model\(...\)"):
        my.solve({"x": "v", "v": "-x"}, start={"x": 1, "v": 0}, time=(0, 1))


def test_an_array_in_place_of_a_name_is_told_by_its_shape(ball):
    run = my.solve(ball, {"loss": 0.5, "g": 1.0}, start={"height": np.linspace(1, 2, 400), "speed": 0}, time=(0, 0.1))
    with pytest.raises(my.Error, match=r"^an array of shape \(400,\) is no component of a model"):
        run[np.arange(400.0)]


def test_shared_values_are_single_numbers(ball):
    cure = r"give one number, or make it a parameter where the model is made, as by my.parameter\(\"g\"\) instead of"
    options = dict(start={"height": 1, "speed": 0}, time=(0, 1))
    for call, sweep in [(call, sweep) for call in (my.solve, my.study) for sweep in (
            {"loss": 0.5, "g": [1.0, 2.0]}, my.grid(g=[1.0, 2.0], loss=[0.5, 0.6, 0.7]))]:
        with pytest.raises(my.Error, match=f"'g' is shared by all instances and has 2 values: {cure}"):
            call(ball, sweep, **options)
    with pytest.raises(my.Error, match=f"'g' is shared by all instances and is random: {cure}"):
        my.study(ball, {"loss": 0.5, "g": my.uniform(1, 2)}, draws=3, **options)
    with pytest.raises(my.Error, match="'transient_phases' is shared .* and has 2 values: .* and make a call for each"):
        my.study(my.with_tangents(ball), my.grid(loss=0.5, g=1.0, transient_phases=[1, 2]), **options)


def test_an_unknown_name_of_a_result_is_an_error_that_reads_as_it_is_written(ball):
    run = my.solve(ball, {"loss": 0.5, "g": 1.0}, start={"height": 1, "speed": 0}, time=(0, 0.1))
    for kind in (my.Error, KeyError):
        with pytest.raises(kind) as raised:
            run["weight"]
    assert str(raised.value).startswith("'weight' is no name of the results: ")
    assert run.get("weight") is None


def test_the_compilers_first_message(oscillator):
    wrong = my.CppModel(oscillator.cpp().replace("y[v],", "y[v] + missing,"), "oscillator", "x v", "w")
    with pytest.raises(my.Error, match="the model does not compile .*missing") as raised:
        my.solve(wrong, **CALL)
    assert len(str(raised.value).splitlines()) == 1


def test_names_must_be_as_many_as_components(oscillator):
    wrong = my.CppModel(oscillator.cpp(), "oscillator", "x v", "w u")
    with pytest.raises(my.Error, match="the model has 1 components of kind parameter, and 2 names are given"):
        my.solve(wrong, {"w": 1, "u": 1}, start={"x": 1, "v": 0}, time=(0, 1))


def test_what_was_not_asked_for(oscillator):
    run = my.solve(oscillator, **CALL)
    with pytest.raises(KeyError, match="'y' is no name of the results: there are x_end, v_end, t_last, status"):
        run["y"]
    with pytest.raises(my.Error, match="no samples were taken"):
        _ = run.t_sample


def test_a_message_names_some_of_many_missing_values():
    x = my.states(" ".join(f"x{i}" for i in range(12)))
    with pytest.raises(my.Error, match="initial value of 'x0', .*'x7' and 4 more is missing: give it in start="):
        my.solve(my.model({s: -s for s in x}), time=(0, 1), interpreted=True)
