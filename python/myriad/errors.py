# SPDX-License-Identifier: MIT
"""What the package raises: one class, so that callers can tell its messages from those of other packages."""

from __future__ import annotations

import difflib
import os
import sys
import types
from collections.abc import Collection, Iterable

import numpy as np

from . import option_names

_here = os.path.dirname(os.path.abspath(__file__)) + os.sep


class Error(ValueError):
    """Something in a model, a sweep or the options of a call is wrong; the message says what and what to do."""


class CannotInterpret(Error):
    """The interpreter, which runs models where there is no compiler, lacks what a model has."""


# Statements of the core, its errors and notes, are lists of parts: what it is of these, what C++ says, a key, and a
# number. What follows has Python's words for options, cures and events, by their keys.
_text, _option, _component, _event, _separator, _cure = range(6)

_options = {**option_names.names, "repeat": "draws=", "ensemble": "the sweep"}
_cures = {
    "mark_invalid": "give invalid=\"mark\"", "set_value": "give it in {where}", "name_in_record": "name it in record=",
    "name_in_samples": "name it in samples=", "give_step": "give step=", "use_doubles": "give precision=\"double\"",
    "scale_tolerances": "give control=\"tolerance_per_instance\"",
    "smaller_parts": "integrate the sweep in smaller parts", "fewer_instances": "integrate the sweep in {parts}",
    "smaller_chunk": "make chunk= smaller", "new_folder": "give another store= and a smaller chunk="}
# Where values are given that the core calls by these names; others are in the sweep.
_given_in = {"t_begin": "time=", "t_end": "time=", "state": "start=", "tolerance_scale": "tolerance_scale="}


def in_words(parts, events=()):
    """A statement of the core in Python's words. `events`: the names of the model's events."""
    subject = next((key for kind, _, key, _ in parts if kind in (_option, _component, _event)), "")

    def words(kind, said, key, number):
        if kind == _option:
            name = key.removeprefix("options.")
            if name.startswith("samples.") and name == key:
                return key.replace(".", " ")
            return key[:len(key) - len(name)] + _options[name] if name in _options else said
        if kind == _event and number < len(events):
            return f"event {events[number]!r}"
        if kind == _cure:
            return _cures[key].format(where=_given_in.get(subject, "the sweep"),
                                      parts=f"parts of at most {number} instances" if number > 0 else "smaller parts")
        return said

    return "".join(words(*part) for part in parts)


def in_python(parts, events=()):
    """An error of the core in Python's words."""
    error = Error(in_words(parts, events))
    error.parts = parts
    return error


def with_event_names(error, events):
    """The same error with the names of the model's events, where the core had their numbers."""
    if not hasattr(error, "parts"):
        return error
    named = in_python(error.parts, events)
    named.__dict__.update({**error.__dict__, **named.__dict__})
    return named


class UnknownOption(Error, TypeError):
    """A call names an option that does not exist."""


def users_line() -> tuple[str, int] | None:
    """File and line of the innermost caller outside this package, as (file, line), or None."""
    frame: types.FrameType | None = sys._getframe(1)
    while frame is not None and frame.f_code.co_filename.startswith(_here):
        frame = frame.f_back
    return None if frame is None else (frame.f_code.co_filename, frame.f_lineno)


# What SciPy and other packages call options, and what to write instead.
_elsewhere = {
    "t_span": "time=(begin, end)", "tspan": "time=(begin, end)", "y0": "start={x: 1, v: 0}",
    "x0": "start={x: 1, v: 0}", "u0": "start={x: 1, v: 0}", "t_eval": "samples=times", "saveat": "samples=times",
    "dense_output": "samples=, a number of evenly spaced times or an array of times",
    "args": "values of parameters in the sweep, {k: 0.1}", "p": "values of parameters in the sweep, {k: 0.1}",
    "first_step": "step=", "h0": "step=", "dt": "step=", "max_step": "maximum_step=", "hmax": "maximum_step=",
    "dtmax": "maximum_step=", "min_step": "minimum_step=", "hmin": "minimum_step=", "dtmin": "minimum_step=",
    "mxstep": "max_steps=", "nsteps": "max_steps=", "maxiters": "max_steps=", "reltol": "rtol=", "abstol": "atol=",
    "fun": "a model, the first argument", "f": "a model, the first argument", "alg": "method=", "callback": "events=",
    "threads": "device=\"cpu:4\"", "n_jobs": "device=\"cpu:4\""}
_needless = ("jac", "jac_sparsity", "lband", "uband", "vectorized", "Dfun", "tfirst")


def refuse_options(given: Iterable[str], known: Collection[str], call: str) -> None:
    """Refuses options that a call does not have, {name: value}, with what it has in their place."""
    for name in given:
        if name in _needless:
            hint = "leave it out, as the model's equations say all of this"
        elif name in _elsewhere:
            hint = f"give {_elsewhere[name]}"
        else:
            near = difflib.get_close_matches(name, known, 1)
            hint = f"did you mean '{near[0]}'?" if near else f"help(myriad.{call}) lists what there is"
        raise UnknownOption(f"{call} has no option '{name}'{at(users_line())}: {hint}")


def refuse_masked(values: object, what: str) -> None:
    """Refuses a masked array, whose hidden values would count as given."""
    if isinstance(values, np.ma.MaskedArray):
        if np.ma.is_masked(values):
            raise Error(f"{what} has masked values{at(users_line())}: every value is needed, so fill them, as by "
                        ".filled(0.0), or leave out their instances")


def at(line: tuple[str, int] | None) -> str:
    """', FILE:LINE' for messages; nothing where the line is not known."""
    return "" if line is None else f" ({os.path.basename(line[0])}:{line[1]})"
