# SPDX-License-Identifier: MIT
"""What pictures have in common: colours, classes, legends, scales, labels, and how matplotlib's arguments change them.
The program `myriad` draws by a copy of this file.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from .errors import Error

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis

# Okabe and Ito's colours, which the colour-blind can tell apart.
colours = ("#0072B2", "#E69F00", "#009E73", "#CC79A7", "#D55E00", "#56B4E9", "#F0E442", "#000000")
_colour_of_others = "0.6"


def several_colours(count: int) -> list[Any]:
    """So many colours that can be told apart on white; from a scale, if there are many."""
    if count <= 6:
        return list(colours[:6][:count])
    from matplotlib import colormaps
    return [colormaps["viridis"](place) for place in np.linspace(0, 0.92, count)]


def axes_of(axes: Axes | None, **figure: Any) -> Any:
    """The given axes, or those of a new figure."""
    try:
        from matplotlib import pyplot
    except ImportError:
        raise Error("pictures need the package matplotlib: `pip install matplotlib`") from None
    if axes is not None and not hasattr(axes, "plot"):
        raise Error(f"axes= is of type {type(axes).__name__}: give axes of matplotlib, as plt.subplots() returns them")
    return pyplot.subplots(layout="constrained", **figure)[1] if axes is None else axes


def label_of(array: Any, given: str | None) -> str:
    """The label that was given, or name and unit of an array of xarray."""
    if given is not None:
        return given
    name, unit = str(getattr(array, "name", None) or ""), getattr(array, "attrs", {}).get("units", "")
    return f"{name} ({unit})" if name and unit else name


def numbers(array: Any, what: str, dimensions: tuple[int, ...]) -> np.ndarray:
    """An array of one of these numbers of dimensions; a masked one stays so."""
    found = np.ma.asanyarray(array) if np.ma.isMaskedArray(array) else np.asarray(array)
    if found.ndim not in dimensions:
        wanted = " or ".join(map(str, dimensions))
        raise Error(f"{what} has shape {found.shape}: give an array of {wanted} dimensions")
    return found


def checked_quantiles(quantiles: Any) -> np.ndarray:
    """Quantiles in ascending order, each with its counterpart."""
    of = np.asarray(quantiles, float)
    if (of.ndim != 1 or not of.size or not ((of >= 0) & (of <= 1)).all() or (np.diff(of) <= 0).any()
            or not np.allclose(of + of[::-1], 1)):
        raise Error(f"quantiles are {of.tolist()}: give ascending ones from 0 to 1, each with its counterpart, as in "
                    "[0.05, 0.5, 0.95]")
    return of


def look(usual: Mapping[str, Any], style: Mapping[str, Any], artist: str = "lines.Line2D") -> dict[str, Any]:
    """Arguments of matplotlib's: the usual ones, and in their place those that were given, by any of their names."""
    import importlib

    from matplotlib.cbook import normalize_kwargs
    module, _, name = artist.partition(".")
    return {**usual, **normalize_kwargs(dict(style), getattr(importlib.import_module(f"matplotlib.{module}"), name))}


class Classes(NamedTuple):
    """Values that differ in kind and not in size: which class each one is of, masked where there is none, and the
    label and colour of each class."""

    places: Any
    labels: list[str]
    colours: list[str]


def distinct(values: np.ndarray) -> np.ndarray:
    """The values that there are: numbers in ascending order, words in that of their first appearance."""
    there = np.ma.compressed(values)
    found, first = np.unique(there, return_index=True)
    return found if found.dtype.kind != "U" else found[np.argsort(first)]


