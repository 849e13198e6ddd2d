# SPDX-License-Identifier: MIT
"""The pictures that a sweep is usually looked at in, by matplotlib: bifurcation diagram, map over two parameters, time
series, phase portrait, statuses; and those of a fit: waterfall and profile likelihood. The functions draw arrays, of
NumPy or xarray, into `axes`, or a new figure, and return the axes. `run.plot` draws the results of a run by name. The
program `myriad` draws by a copy of this file.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from .errors import Error

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis

# What is returned is any to type checkers: matplotlib says of axes that their figure may be one which cannot be saved.

__all__ = ["bifurcation", "parameter_map", "phase_portrait", "profile", "statuses", "time_series", "waterfall"]

# Okabe and Ito's colours, which the colour-blind can tell apart.
_colours = ("#0072B2", "#E69F00", "#009E73", "#CC79A7", "#D55E00", "#56B4E9", "#F0E442", "#000000")
_many_points = 300_000  # from which on a picture shows their density


def _axes_of(axes: Axes | None, **figure: Any) -> Any:
    try:
        from matplotlib import pyplot
    except ImportError:
        raise Error("pictures need the package matplotlib: `pip install matplotlib`") from None
    return pyplot.subplots(layout="constrained", **figure)[1] if axes is None else axes


def _label(array: Any, given: str | None) -> str:
    return given if given is not None else str(getattr(array, "name", None) or "")


def _numbers(array: Any, what: str, dimensions: tuple[int, ...]) -> np.ndarray:
    numbers = np.asarray(array)
    if numbers.ndim not in dimensions:
        wanted = " or ".join(map(str, dimensions))
        raise Error(f"{what} has shape {numbers.shape}: give an array of {wanted} dimensions")
    return numbers


def _is_geometric(values: np.ndarray) -> bool:
    """Whether values are spaced evenly on a logarithmic scale and not on a linear one."""
    if len(values) < 3 or values.min() <= 0:
        return False
    steps, ratios = np.diff(values), np.diff(np.log(values))
    return np.allclose(ratios, ratios[0], rtol=1e-6) and not np.allclose(steps, steps[0], rtol=1e-6)


def _edges(values: np.ndarray) -> np.ndarray:
    """Borders of the cells with these midpoints, halfway between neighbours as the axis shows them."""
    if _is_geometric(values):
        return np.exp(_edges(np.log(values)))
    if len(values) == 1:
        return values + np.array([-0.1, 0.1])
    inner = (values[1:] + values[:-1]) / 2
    return np.concatenate(([2 * values[0] - inner[0]], inner, [2 * values[-1] - inner[-1]]))


def _logarithmic(axis: Axis, set_scale: Callable[[str], object]) -> None:
    """A logarithmic axis, with ticks at 1, 2 and 5 of each decade if it has less than two."""
    from matplotlib.ticker import LogLocator, NullFormatter, StrMethodFormatter

    set_scale("log")
    least, most = axis.get_view_interval()
    if most < 100 * least:
        axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axis.set_major_formatter(StrMethodFormatter("{x:.10g}"))
        axis.set_minor_formatter(NullFormatter())


def bifurcation(x: Any, y: Any, *, xlabel: str | None = None, ylabel: str | None = None, axes: Axes | None = None,
                **style: Any) -> Any:
    """Points (x, y) of a bifurcation diagram: x has one value per instance, y a row of values, one for each phase.
    Further arguments go to matplotlib's `plot`. Many points are drawn as their density."""
    xlabel, ylabel = _label(x, xlabel), _label(y, ylabel)
    x, y = _numbers(x, "x", (1,)), _numbers(y, "y", (1, 2))
    if len(x) != len(y):
        raise Error(f"x has {len(x)} values and y {len(y)} rows: give one row per instance")
    y = y.reshape(len(x), -1)
    axes = _axes_of(axes, figsize=(7, 4.2))
    across, up = np.repeat(x, y.shape[1]), y.ravel()
    shown = np.isfinite(across) & np.isfinite(up)
    across, up = across[shown], up[shown]
    logarithmic = _is_geometric(np.unique(x[np.isfinite(x)]))
    if len(up) > _many_points and not style:
        box = axes.get_window_extent()
        rows = max(int(box.height), 200)
        values = np.unique(across)
        columns = min(max(int(box.width), 200), len(values))  # no column without instances
        edges = np.geomspace(values[0], values[-1], columns + 1) if logarithmic else columns
        count, right, top = np.histogram2d(across, up, bins=[edges, rows])
        darkness = np.ma.masked_equal(np.sqrt(count / count.max(axis=1, keepdims=True).clip(1)), 0)
        axes.pcolormesh(right, top, darkness.T, cmap="Blues", vmin=-0.6, vmax=0.9, rasterized=True)
    else:
        look = {"linestyle": "none", "marker": "o", "markersize": 1.2 if len(up) < 20_000 else 0.5,
                "markeredgewidth": 0, "color": _colours[0], "rasterized": True, **style}
        axes.plot(across, up, **look)
    axes.margins(x=0)
    if logarithmic:
        _logarithmic(axes.xaxis, axes.set_xscale)
    axes.set_xlabel(xlabel)
    axes.set_ylabel(ylabel)
    return axes


