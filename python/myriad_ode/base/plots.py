# SPDX-License-Identifier: MIT
"""The pictures that a sweep is usually looked at in, by matplotlib: bifurcation diagram, map over two parameters, time
series, bands of percentiles, phase portrait, statuses; and those of a fit: data and model, waterfall, and profile
likelihood. The functions draw arrays, of NumPy or xarray, into `axes`, or a new figure, and return the axes. `run.plot`
draws the results of a run by name. The program `myriad` draws by a copy of this file.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from .errors import Error
from .plot_parts import (are_classes, axes_of, checked_quantiles, classes_of, colours, colour_scale, distinct, edges,
                         is_geometric, label_of, legend, logarithmic as make_logarithmic, look, numbers)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# What is returned is any to type checkers: matplotlib says of axes that their figure may be one which cannot be saved.

__all__ = ["bands", "bifurcation", "data_and_model", "parameter_map", "phase_portrait", "profile", "statuses",
           "time_series", "waterfall"]

_many_points = 300_000  # from which on a picture shows their density


def bifurcation(x: Any, y: Any, *, by: Any = None, xlabel: str | None = None, ylabel: str | None = None,
                bylabel: str | None = None, axes: Axes | None = None, **style: Any) -> Any:
    """Points (x, y) of a bifurcation diagram: x has one value per instance, y a row of values, one for each phase.
    `by` has a word or a number for each instance, which colours tell apart. Further arguments go to matplotlib's
    `plot`. Many points are drawn as their density, if there is no `by`."""
    xlabel, ylabel, bylabel = label_of(x, xlabel), label_of(y, ylabel), label_of(by, bylabel)
    x, y = numbers(x, "x", (1,)), numbers(y, "y", (1, 2))
    if len(x) != len(y):
        raise Error(f"x has {len(x)} values and y {len(y)} rows: give one row per instance")
    by = None if by is None else numbers(by, "by", (1,))
    if by is not None and len(by) != len(x):
        raise Error(f"by has {len(by)} values and x {len(x)}: give one per instance")
    y = y.reshape(len(x), y.shape[1] if y.ndim == 2 else 1)
    axes = axes_of(axes, figsize=(7, 4.2))
    across, up = np.repeat(x, y.shape[1]), y.ravel()
    shown = np.isfinite(across) & np.isfinite(up)
    across, up = across[shown], up[shown]
    geometric = is_geometric(np.unique(x[np.isfinite(x)]))
    usual = {"linestyle": "none", "marker": "o", "markersize": 1.2 if len(up) < 20_000 else 0.5, "markeredgewidth": 0,
             "rasterized": True}
    if by is not None:
        _by_colour(axes, across, up, np.repeat(by, y.shape[1])[shown], bylabel, look(usual, style))
    elif len(up) > _many_points and not style:
        box = axes.get_window_extent()
        rows = max(int(box.height), 200)
        values = np.unique(across)
        columns = min(max(int(box.width), 200), len(values))  # no column without instances
        borders = np.geomspace(values[0], values[-1], columns + 1) if geometric else columns
        count, right, top = np.histogram2d(across, up, bins=[borders, rows])
        darkness = np.ma.masked_equal(np.sqrt(count / count.max(axis=1, keepdims=True).clip(1)), 0)
        axes.pcolormesh(right, top, darkness.T, cmap="Blues", vmin=-0.6, vmax=0.9, rasterized=True)
    else:
        axes.plot(across, up, **look({**usual, "color": colours[0]}, style))
    axes.margins(x=0)
    if geometric:
        make_logarithmic(axes.xaxis, axes.set_xscale)
    axes.set_xlabel(xlabel)
    axes.set_ylabel(ylabel)
    return axes


def _by_colour(axes: Axes, x: np.ndarray, y: np.ndarray, by: np.ndarray, label: str, style: dict[str, Any]) -> None:
    """Points in the colours of their classes, with a legend; or in those of a scale, if these are many numbers."""
    if by.dtype.kind in "fiu" and len(distinct(by)) > len(colours):
        points = axes.scatter(x, y, c=by, s=style["markersize"]**2, linewidths=0, rasterized=True,
                              **colour_scale(by, style))
        axes.figure.colorbar(points, ax=axes, label=label)
        return
    classes = classes_of(by)
    for i, (name, colour) in enumerate(zip(classes.labels, classes.colours)):
        axes.plot(x[classes.places == i], y[classes.places == i], **{"color": colour, "label": name, **style})
    legend(axes, label or None, markerscale=6 / style["markersize"])


def parameter_map(x: Any, y: Any, z: Any, *, xlabel: str | None = None, ylabel: str | None = None,
                  zlabel: str | None = None, names: Sequence[str] | Mapping[int, str] | None = None,
                  axes: Axes | None = None, **style: Any) -> Any:
    """A quantity z over two parameters in colour: z has shape (len(x), len(y)). NaN and what is masked is left grey.
    Words, truth values and few whole numbers are classes, each with a colour of its own; `names` says what whole
    numbers stand for. Of more than eight classes the rarest ones share a colour, as the bar says. Other numbers of both
    signs have diverging colours around zero. Further arguments go to matplotlib's `pcolormesh`."""
    xlabel, ylabel, zlabel = label_of(x, xlabel), label_of(y, ylabel), label_of(z, zlabel)
    x, y, z = numbers(x, "x", (1,)), numbers(y, "y", (1,)), numbers(z, "z", (2,))
    if z.shape != (len(x), len(y)):
        raise Error(f"z has shape {z.shape} for {len(x)} values of x and {len(y)} of y: give it the shape "
                    f"({len(x)}, {len(y)})")
    if not z.size:
        raise Error(f"there are {len(x)} values of x and {len(y)} of y: a map takes at least one of each")
    axes = axes_of(axes, figsize=(6.4, 4.8))
    axes.set_facecolor("0.85")
    if names is None and not are_classes(z):
        shown = axes.pcolormesh(edges(x), edges(y), np.ma.masked_invalid(z).T, **look(
            {"rasterized": True, **colour_scale(z, style)}, style, "collections.QuadMesh"))
        bar = axes.figure.colorbar(shown, ax=axes, label=zlabel)
    else:
        from matplotlib import colormaps
        from matplotlib.colors import BoundaryNorm, ListedColormap
        classes = classes_of(z, names)
        count = len(classes.labels)
        palette = ListedColormap(classes.colours)
        if (cmap := style.pop("cmap", None)) is not None:
            palette = ListedColormap(colormaps.get_cmap(cmap)(np.linspace(0, 1, count)))
        shown = axes.pcolormesh(edges(x), edges(y), classes.places.T, **look(
            {"cmap": palette, "norm": BoundaryNorm(np.arange(count + 1) - 0.5, count), "rasterized": True}, style,
            "collections.QuadMesh"))
        bar = axes.figure.colorbar(shown, ax=axes, ticks=np.arange(count), label=zlabel)
        bar.ax.set_yticklabels(classes.labels)
        bar.ax.minorticks_off()
    for axis, set_scale, values in ((axes.xaxis, axes.set_xscale, x), (axes.yaxis, axes.set_yscale, y)):
        if is_geometric(values):
            make_logarithmic(axis, set_scale)
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
        axes.plot(x[i], y[i], **look({"color": colours[i % len(colours)], "linewidth": 1.1,
                                      "label": None if labels is None else labels[i]}, style))
    if labels is not None and 1 < len(y) <= 10:
        legend(axes)


