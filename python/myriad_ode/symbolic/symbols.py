# SPDX-License-Identifier: MIT
"""The symbols of a model: states, parameters, shared values, accessories, time and what else hooks can see. A symbol is
its kind and its name: made twice, it is the same.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Collection
from typing import TYPE_CHECKING, Any, Protocol

from ..base import component_kinds as kinds
from ..base.errors import Error, at, users_line
from .expression import make
from .node import integer, real

if TYPE_CHECKING:
    from .expression import Expression
    from .types import Names

__all__ = ["states", "state", "parameters", "parameter", "shared", "shared_integer", "accessory", "integer_accessory",
           "event_count", "wiener", "time", "step", "next_step", "phase", "instance", "t_begin", "t_end", "end_phase",
           "end_instance"]


class Named(Protocol):
    """What has a name, as an event."""

    name: str | None


_cpp_keywords = set("""
alignas alignof and and_eq asm auto bitand bitor bool break case catch char char8_t char16_t char32_t class compl
concept const consteval constexpr constinit const_cast continue co_await co_return co_yield decltype default delete do
double dynamic_cast else enum explicit export extern false float for friend goto if inline int long mutable namespace
new noexcept not not_eq nullptr operator or or_eq private protected public register reinterpret_cast requires return
short signed sizeof static static_assert static_cast struct switch template this thread_local throw true try typedef
typeid typename union unsigned using virtual void volatile wchar_t while xor xor_eq typeof
""".split())
# Members that the library looks for in a model by name, and macros of C's headers.
_reserved = {*kinds.every, *"""observed rhs jacobian events
observe summaries initialise after_step after_event after_stop after_trigger finalise generate writes_parameters
writes_time_domain accessories_are_outputs scalar_only rare_events large_rhs rhs_weight autonomous jacobian_pattern
mass_matrix pack_batches max_block_size triggers_know_their_function
myriad std linux unix errno assert NULL NAN INFINITY EOF BUFSIZ RAND_MAX HUGE_VAL OVERFLOW UNDERFLOW DOMAIN SING PLOSS
TLOSS stdin stdout stderr major minor alloca offsetof issubnormal math_errhandling sched_priority""".split()}
_reserved_pattern = re.compile(
    rf"n_({'|'.join(kinds.every)}|observed|tangent|original|vectors)|"
    r"M_[A-Z0-9_]+|MYRIAD_.*|[A-Z0-9]+_(MAX|MIN|EPSILON|DIG)|FP_[A-Z]+")


def check_name(name: Any, what: str) -> str:
    """Refuses a name that no C++ model can have, with what to write instead."""
    line = at(users_line())
    if not isinstance(name, str):
        raise Error(f"the name of {what} is {name!r}{line}: give a string, as in my.parameter(\"k\")")
    if re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", name) is None or "__" in name:
        raise Error(f"'{name}' is no name for {what}{line}: use letters without accents, digits and single "
                    "underscores, beginning with a letter, as in 'mu' or 'x_1'")
    if name in _cpp_keywords:
        raise Error(f"'{name}' is a keyword of C++, in which models are compiled, and cannot be the name of {what}"
                    f"{line}: call it '{name}_'")
    if name in _reserved or _reserved_pattern.fullmatch(name):
        raise Error(f"'{name}' has a meaning of its own in a C++ model or in C's headers, and cannot be the name of "
                    f"{what}{line}: call it '{name}_'")
    return name


def is_allowed(name: str) -> bool:
    """Whether a component can have the name."""
    try:
        check_name(name, "a component")
    except Error:
        return False
    return True


def free_name(name: str, taken: Collection[str]) -> str:
    """The name, or else the first like it, with an underscore, a number or x_ before it, that a component can have and
    that is not taken."""
    if not is_allowed(name) and not is_allowed(f"{name}_"):
        name = f"x_{name}"  # as all names that begin like C's M_PI
    for candidate in itertools.chain((name, f"{name}_"), (f"{name}_{i}" for i in range(2, 10000))):
        if candidate not in taken and is_allowed(candidate):
            return candidate
    raise Error(f"no name for a component is left that is like '{name}'")


def a(kind: str) -> str:
    """A kind of component for messages, as in 'a shared integer'."""
    kind = {"noise": "Wiener process"}.get(kind, kind)
    return ("an " if kind[0] in "aei" else "a ") + kind.replace("_", " ")


def symbol(kind: str, name: str, type: str = real) -> Any:
    """The symbol of a component."""
    return make("symbol", value=(kind, check_name(name, a(kind))), type=type)


def names(several: Any) -> list[str]:
    """The names in "x v", "x, v" or a list."""
    return several.replace(",", " ").split() if isinstance(several, str) else list(several)


def _several(kind: str, several: Names, type: str = real) -> tuple[Any, ...]:
    found = names(several)
    if not found:
        raise Error(f"no names are given{at(users_line())}: list them, as in my.states(\"x v\")")
    if len(set(found)) < len(found):
        twice = next(n for n in found if found.count(n) > 1)
        raise Error(f"'{twice}' is given twice{at(users_line())}: a name stands for one component")
    return tuple(symbol(kind, name, type) for name in found)


def states(names: Names) -> tuple[Expression, ...]:
    """The unknowns, as in `x, v = my.states("x v")`; always a tuple."""
    return _several("state", names)


def state(name: str) -> Expression:
    """One unknown."""
    return symbol("state", name)


def parameters(names: Names) -> tuple[Expression, ...]:
    """Several numbers with one value per instance, as a tuple."""
    return _several("parameter", names)


def parameter(name: str) -> Expression:
    """A number with one value per instance."""
    return symbol("parameter", name)


def shared(name: Names) -> Any:
    """A number with one value for all instances; several names in a string give a tuple."""
    found = names(name)
    return symbol("shared", found[0]) if len(found) == 1 else _several("shared", found)


def shared_integer(name: str) -> Expression:
    """A whole number with one value for all instances."""
    return symbol("shared_integer", name, integer)


def accessory(name: str) -> Expression:
    """A real number that the model stores by instance: hooks, actions and summaries over a phase write it."""
    return symbol("accessory", name)


def integer_accessory(name: str) -> Expression:
    """A whole number that the model stores by instance, such as a count or a mode."""
    return symbol("integer_accessory", name, integer)


def event_count(event: Named | str) -> Expression:
    """How often the event, given by its name or itself, was detected in this phase; in its action including this time.
    For hooks and actions."""
    return make("symbol", value=("event_count", check_name(getattr(event, "name", event), "an event")), type=integer)


def wiener(name: Names) -> Any:
    """A Wiener process, for noise that states share: a key in `noise={x: {W: factor}}` of a model; several names in a
    string give a tuple."""
    found = names(name)
    return symbol("noise", found[0]) if len(found) == 1 else _several("noise", found)


def _built_in(kind: str, type: str = real) -> Any:
    return make("symbol", value=("built-in", kind), type=type)


time = _built_in("time")  #: the time; in an action the time of the event
step = _built_in("step")  #: in hooks: the length of the step just taken, negative backwards
next_step = _built_in("next_step")  #: in hooks: the length of the next trial step, which they may assign
phase = _built_in("phase", integer)  #: in hooks: the number of the phase, from 0
instance = _built_in("instance", integer)  #: in hooks and `generate`: the number of the instance, from 0
t_begin = _built_in("t_begin")  #: in hooks: begin of the time domain, which they may assign
t_end = _built_in("t_end")  #: in hooks: end of the time domain, which they may assign
stop_number = _built_in("stop_number")  # in the times of a stop, and its action: which of them, from 0
end_phase = make("symbol", value=("action", "end_phase"), type="condition")  #: assign a condition: true ends the phase
#: assign a condition: true ends the phase, and no further one begins
end_instance = make("symbol", value=("action", "end_instance"), type="condition")
