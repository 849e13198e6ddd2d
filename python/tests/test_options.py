# SPDX-License-Identifier: MIT
"""The options of Python are those of the library's table of options: names, types, defaults, ranges and meanings."""

import dataclasses
import inspect
import math
import pathlib
import subprocess
import sys

import pytest

import myriad_ode as my
from myriad_ode import _core
from myriad_ode.base import option_names
from myriad_ode.solving import core_options
from myriad_ode.models.components import Components

CALL = dict(sweep={"w": [1.0, 2.0]}, start={"x": 1, "v": 0}, time=(0, 1), device="cpu")
SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts/options.py"


def test_what_is_written_of_the_table_is_what_the_table_says():
    done = subprocess.run([sys.executable, SCRIPT, "--check"], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def values_of(options):
    """All values of options of the core, by name."""
    values = {}
    for row in _core.option_rows():
        outer, _, inner = row["name"].partition(".")
        if row["name"] not in ("progress", "events") and outer != "events":
            values[row["name"]] = getattr(getattr(options, outer), inner) if inner else getattr(options, outer)
    return {name: "nan" if value != value else value for name, value in values.items()
            if not isinstance(value, (_core.RecordOptions, _core.SampleOptions))}


def test_defaults_are_those_of_the_core(oscillator):
    components = Components(oscillator)
    made, recorded, sampled = core_options.make_options(components, 1, my.Options())
    core_options.finish_options(made, my.Options(), components, 2, 0)
    assert values_of(made) == values_of(_core.Options())
    assert (recorded, sampled, made.events) == ({}, {}, [])


def test_an_option_that_is_given_reaches_the_core(oscillator):
    components = Components(oscillator)
    reached = set()
    for row in _core.option_rows():
        name = option_names.names.get(row["name"], row["name"])
        if "." in name or name in option_names.left_out or row["type"] not in ("whole number", "number", "choice"):
            continue
        before = getattr(my.Options(), name)
        other = {bool: not before, str: next((c for c in row["choices"] if c != before), None)}.get(type(before), 0.75)
        other = 7 if row["type"] == "whole number" else other
        made, _, _ = core_options.make_options(components, 1, my.Options(**{name: other}))
        assert getattr(made, row["name"]) != getattr(_core.Options(), row["name"])
        reached.add(name)
    assert len(reached) == len(dataclasses.fields(my.Options)) - len({"rtol", "atol", "events", "record", "samples"})


def test_help_names_every_option_with_its_default():
    for call, without in ((my.solve, set()), (my.study, {"time_limit", "invalid", "seed"})):
        shown = {n: p.default for n, p in inspect.signature(call).parameters.items()}
        options = {f.name: f.default for f in dataclasses.fields(my.Options) if f.name not in without}
        assert options.items() <= shown.items()
        assert without & shown.keys() == without & {*option_names.arguments_of_study}
        for name in options:
            assert f"\n{name}" in call.__doc__


def test_options_for_several_calls(oscillator):
    fine = my.Options(rtol=1e-12, atol=1e-12, phases=2)
    coarse = my.solve(oscillator, **CALL, rtol=1e-3, atol=1e-3, phases=2)
    run = my.solve(oscillator, **CALL, options=fine)
    assert run.report.accepted_steps > coarse.report.accepted_steps
    assert (run["x"] == my.solve(oscillator, **CALL, rtol=1e-12, atol=1e-12, phases=2)["x"]).all()
    again = my.solve(oscillator, **CALL, options=fine, rtol=1e-3, atol=1e-3)  # names come before
    assert (again["x"] == coarse["x"]).all()
    study = my.study(oscillator, CALL["sweep"], start=CALL["start"], time=CALL["time"], options=fine, keep=["x"])
    assert study.run(device="cpu")["x_end"][0] == pytest.approx(math.cos(2), abs=1e-9)  # two phases from 0 to 1


def test_options_of_the_wrong_kind(oscillator):
    with pytest.raises(my.Error, match="options is a dict: give my.Options"):
        my.solve(oscillator, **CALL, options={"rtol": 1e-9})
    with pytest.raises(my.Error, match="study has no option 'time_limit'"):
        my.study(oscillator, CALL["sweep"], start=CALL["start"], time=(0, 1), time_limit=3)
    with pytest.raises(my.Error, match="time_limit is given, but a study keeps what it has done"):
        my.study(oscillator, CALL["sweep"], start=CALL["start"], time=(0, 1), options=my.Options(time_limit=3)).run()
    with pytest.raises(my.Error, match='schedule is "slow"|schedule is \'slow\': give "automatic", "in_order"'):
        my.solve(oscillator, **CALL, schedule="slow")