def time_series(t: Any, y: Any, *, labels: Sequence[str] | None = None, xlabel: str | None = None,
                ylabel: str | None = None, axes: Axes | None = None, **style: Any) -> Any:
    """Each row of y over time: t has a row for each, or is the same for all."""
    ylabel = label_of(y, ylabel)
    t, y = numbers(t, "t", (1, 2)), numbers(y, "y", (1, 2))
    if t.shape[-1] != y.shape[-1] or t.ndim == 2 and t.shape != y.shape:
        raise Error(f"t has shape {t.shape} and y {y.shape}: give a time for each value, or one row of times for all")
    axes = axes_of(axes, figsize=(7, 3.6))
    _lines(t, y, labels, axes, style)
    axes.set_xlabel("t" if xlabel is None else xlabel)
    axes.set_ylabel(ylabel)
    axes.margins(x=0)
    return axes


def bands(t: Any, y: Any, quantiles: Sequence[float], *, within: Any = None, xlabel: str | None = None,
          ylabel: str | None = None, axes: Axes | None = None, **style: Any) -> Any:
    """Quantiles over time: y has a row for each of `quantiles`, as [0.05, 0.5, 0.95], in ascending order. Of equally
    many on either side, each two that belong together bound a band, and one in the middle is a line. Dotted lines are
    `within`, the lower and upper values between which each quantile may be, both of y's shape
    (`my.reduce.confidence_levels`). Further arguments go to matplotlib's `fill_between`."""
    ylabel = label_of(y, ylabel)
    t, y, of = numbers(t, "t", (1,)), numbers(y, "y", (2,)), checked_quantiles(quantiles)
    if y.shape != (len(of), len(t)):
        raise Error(f"y has shape {y.shape} for {of.size} quantiles and {len(t)} times: give it the shape "
                    f"({of.size}, {len(t)})")
    axes = axes_of(axes, figsize=(7, 3.6))
    from matplotlib.colors import to_rgb
    colour, pairs = np.array(to_rgb(style.pop("color", colours[0]))), len(of) // 2
    for i in range(pairs):
        tint = 1 - (1 - colour) * 0.75 * (i + 1) / (pairs + 1)  # not transparent, so that the legend has it too
        axes.fill_between(t, y[i], y[-1 - i], **look(
            {"facecolor": tint, "linewidth": 0, "label": f"{100 * (of[-1 - i] - of[i]):.4g} % of all"}, style,
            "collections.PolyCollection"))
    if len(of) % 2:
        axes.plot(t, y[pairs], color=colour, linewidth=1.3, label="median")
    if within is not None:
        bounds = numbers(within, "within", (3,))
        if bounds.shape != (2, *y.shape):
            raise Error(f"within has shape {bounds.shape}: give lower and upper values of y, of shape {(2, *y.shape)}")
        axes.plot(t, bounds.reshape(-1, len(t)).T, color=colour, linewidth=0.8, linestyle=":")
    legend(axes)
    axes.set_xlabel("t" if xlabel is None else xlabel)
    axes.set_ylabel(ylabel)
    axes.margins(x=0)
    return axes


