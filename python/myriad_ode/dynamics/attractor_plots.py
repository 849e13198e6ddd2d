# SPDX-License-Identifier: MIT
"""Pictures of basins of attraction."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base import plots
from ..base.errors import Error
from ..base.plot_parts import axes_of, colours, legend, look
from ..models.components import name_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..symbolic.types import Array, Component


def legends(found: Any, across: str, up: str) -> dict[int, str]:
    """What the legend says of each attractor: its name, its place too if another has the name, and its share."""
    names = told_apart([one.name for one in found], lambda i, states: found[i].place(states),
                       [[across, up], *([state] for one in found for state in one.points)])
    return {i: f"{name}\n{100 * found[i].share:.3g} %" for i, name in enumerate(names)}


def told_apart(names: Sequence[str], place: Callable[[int, list[str]], str], several: Sequence[list[str]]) -> list[str]:
    """Names, with a line below those that are alike of where they are: in the first of several sets of states that
    tells some of them apart, and in the next ones too as long as any are alike."""
    made, shown = list(names), list[str]()
    for states in several:
        with_these = [*shown, *(state for state in states if state not in shown)]
        alike = {name for name in made if made.count(name) > 1}
        new = [f"{names[i]}\n{place(i, with_these)}" if name in alike else name for i, name in enumerate(made)]
        if len({*new}) > len({*made}):
            made, shown = new, with_these
    return made


def _pair(found: Any, values: Mapping[str, Array], x: Component | None, y: Component | None) -> tuple[str, str, bool]:
    """The states along the axes, and whether they are those of a grid."""
    given = [name_of(one) for one in (x, y) if one is not None]
    if len(given) == 1 or len(set(given)) < len(given):
        raise Error("a picture of basins is over two states: give two, or neither")
    grid = [name for name, of in found.start.axes if len(of) > 1]
    if len(grid) == 2 and all(name in found.start.coordinates for name in grid) and (not given or set(given) ==
                                                                                      set(grid)):
        return (given or grid)[0], (given or grid)[1], True
    varying = given or [name for name, of in values.items() if np.ptp(of) > 0][:2]
    if len(varying) < 2 or not all(name in values for name in varying):
        raise Error(f"starts vary in {', '.join(varying) or 'no state'}: a picture of basins is over two states, name "
                    f"two of {', '.join(values)}")
    return varying[0], varying[1], False


def basins(found: Any, values: Mapping[str, Array], x: Component | None, y: Component | None, axes: Axes | None,
           style: dict[str, Any]) -> Any:
    across, up, is_grid = _pair(found, values, x, y)
    names = legends(found, across, up)
    labels = np.ma.masked_less(found.labels, 0)
    xlabel, ylabel = f"{across} at the start", f"{up} at the start"
    if is_grid:
        order = [name for name, _ in found.start.axes]
        grid = np.ma.asarray(np.moveaxis(labels, (order.index(across), order.index(up)), (0, 1)))
        of = dict(found.start.axes)
        axes = axes_of(axes, figsize=(7.4, 4.8))
        lost = np.ma.getmaskarray(grid).mean()
        axes = plots.parameter_map(of[across], of[up], grid.reshape(grid.shape[:2]), names=names, xlabel=xlabel,
                                   ylabel=ylabel, axes=axes, **style,
                                   zlabel=f"grey: {100 * lost:.3g} % come to no attractor" if lost else "")
    else:
        axes = axes_of(axes, figsize=(6.4, 4.8))
        _scattered(axes, values[across], values[up], labels.ravel(), names, style)
        axes.set_xlabel(xlabel)
        axes.set_ylabel(ylabel)
    for one in found:
        if across in one.points and up in one.points:
            few = len(one.points[across]) <= 32
            axes.plot(one.points[across], one.points[up], linestyle="none", marker="o", color="black",
                      markeredgecolor="white", markersize=5 if few else 2, markeredgewidth=0.8 if few else 0)
    return axes


def _scattered(axes: Any, x: Array, y: Array, labels: Any, names: Mapping[int, str], style: dict[str, Any]) -> None:
    usual = {"linestyle": "none", "marker": "o", "markersize": 3 if len(x) < 5000 else 1.5, "markeredgewidth": 0,
             "rasterized": True}
    lost = np.ma.getmaskarray(labels)
    if lost.any():
        axes.plot(x[lost], y[lost], **look({**usual, "color": "0.7", "label": "none"}, style))
    for i, name in names.items():
        at = ~lost & (np.ma.getdata(labels) == i)
        colour = colours[i] if i < len(colours) else "0.5"
        axes.plot(x[at], y[at], **look({**usual, "color": colour, "label": name}, style))
    legend(axes, markerscale=2)


def _kinds(found: Sequence[str]) -> str:
    """What an attractor is at all values of a parameter, with a period if that is always the same."""
    kinds = list(dict.fromkeys(kind for kind in found if kind))
    if len(kinds) > 1:
        kinds = list(dict.fromkeys(re.sub(" of period [^ ]+", "", kind) for kind in kinds))
    return f"{', '.join(kinds[:2])}{' ...' if len(kinds) > 2 else ''}"


def _most_company(found: Any, number: int) -> int:
    """The place in the middle of those at which an attractor is with most others."""
    there = [i for i, of in enumerate(found.numbers) if number in of]
    most = max(len(found.numbers[i]) for i in there)
    with_most = [i for i in there if len(found.numbers[i]) == most]
    return with_most[len(with_most) // 2]


def shares(found: Any, axes: Axes | None, style: dict[str, Any]) -> Any:
    """Shares of attractors over a parameter, one above the other."""
    count = found.shares.shape[1]
    if not count:
        raise Error(f"there is no attractor at any value of {found.parameter}, and so no share to show")
    axes = axes_of(axes, figsize=(7, 3.6))
    where = [_most_company(found, number) for number in range(count)]

    def place(number: int, states: list[str]) -> str:
        at = where[number]
        shown = found[at][found.numbers[at].index(number)].place(states)
        return f"{shown} at {found.parameter} = {found.values[at]:.4g}" if shown else ""

    names = told_apart([_kinds(found.kinds(number)) for number in range(count)], place,
                       [[state] for at in found for one in at for state in one.points])
    names = [f"{number}: {name}" for number, name in enumerate(names)]
    usual = {"labels": names, "colors": [colours[i] if i < len(colours) else "0.5" for i in range(count)],
             "linewidth": 0}
    axes.stackplot(found.values, 100 * found.shares.T, **{**usual, **style})
    legend(axes)
    axes.set_xlabel(found.parameter)
    axes.set_ylabel("% of the starts")
    axes.set_ylim(0, 100)
    axes.margins(x=0)
    return axes
