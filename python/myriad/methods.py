# SPDX-License-Identifier: MIT
"""The methods of integration and the choices of step-size control, by the names of the C++ library."""

from .errors import Error

methods = ("cash_karp", "dormand_prince_5", "tsitouras_5", "verner_7", "dormand_prince_8", "runge_kutta_4",
           "rosenbrock_23", "rodas_5p")
fixed_step = ("runge_kutta_4",)
controls = ("pi_control", "pid_control", "rms_norm", "mixed_scale", "automatic_first_step", "tolerance_per_instance")


def method_type(name, chosen=(), samples=False):
    """The C++ type of a method with choices of its control, and with dense output if samples are wanted."""
    if name not in methods:
        raise Error(f"there is no method {name!r}: choose one of {', '.join(methods)}")
    chosen = tuple(chosen) if isinstance(chosen, (list, tuple, set)) else (chosen,)
    for choice in chosen:
        if choice not in controls:
            raise Error(f"there is no step-size control {choice!r}: choose of {', '.join(controls)}")
    if chosen and name in fixed_step:
        raise Error(f"{name} takes fixed steps and has no step-size control to choose: leave out control=, or take "
                    "cash_karp, for example")
    written = f"myriad::{name}"
    if chosen:
        written = f"myriad::controlled<{', '.join([written] + ['myriad::' + c for c in chosen])}>"
    return f"myriad::dense<{written}>" if samples else written
