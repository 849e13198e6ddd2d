# SPDX-License-Identifier: MIT
"""The mass matrix M of a model M y' = f(t, y): constant numbers, read, checked, and written as C++."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.errors import Error, at
from ..symbolic.node import Node, text

if TYPE_CHECKING:
    from .any_model import AnyModel

method = "rodas_5p"  # the one that takes a mass matrix


def _number(value: Any, what: str, line: Any) -> float:
    if isinstance(value, Node) and value.op == "constant":
        value = value.value
    try:
        number = float(value)
    except (TypeError, ValueError):
        shown = f"`{text(value)}`" if isinstance(value, Node) else repr(value)
        raise Error(f"{what} of mass_matrix is {shown}{at(line)}: it is a constant matrix of numbers; divide the "
                    "equation by what depends on the state, on time or on parameters") from None
    if not np.isfinite(number):
        raise Error(f"{what} of mass_matrix is {number}{at(line)}: give finite numbers")
    return number


def read_mass_matrix(given: Any, states: list[str], name_of: Any, line: Any) -> np.ndarray[Any, Any] | None:
    """The matrix that was given, by rows; None if it is the identity. `name_of` gives the name of a component that is
    given as a symbol or by its name."""
    n = len(states)
    mass: np.ndarray[Any, Any]
    if hasattr(given, "items"):
        mass = np.eye(n)
        for key, value in given.items():
            name = name_of(key)
            if name not in states:
                raise Error(f"mass_matrix has a factor of '{name}'{at(line)}, which is no state: there are "
                            f"{', '.join(states)}")
            mass[states.index(name)] *= _number(value, f"the factor of {name}'", line)
    else:
        if hasattr(given, "toarray"):  # a sparse matrix of SciPy
            given = given.toarray()
        try:
            values = np.asarray(given, dtype=object)
        except ValueError:
            values = np.empty(0, object)
        if values.shape not in ((n, n), (n,)):
            raise Error(f"mass_matrix has shape {values.shape}{at(line)}: give {n} by {n} numbers in the order of the "
                        f"states ({', '.join(states)}), {n} numbers for a diagonal, or a dict {{state: factor of its "
                        "derivative}")
        numbers = np.array([_number(v, f"entry {np.unravel_index(i, values.shape)}" if values.ndim == 2 else
                                    f"entry {i}", line) for i, v in enumerate(values.flat)]).reshape(values.shape)
        mass = np.diag(numbers) if values.ndim == 1 else numbers
    if not mass.any():
        raise Error(f"mass_matrix is zero{at(line)}, so that no equation has a derivative: a model has at least one "
                    "differential equation")
    if np.array_equal(mass, np.eye(n)):
        return None
    mass.flags.writeable = False
    return mass


def left_sides(model: Any) -> list[str]:
    """What stands to the left of each equation, as text: "x'" without a mass matrix."""
    if model.mass_matrix is None:
        return [f"{state}'" for state in model.states]
    sides = []
    for row in model.mass_matrix:
        side = ""
        for state, factor in zip(model.states, row):
            if factor:
                sign = " - " if side and factor < 0 else "-" if factor < 0 else " + " if side else ""
                size = "" if abs(factor) == 1 else f"{abs(float(factor)):.17g} "
                side += f"{sign}{size}{state}'"
        sides.append(side or "0")
    return sides


def mass_entries(model: Any) -> str:
    """The entries as an initialiser of C++, by the names of states."""
    states = model.states
    return ", ".join(f"{{{states[i]}, {states[j]}, {float(model.mass_matrix[i, j])!r}}}"
                     for i, j in np.argwhere(model.mass_matrix))


def check_method(model: AnyModel, chosen: str) -> None:
    """Refuses a method that does not take the model's mass matrix."""
    if model.mass_matrix is not None and chosen != method:
        raise Error(f"the model has a mass matrix, which {chosen} does not take: give method=\"{method}\"")