def phase_portrait(x: Any, y: Any, *, labels: Sequence[str] | None = None, xlabel: str | None = None,
                   ylabel: str | None = None, points: bool = False, axes: Axes | None = None, **style: Any) -> Any:
    """Each row of y over the same row of x, as a line, or with `points` as separate points (a Poincare section)."""
    xlabel, ylabel = label_of(x, xlabel), label_of(y, ylabel)
    x, y = numbers(x, "x", (1, 2)), numbers(y, "y", (1, 2))
    if x.shape != y.shape:
        raise Error(f"x has shape {x.shape} and y {y.shape}: give arrays of one shape")
    axes = axes_of(axes, figsize=(5, 4.6))
    if points:
        style = look({"linestyle": "none", "marker": "o", "markersize": 2, "markeredgewidth": 0}, style)
    _lines(x, y, labels, axes, style)
    axes.set_xlabel(xlabel)
    axes.set_ylabel(ylabel)
    return axes


def statuses(status: Any, names: Sequence[str] = (), *, axes: Axes | None = None, **style: Any) -> Any:
    """How many instances ended in which way: `status` has words, or numbers into `names`. Further arguments go to
    matplotlib's `barh`."""
    status = numbers(status, "status", (1,))
    if not names:
        words, status = np.unique(status, return_inverse=True)
        names = words.tolist()
    counts = np.bincount(status, minlength=len(names))
    present = np.flatnonzero(counts)[::-1]
    axes = axes_of(axes, figsize=(6, 0.9 + 0.35 * len(present)))
    labels = [str(names[i]).replace("_", " ") for i in present]
    bars = axes.barh(labels, counts[present], **look({"height": 0.6, "color": colours[0]}, style, "patches.Rectangle"))
    share = counts[present] / max(counts.sum(), 1)
    axes.bar_label(bars, [f" {c} ({s:.3g} %)" for c, s in zip(counts[present], 100 * share)])
    axes.set_xlabel("instances")
    axes.spines[["top", "right"]].set_visible(False)
    axes.margins(x=0.25)
    axes.set_xlim(left=0)
    axes.set_ylim(-0.6, len(present) - 0.4)
    return axes


