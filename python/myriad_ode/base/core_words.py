# SPDX-License-Identifier: MIT
"""What the core says, in Python's words. Its errors and notes are statements, lists of parts: what it is, what C++
says, a key and a number. Options, cures and events have words here, by their keys."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from . import option_names
from .errors import Error

# What a part is, in the core's order.
_text, _option, _component, _event, _separator, _cure = range(6)

_options = {**option_names.names, "repeat": "draws=", "ensemble": "the sweep"}
_cures = {
    "mark_invalid": "give invalid=\"mark\"", "set_value": "give it in {where}", "name_in_record": "name it in record=",
    "name_in_samples": "name it in samples=", "give_step": "give step=", "use_doubles": "give precision=\"double\"",
    "make_consistent": "let my.solve find them by make_consistent=True",
    "scale_tolerances": "give control=\"tolerance_per_instance\"",
    "smaller_parts": "integrate the sweep in smaller parts", "fewer_instances": "integrate the sweep in {parts}",
    "allow_arithmetic": "give arithmetic=\"any\"",
    "smaller_chunk": "make chunk= smaller", "new_folder": "give another store= and a smaller chunk="}
# Where values are given that the core calls by these names; others are in the sweep.
_given_in = {"t_begin": "time=", "t_end": "time=", "state": "start=", "tolerance_scale": "tolerance_scale="}


def in_words(parts: Iterable[tuple[int, str, str, int]], events: Sequence[str] = ()) -> str:
    """A statement of the core in Python's words. `events`: the names of the model's events."""
    parts = list(parts)
    subject = next((key for kind, _, key, _ in parts if kind in (_option, _component, _event)), "")

    def words(kind: int, said: str, key: str, number: int) -> str:
        if kind == _option:
            name = key.removeprefix("options.")
            if name.startswith("samples.") and name == key:
                return key.replace(".", " ")
            return key[:len(key) - len(name)] + _options[name] if name in _options else said
        if kind == _event and 0 <= number < len(events):
            return f"event {events[number]!r}"
        if kind == _cure:
            return _cures[key].format(where=_given_in.get(subject, "the sweep"),
                                      parts=f"parts of at most {number} instances" if number > 0 else "smaller parts")
        return said

    return "".join(words(*part) for part in parts)


def in_python(parts: Iterable[tuple[int, str, str, int]], events: Sequence[str] = ()) -> Error:
    """An error of the core in Python's words."""
    error: Any = Error(in_words(parts, events))
    error.parts = parts
    return error


def with_event_names(error: Error, events: Sequence[str]) -> Error:
    """The same error with the names of the model's events, where the core had their numbers."""
    if not hasattr(error, "parts"):
        return error
    named = in_python(error.parts, events)  # which the core's errors have
    named.__dict__.update({**error.__dict__, **named.__dict__})
    return named