def classes_of(values: np.ndarray, names: Sequence[str] | Mapping[Any, str] | None = None) -> Classes:
    """The classes that occur. There are as many colours as can be told apart: if there are more classes, the most
    frequent ones have their own, and the last one says how many others share grey."""
    if names is None and values.dtype.kind == "b":
        names = ("no", "yes")

    def label(value: Any) -> str:
        if names is not None:
            return str(names[value.item()])
        return f"{value:.6g}" if values.dtype.kind == "f" else str(value)

    found = distinct(values)
    order = np.argsort(found, kind="stable")
    places = np.ma.masked_array(order[np.searchsorted(found, np.ma.getdata(values), sorter=order).clip(
        0, max(len(found) - 1, 0))] if len(found) else np.zeros(values.shape, int), np.ma.getmaskarray(values))
    labels = [label(value) for value in found]
    if len(found) <= len(colours):
        return Classes(places, labels, list(colours[:len(found)]))
    counts = np.bincount(places.compressed(), minlength=len(found))
    kept = np.sort(np.argsort(-counts, kind="stable")[:len(colours) - 1])
    new = np.full(len(found), len(kept))
    new[kept] = np.arange(len(kept))
    return Classes(np.ma.masked_array(new[np.ma.getdata(places)], places.mask),
                   [*(labels[i] for i in kept), f"{len(found) - len(kept)} others"],
                   [*colours[:len(kept)], _colour_of_others])


def are_classes(values: np.ndarray) -> bool:
    """Whether values are words, truth values, or few whole numbers."""
    kind = values.dtype.kind
    return kind in "Ub" or kind in "iu" and len(distinct(values)) <= len(colours)


def colour_scale(values: np.ndarray, style: Mapping[str, Any]) -> dict[str, Any]:
    """Arguments of matplotlib's for numbers in colour: those of `style`; without a range of its own, values on both
    sides of zero have diverging colours, whose middle is zero."""
    given = {name: style[name] for name in ("cmap", "norm", "vmin", "vmax") if name in style}
    there = np.ma.masked_invalid(values).compressed()
    below, above = (-there.min(), there.max()) if there.size else (0, 0)
    if min(below, above) <= 0.05 * max(below, above):  # what is beyond zero may be rounding
        return {"cmap": "viridis", **given}
    if {"norm", "vmin", "vmax"} & set(given):
        return {"cmap": "RdBu_r", **given}
    from matplotlib.colors import CenteredNorm
    return {"cmap": "RdBu_r", "norm": CenteredNorm(0, max(below, above)), **given}


def legend(axes: Axes, title: str | None = None, **more: Any) -> None:
    """A legend beside what is drawn, where the figure has a layout that makes room for it; else where least is."""
    beside = {"loc": "upper left", "bbox_to_anchor": (1.01, 1), "borderaxespad": 0}
    engine = getattr(axes.figure, "get_layout_engine", lambda: None)()
    axes.legend(title=title, frameon=False, alignment="left", **(beside if engine is not None else {"loc": "best"}),
                **more)


def is_geometric(values: np.ndarray) -> bool:
    """Whether values are spaced evenly on a logarithmic scale and not on a linear one."""
    if len(values) < 3 or values.min() <= 0:
        return False
    steps, ratios = np.diff(values), np.diff(np.log(values))
    return np.allclose(ratios, ratios[0], rtol=1e-6) and not np.allclose(steps, steps[0], rtol=1e-6)


def edges(values: np.ndarray) -> np.ndarray:
    """Borders of the cells with these midpoints, halfway between neighbours as the axis shows them."""
    if is_geometric(values):
        return np.exp(edges(np.log(values)))
    if len(values) == 1:
        return values + np.array([-0.1, 0.1])
    inner = (values[1:] + values[:-1]) / 2
    return np.concatenate(([2 * values[0] - inner[0]], inner, [2 * values[-1] - inner[-1]]))


def logarithmic(axis: Axis, set_scale: Callable[[str], object]) -> None:
    """A logarithmic axis, with ticks at 1, 2 and 5 of each decade if it has less than two, and at even steps if it has
    less than one."""
    from matplotlib.ticker import AutoLocator, LogLocator, NullFormatter, NullLocator, StrMethodFormatter

    set_scale("log")
    least, most = axis.get_view_interval()
    if most < 100 * least:
        axis.set_major_locator(AutoLocator() if most < 10 * least else LogLocator(subs=(1, 2, 5)))
        axis.set_major_formatter(StrMethodFormatter("{x:.10g}"))
        axis.set_minor_formatter(NullFormatter())
        if most < 10 * least:
            axis.set_minor_locator(NullLocator())
