# SPDX-License-Identifier: MIT
"""The methods of integration and the choices of step-size control, by the names of the C++ library."""

from __future__ import annotations

import difflib
from collections.abc import Sequence
from typing import Any, Literal, get_args

from ..base.errors import Error

Method = Literal["runge_kutta_4", "cash_karp", "tsitouras_5", "dormand_prince_5", "verner_7", "dormand_prince_8",
                 "verner_9", "rosenbrock_23", "rodas_5p", "euler_maruyama", "milstein", "stochastic_heun",
                 "sra1", "sriw1"]  # of the library's headers, as tests say
Control = Literal["pi_control", "pid_control", "rms_norm", "mixed_scale", "automatic_first_step",
                  "tolerance_per_instance"]
methods: tuple[str, ...] = get_args(Method)  #: the names of methods
controls: tuple[str, ...] = get_args(Control)  #: the names of choices of step-size control
stochastic = ("euler_maruyama", "milstein", "stochastic_heun", "sra1", "sriw1")  #: for noise, the first by default
additive_noise, diagonal_noise = ("sra1",), ("milstein", "sriw1")  #: those for this noise alone; all: additive
fixed_step = ("runge_kutta_4", *stochastic)
stiff = ("rosenbrock_23", "rodas_5p")  #: those that solve linear systems

_stages = {"runge_kutta_4": 4, "cash_karp": 6, "verner_7": 10, "dormand_prince_8": 12, "verner_9": 16,
           "rosenbrock_23": 3, "rodas_5p": 8, "euler_maruyama": 1, "milstein": 1, "stochastic_heun": 2, "sra1": 2,
           "sriw1": 2}


def stages_of(written: str) -> int:
    """The stages of the method in a C++ type."""
    return next((count for name, count in _stages.items() if name in written), 7)


default = "tsitouras_5"  # docs/methods.md#the-default

# What other packages call methods that are here, or whose place one takes.
_elsewhere = {"rk45": "dormand_prince_5", "dopri5": "dormand_prince_5", "dp5": "dormand_prince_5",
              "rk23": "tsitouras_5", "bs3": "tsitouras_5", "tsit5": "tsitouras_5", "dop853": "dormand_prince_8",
              "dp8": "dormand_prince_8", "vern7": "verner_7", "vern9": "verner_9", "rk4": "runge_kutta_4",
              "radau": "rodas_5p", "bdf": "rodas_5p", "lsoda": "rodas_5p", "vode": "rodas_5p", "cvode": "rodas_5p",
              "rodas5p": "rodas_5p", "rosenbrock23": "rosenbrock_23", "rkck": "cash_karp", "em": "euler_maruyama",
              "rkmil": "milstein", "sri": "sriw1", "sri1": "sriw1", "srk": "sriw1"}


def method_type(name: str, chosen: str | Sequence[str] = (), samples: bool = False) -> str:
    """The C++ type of a method with choices of its control, and with dense output if samples are wanted."""
    if name not in methods:
        near = _elsewhere.get(str(name).lower()) or next(iter(difflib.get_close_matches(str(name), methods, 1)), None)
        hint = f"use \"{near}\", or another" if near else "choose one"
        raise Error(f"there is no method {name!r}: {hint} of {', '.join(methods)}")
    choices: tuple[Any, ...] = tuple(chosen) if isinstance(chosen, (list, tuple, set)) else (chosen,)
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
