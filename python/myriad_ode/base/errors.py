# SPDX-License-Identifier: MIT
"""What the package raises: one class, so that callers can tell its messages from those of other packages."""

from __future__ import annotations

import difflib
import os
import sys
import threading
import types
from collections.abc import Collection, Iterable, Mapping


_here = os.path.dirname(os.path.dirname(os.path.abspath(__file__))) + os.sep  # the package's folder


class Error(ValueError):
    """Something in a model, a sweep or the options of a call is wrong; the message says what and what to do."""


class CannotInterpret(Error):
    """The interpreter, which runs models where there is no compiler, lacks what a model has."""


class UnknownOption(Error, TypeError):
    """A call names an option that does not exist."""


class UnknownName(Error, KeyError):
    """A mapping is asked for a name that it does not have."""

    __str__ = Exception.__str__  # which, unlike a KeyError's, shows the message as it is


def quoted(names: Iterable[str], most: int = 8) -> str:
    """Names for a message, in quotes: the first ones, and how many more there are."""
    all_names = [repr(name) for name in names]
    more = f" and {len(all_names) - most} more" if len(all_names) > most else ""
    return ", ".join(all_names[:most]) + more


#: In a thread that the package has started, the line of the user's call, if it has set one.
caller = threading.local()


def users_line() -> tuple[str, int] | None:
    """File and line of the innermost caller outside this package, as (file, line), or None."""
    if (line := getattr(caller, "line", None)) is not None:
        return line
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
    "sensitivities": "free=", "by": "free=",
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
            hint = f"did you mean '{near[0]}'?" if near else f"help(my.{call}) lists what there is"
        raise UnknownOption(f"{call} has no option '{name}'{at(users_line())}: {hint}")


def renamed(what: str, name: str, names: Mapping[str, str]) -> str:
    """What a member is called now that has another name, or that there is none of this name."""
    if name in names:
        return f"{what}.{name} has another name: use {what}.{names[name]}"
    return f"there is no {what}.{name}"


def refuse_masked(values: object, what: str) -> None:
    """Refuses a masked array, whose hidden values would count as given."""
    masked = sys.modules.get("numpy.ma")  # which takes ten times as long to load as a small model to integrate
    if masked is not None and isinstance(values, masked.MaskedArray):
        if masked.is_masked(values):
            raise Error(f"{what} has masked values{at(users_line())}: every value is needed, so fill them, as by "
                        ".filled(0.0), or leave out their instances")


def at(line: tuple[str, int] | None) -> str:
    """', FILE:LINE' for messages; nothing where the line is not known."""
    return "" if line is None else f" ({os.path.basename(line[0])}:{line[1]})"