def panels(count: int, beside: float = 0.0) -> Any:
    """The axes of a new figure of so many panels, at most four in a row, and room for what is `beside` them, in
    inches."""
    down = -(-count // 4)
    across = -(-count // down)
    size = (4.2, 3.0) if count == 1 else (2.4 * across, 2.2 * down)
    shown = axes_of(None, figsize=(size[0] + beside, size[1]), nrows=down, ncols=across, squeeze=False).ravel()
    for spare in shown[count:]:
        spare.remove()
    return shown[:count]


def data_and_model(t: Any, data: Any, t_model: Any, model: Any, *, sigma: Any = None, side: Any = None,
                   data_color: Any = "black", xlabel: str | None = None, ylabel: str | None = None,
                   axes: Axes | None = None, **style: Any) -> Any:
    """Data over a model: points at times t, with `sigma` as error bars, before the line of the model at times t_model,
    which may be many more. Where `side` is not 0, data are limits, and values below (-1) or above (1): triangles that
    point there. Further arguments go to matplotlib's `plot` of the line."""
    ylabel = label_of(data, ylabel)
    t, data = numbers(t, "t", (1,)), numbers(data, "data", (1,))
    t_model, model = numbers(t_model, "t_model", (1,)), numbers(model, "model", (1,))
    if t.shape != data.shape or t_model.shape != model.shape:
        raise Error(f"there are {t.size} times for {data.size} data and {t_model.size} for {model.size} values of the "
                    "model: give one for each")
    side = np.zeros(t.shape) if side is None else numbers(side, "side", (1,))
    axes = axes_of(axes, figsize=(5, 3.2))
    axes.plot(t_model, model, **look({"color": colours[0], "linewidth": 1.3, "zorder": 2}, style))
    of = {"linestyle": "none", "color": data_color, "zorder": 3}
    there = side == 0
    bars = None if sigma is None else np.broadcast_to(sigma, t.shape)[there]
    axes.errorbar(t[there], data[there], yerr=bars, marker="o", markersize=3.5, elinewidth=0.8, **of)
    for beyond, marker in ((-1, "v"), (1, "^")):
        cut = side == beyond
        if cut.any():
            axes.plot(t[cut], data[cut], marker=marker, markersize=6, markerfacecolor="none", **of)
    axes.set_xlabel("t" if xlabel is None else xlabel)
    axes.set_ylabel(ylabel)
    return axes


def _plateaus(loss: np.ndarray, tolerance: float) -> np.ndarray:
    """Ascending losses, those that are equal within the tolerance as the least of them."""
    level = loss.copy()
    for i in range(1, len(loss)):
        if loss[i] - level[i - 1] <= tolerance:
            level[i] = level[i - 1]
    return level


def waterfall(loss: Any, converged: Any, *, tolerance: float | None = None, axes: Axes | None = None,
              **style: Any) -> Any:
    """Losses of the starts of a fit in ascending order, a plateau for each minimum; `converged` tells for each whether
    it has arrived. Losses within `tolerance` are equal, by default a thousandth of the least one. Infinite losses, of
    starts without a solution, are counted at the axis. Further arguments go to matplotlib's `plot`."""
    loss, converged = numbers(loss, "loss", (1,)), numbers(converged, "converged", (1,)).astype(bool)
    if loss.shape != converged.shape:
        raise Error(f"loss has {loss.size} values and converged {converged.size}: give one for each start")
    order = np.argsort(loss, kind="stable")
    order = order[np.isfinite(loss[order])]
    failed = len(loss) - len(order)
    axes = axes_of(axes, figsize=(5, 3.4))
    place = np.arange(1, len(order) + 1)
    if tolerance is None:
        tolerance = 1e-3 * abs(float(loss[order[0]])) if len(order) else 0.0
    level = _plateaus(loss[order].astype(float), tolerance)
    unfinished = not converged[order].all()
    for there, label, marker in ((converged[order], "converged", "o"), (~converged[order], "out of iterations", "x")):
        if there.any():
            axes.plot(place[there], level[there], **look({
                "linestyle": "none", "marker": marker, "markersize": 4, "color": colours[0 if marker == "o" else 4],
                "label": label if unfinished else None}, style))
    if unfinished:
        legend(axes)
    if len(level) and level[-1] > 3 * level[0] > 0:
        make_logarithmic(axes.yaxis, axes.set_yscale)
    axes.set_xlabel("starts" + (f" ({failed} without a solution)" if failed else ""))
    axes.set_ylabel("loss")
    return axes


def profile(x: Any, loss: Any, threshold: float, *, logarithmic: bool = False, xlabel: str | None = None,
            ylabel: str | None = None, axes: Axes | None = None, **style: Any) -> Any:
    """The profile likelihood of a component: the least loss over its values x, and the threshold below which these are
    in the confidence interval. With `logarithmic`, so is a wide axis. Further arguments go to matplotlib's `plot`."""
    xlabel, ylabel = label_of(x, xlabel), "loss" if ylabel is None else ylabel
    x, loss = numbers(x, "x", (1,)), numbers(loss, "loss", (1,))
    if x.shape != loss.shape:
        raise Error(f"x has {x.size} values and loss {loss.size}: give one loss for each value")
    axes = axes_of(axes, figsize=(4, 3.2))
    axes.plot(x, np.where(np.isfinite(loss), loss, np.nan), **look({
        "color": colours[0], "marker": "o", "markersize": 2.5, "linewidth": 1.1}, style))
    axes.axhline(threshold, color=colours[4], linestyle="--", linewidth=1)
    least = loss.min()
    axes.set_ylim(least - 0.1 * (threshold - least), threshold + 1.2 * (threshold - least))
    near = x[loss <= threshold + 1.2 * (threshold - least)]
    if len(near) > 1:
        axes.set_xlim(near.min(), near.max())
    if logarithmic and near.max() > 3 * near.min() > 0:
        make_logarithmic(axes.xaxis, axes.set_xscale)
    axes.set_xlabel(xlabel)
    axes.set_ylabel(ylabel)
    return axes


def __dir__() -> list[str]:
    return sorted(__all__)