def parameter_map(x: Any, y: Any, z: Any, *, xlabel: str | None = None, ylabel: str | None = None,
                  zlabel: str | None = None, names: Sequence[str] | None = None, axes: Axes | None = None,
                  **style: Any) -> Any:
    """A quantity z over two parameters in colour: z has shape (len(x), len(y)). NaN is left grey. With `names`, z has
    whole numbers that stand for these names; z may also be words, as statuses. Further arguments go to matplotlib's
    `pcolormesh`."""
    xlabel, ylabel, zlabel = _label(x, xlabel), _label(y, ylabel), _label(z, zlabel)
    x, y, z = _numbers(x, "x", (1,)), _numbers(y, "y", (1,)), _numbers(z, "z", (2,))
    if z.shape != (len(x), len(y)):
        raise Error(f"z has shape {z.shape} for {len(x)} values of x and {len(y)} of y: give it the shape "
                    f"({len(x)}, {len(y)})")
    if z.dtype.kind == "U":
        words, places = np.unique(z, return_inverse=True)
        names, z = words.tolist(), places.reshape(z.shape)
    axes = _axes_of(axes, figsize=(6.4, 4.8))
    axes.set_facecolor("0.85")
    if names is None:
        colours = axes.pcolormesh(_edges(x), _edges(y), np.ma.masked_invalid(z).T,
                                  **{"cmap": "viridis", "rasterized": True, **style})
        axes.figure.colorbar(colours, ax=axes, label=zlabel)
    else:
        from matplotlib.colors import BoundaryNorm, ListedColormap
        present = np.unique(z)
        places = np.searchsorted(present, z)
        palette = ListedColormap([_colours[i % len(_colours)] for i in range(len(present))])
        norm = BoundaryNorm(np.arange(len(present) + 1) - 0.5, len(present))
        colours = axes.pcolormesh(_edges(x), _edges(y), places.T,
                                  **{"cmap": palette, "norm": norm, "rasterized": True, **style})
        bar = axes.figure.colorbar(colours, ax=axes, ticks=np.arange(len(present)))
        bar.ax.set_yticklabels([names[int(p)] for p in present])
        bar.ax.minorticks_off()
    for axis, set_scale, values in ((axes.xaxis, axes.set_xscale, x), (axes.yaxis, axes.set_yscale, y)):
        if _is_geometric(values):
            _logarithmic(axis, set_scale)
    axes.set_xlabel(xlabel)
    axes.set_ylabel(ylabel)
    return axes


def _lines(x: np.ndarray, y: np.ndarray, labels: Sequence[str] | None, axes: Axes, style: Mapping[str, Any]) -> None:
    """Each row of y over the same row of x, or over x."""
    y = np.atleast_2d(y)
    x = np.broadcast_to(x, y.shape)
    if labels is not None and len(labels) != len(y):
        raise Error(f"there are {len(labels)} labels for {len(y)} lines: give one for each")
    for i in range(len(y)):
        look = {"color": _colours[i % len(_colours)], "linewidth": 1.1, **style}
        axes.plot(x[i], y[i], label=None if labels is None else labels[i], **look)
    if labels is not None and 1 < len(y) <= 10:
        axes.legend(frameon=False)


def time_series(t: Any, y: Any, *, labels: Sequence[str] | None = None, xlabel: str | None = None,
                ylabel: str | None = None, axes: Axes | None = None, **style: Any) -> Any:
    """Each row of y over time: t has a row for each, or is the same for all."""
    ylabel = _label(y, ylabel)
    t, y = _numbers(t, "t", (1, 2)), _numbers(y, "y", (1, 2))
    if t.shape[-1] != y.shape[-1] or t.ndim == 2 and t.shape != y.shape:
        raise Error(f"t has shape {t.shape} and y {y.shape}: give a time for each value, or one row of times for all")
    axes = _axes_of(axes, figsize=(7, 3.6))
    _lines(t, y, labels, axes, style)
    axes.set_xlabel("t" if xlabel is None else xlabel)
    axes.set_ylabel(ylabel)
    axes.margins(x=0)
    return axes


def phase_portrait(x: Any, y: Any, *, labels: Sequence[str] | None = None, xlabel: str | None = None,
                   ylabel: str | None = None, points: bool = False, axes: Axes | None = None, **style: Any) -> Any:
    """Each row of y over the same row of x, as a line, or with `points` as separate points (a Poincare section)."""
    xlabel, ylabel = _label(x, xlabel), _label(y, ylabel)
    x, y = _numbers(x, "x", (1, 2)), _numbers(y, "y", (1, 2))
    if x.shape != y.shape:
        raise Error(f"x has shape {x.shape} and y {y.shape}: give arrays of one shape")
    axes = _axes_of(axes, figsize=(5, 4.6))
    if points:
        style = {"linestyle": "none", "marker": "o", "markersize": 2, "markeredgewidth": 0, **style}
    _lines(x, y, labels, axes, style)
    axes.set_xlabel(xlabel)
    axes.set_ylabel(ylabel)
    return axes


