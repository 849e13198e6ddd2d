# SPDX-License-Identifier: MIT
"""The methods of integration and the choices of step-size control, by the names of the C++ library."""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable, Sequence
from typing import Any, Literal, NamedTuple, get_args

from .. import _core
from ..base.errors import Error

Method = Literal["runge_kutta_4", "cash_karp", "tsitouras_5", "dormand_prince_5", "verner_7", "dormand_prince_8",
                 "verner_9", "rosenbrock_23", "rodas_5p", "euler_maruyama", "milstein", "stochastic_heun",
                 "sra1", "sriw1", "dri1", "linearly_implicit_euler_maruyama"]  # as in the headers; a test compares them
Control = Literal["pi_control", "pid_control", "rms_norm", "mixed_scale", "automatic_first_step",
                  "tolerance_per_instance"]
methods: tuple[str, ...] = get_args(Method)  #: the names of methods
controls: tuple[str, ...] = get_args(Control)  #: the names of choices of step-size control


class _Facts(NamedTuple):
    """What the library says of a method. `noise`, which it takes, is "none", "any", "additive", or "diagonal", where
    additive noise counts too. Of those, all but the methods for means alone follow paths, and some estimate the errors
    of their steps along them."""

    stages: int
    fixed_step: bool
    solves_linear_systems: bool
    noise: str
    follows_paths: bool
    estimates_error: bool


_facts = {name: _Facts(*facts) for name, facts in _core.methods.items()}


def _those(condition: Callable[[_Facts], bool]) -> tuple[str, ...]:
    return tuple(name for name, facts in _facts.items() if condition(facts))


stochastic = _those(lambda facts: facts.noise != "none")  #: for noise, the first by default
additive_noise = _those(lambda facts: facts.noise == "additive")  #: those for this noise alone
diagonal_noise = _those(lambda facts: facts.noise == "diagonal")  #: those for this noise, or additive noise, alone
pathless = _those(lambda facts: facts.noise != "none" and not facts.follows_paths)  #: those for means alone
adaptive_on_paths = _those(lambda facts: facts.estimates_error)  #: those that take adaptive steps along them too
fixed_step = _those(lambda facts: facts.fixed_step)
stiff = _those(lambda facts: facts.solves_linear_systems)  #: those that solve linear systems


def stages_of(written: str) -> int:
    """The stages of the method in a C++ type."""
    return next((_facts[word].stages for word in re.findall(r"\w+", written) if word in _facts), 7)


halving = "halving"  #: stands for `adaptive` of methods for noise; the package chooses it, not the user


def choices_of(control: Any) -> tuple[Any, ...]:
    """The choices of a control that is given as one or several."""
    return tuple(control) if isinstance(control, (list, tuple, set)) else (control,)


default = "tsitouras_5"  # docs/methods.md#the-default

# What other packages call methods that are here, or whose place one takes.
_elsewhere = {"rk45": "dormand_prince_5", "dopri5": "dormand_prince_5", "dp5": "dormand_prince_5",
              "rk23": "tsitouras_5", "bs3": "tsitouras_5", "tsit5": "tsitouras_5", "dop853": "dormand_prince_8",
              "dp8": "dormand_prince_8", "vern7": "verner_7", "vern9": "verner_9", "rk4": "runge_kutta_4",
              "radau": "rodas_5p", "bdf": "rodas_5p", "lsoda": "rodas_5p", "vode": "rodas_5p", "cvode": "rodas_5p",
              "rodas5p": "rodas_5p", "rosenbrock23": "rosenbrock_23", "rkck": "cash_karp", "em": "euler_maruyama",
              "implicitem": "linearly_implicit_euler_maruyama", "rkmil": "milstein", "sri": "sriw1", "sri1": "sriw1",
              "srk": "sriw1", "siea": "dri1"}


def method_type(name: str, chosen: str | Sequence[str] = (), samples: bool = False) -> str:
    """The C++ type of a method with choices of its control, and with dense output if samples are wanted."""
    if name not in methods:
        lower = str(name).lower()
        near = _elsewhere.get(lower) or next(iter(difflib.get_close_matches(lower, methods, 1)), None)
        hint = f"use \"{near}\", or another" if near else "choose one"
        raise Error(f"there is no method {name!r}: {hint} of {', '.join(methods)}")
    choices = choices_of(chosen)
    if choices == (halving,) and name in adaptive_on_paths:
        written = f"myriad::adaptive<myriad::{name}>"
        return f"myriad::dense<{written}>" if samples else written
    for choice in choices:
        if choice not in controls:
            raise Error(f"there is no step-size control {choice!r}: choose of {', '.join(controls)}")
    if choices and name in fixed_step:
        raise Error(f"{name} takes fixed steps and has no step-size control to choose: leave out control=, or take "
                    "an adaptive method")
    written = f"myriad::{name}"
    if choices:
        written = f"myriad::controlled<{', '.join([written] + ['myriad::' + c for c in choices])}>"
    return f"myriad::dense<{written}>" if samples else written