def statuses(status: Any, names: Sequence[str] = (), *, axes: Axes | None = None) -> Any:
    """How many instances ended in which way: `status` has words, or numbers into `names`."""
    status = _numbers(status, "status", (1,))
    if not names:
        words, status = np.unique(status, return_inverse=True)
        names = words.tolist()
    counts = np.bincount(status, minlength=len(names))
    present = np.flatnonzero(counts)[::-1]
    axes = _axes_of(axes, figsize=(6, 0.9 + 0.35 * len(present)))
    labels = [str(names[i]).replace("_", " ") for i in present]
    bars = axes.barh(labels, counts[present], height=0.6, color=_colours[0])
    share = counts[present] / max(counts.sum(), 1)
    axes.bar_label(bars, [f" {c} ({s:.3g} %)" for c, s in zip(counts[present], 100 * share)])
    axes.set_xlabel("instances")
    axes.spines[["top", "right"]].set_visible(False)
    axes.margins(x=0.25)
    axes.set_xlim(left=0)
    axes.set_ylim(-0.6, len(present) - 0.4)
    return axes


def panels(count: int) -> Any:
    """The axes of a new figure of so many panels, at most four in a row."""
    down = -(-count // 4)
    across = -(-count // down)
    shown = _axes_of(None, figsize=(2.4 * across, 2.2 * down), nrows=down, ncols=across, squeeze=False).ravel()
    for spare in shown[count:]:
        spare.remove()
    return shown[:count]


def waterfall(loss: Any, converged: Any, *, axes: Axes | None = None, **style: Any) -> Any:
    """Losses of the starts of a fit in ascending order, a plateau for each minimum; `converged` tells for each whether
    it has arrived. Infinite losses, of starts without a solution, are counted at the axis. Further arguments go to
    matplotlib's `plot`."""
    loss, converged = _numbers(loss, "loss", (1,)), _numbers(converged, "converged", (1,)).astype(bool)
    if loss.shape != converged.shape:
        raise Error(f"loss has {loss.size} values and converged {converged.size}: give one for each start")
    order = np.argsort(loss, kind="stable")
    order = order[np.isfinite(loss[order])]
    failed = len(loss) - len(order)
    axes = _axes_of(axes, figsize=(5, 3.4))
    place = np.arange(1, len(order) + 1)
    unfinished = not converged[order].all()
    for there, label, marker in ((converged[order], "converged", "o"), (~converged[order], "out of iterations", "x")):
        if there.any():
            axes.plot(place[there], loss[order][there], **{
                "linestyle": "none", "marker": marker, "markersize": 4, "color": _colours[0 if marker == "o" else 4],
                "label": label if unfinished else None, **style})
    if unfinished:
        axes.legend(frameon=False)
    if len(order) and loss[order[0]] > 0:
        _logarithmic(axes.yaxis, axes.set_yscale)
    axes.set_xlabel("starts" + (f" ({failed} without a solution)" if failed else ""))
    axes.set_ylabel("loss")
    return axes


def profile(x: Any, loss: Any, threshold: float, *, logarithmic: bool = False, xlabel: str | None = None,
            ylabel: str | None = None, axes: Axes | None = None, **style: Any) -> Any:
    """The profile likelihood of a component: the least loss over its values x, and the threshold below which these are
    in the confidence interval. With `logarithmic`, so is a wide axis. Further arguments go to matplotlib's `plot`."""
    xlabel, ylabel = _label(x, xlabel), "loss" if ylabel is None else ylabel
    x, loss = _numbers(x, "x", (1,)), _numbers(loss, "loss", (1,))
    if x.shape != loss.shape:
        raise Error(f"x has {x.size} values and loss {loss.size}: give one loss for each value")
    axes = _axes_of(axes, figsize=(4, 3.2))
    axes.plot(x, np.where(np.isfinite(loss), loss, np.nan), **{
        "color": _colours[0], "marker": "o", "markersize": 2.5, "linewidth": 1.1, **style})
    axes.axhline(threshold, color=_colours[4], linestyle="--", linewidth=1)
    least = loss.min()
    axes.set_ylim(least - 0.1 * (threshold - least), threshold + 1.2 * (threshold - least))
    near = x[loss <= threshold + 1.2 * (threshold - least)]
    if len(near) > 1:
        axes.set_xlim(near.min(), near.max())
    if logarithmic and near.max() > 3 * near.min() > 0:
        _logarithmic(axes.xaxis, axes.set_xscale)
    axes.set_xlabel(xlabel)
    axes.set_ylabel(ylabel)
    return axes


def __dir__() -> list[str]:
    return sorted(__all__)
