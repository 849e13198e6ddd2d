# SPDX-License-Identifier: MIT
"""Designs of global sensitivity analyses: sets of parameters and initial states within bounds, for `my.study`,
`my.solve` and `my.batched`, and the indices that results of all sets give: by Sobol, of variances, by Morris, of
elementary effects, and partial rank correlations of a Latin hypercube.

Sets are in the order of the package SALib, whose analyses take them too."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.errors import Error, UnknownName
from ..models.components import by_component
from ..sweeps.inputs import by_name, whole
from ..sweeps.sweep import Sweep, zip as together
from .objective import Free, from_logarithms, logarithms

if TYPE_CHECKING:
    import numpy.typing as npt

    from ..symbolic.types import Array, ByComponent

__all__ = ["latin_hypercube", "morris", "sobol"]


class Indices:
    """What a design tells of results: `indices[measure]` has a value by name of component, a number, or an array of the
    shape of the results of one set."""

    def __init__(self, measures: dict[str, dict[str, Any]], notes: list[str]) -> None:
        self.measures = measures  #: all of them, by name
        self.notes = notes  #: what to know of them

    def __getitem__(self, measure: str) -> dict[str, Any]:
        if measure not in self.measures:
            raise UnknownName(f"there is no '{measure}': there are {', '.join(self.measures)}")
        return self.measures[measure]

    def __str__(self) -> str:
        names = list(next(iter(self.measures.values())))
        width = max(map(len, names))
        lines = [" " * width + "".join(f"  {measure:>14}" for measure in self.measures)]
        for name in names:
            numbers = [of[name] for of in self.measures.values()]
            shown = [f"{number:14.4g}" if np.ndim(number) == 0 else f"{str(np.shape(number)):>14}"
                     for number in numbers]
            lines.append(f"{name:{width}}" + "".join(f"  {text}" for text in shown))
        return "\n".join([*lines, *(f"note: {note}" for note in self.notes)])

    __repr__ = __str__


class Design:
    """Sets of values of components within bounds, made by the functions of `my.designs`."""

    def __init__(self, free: list[Free], places: Array, rows: int,
                 measure: Callable[[Array, Array], dict[str, Array]]) -> None:
        self.names = [f.name for f in free]  #: of the components
        least, most = (logarithms(free, np.array([getattr(f, end) for f in free])) for end in ("least", "most"))
        self.places = places  #: of the sets within the bounds, from 0 to 1, [set, component]
        self.points: Array = from_logarithms(free, least + places * (most - least))  #: the sets, [set, component]
        self._rows, self._measure = rows, measure

    def __len__(self) -> int:
        return len(self.points)

    @property
    def sweep(self) -> Sweep:
        """The sets as the sweep of `my.study` or `my.solve`."""
        return together({name: np.ascontiguousarray(self.points[:, i]) for i, name in enumerate(self.names)})

    @property
    def problem(self) -> dict[str, Any]:
        """The description that SALib's analyses want, of `places`, all of which are from 0 to 1."""
        return {"num_vars": len(self.names), "names": list(self.names), "bounds": [[0.0, 1.0] for _ in self.names]}

    def indices(self, results: npt.ArrayLike) -> Indices:
        """Indices from results: a number, or an array, for each set. Sets whose result is not finite, as of instances
        that failed, are left out together with those they are compared with, and a note says how many."""
        values = np.asarray(results, float)
        if values.shape[:1] != (len(self),):
            raise Error(f"the results have the shape {values.shape}: give one for each of the {len(self)} sets of the "
                        "design, along the first axis")
        flat = values.reshape(-1, self._rows, int(np.prod(values.shape[1:])))
        kept = np.isfinite(flat).all(axis=(1, 2))
        lost = f"{np.sum(~kept)} of {kept.size} parts of the design"
        if kept.sum() < 2:
            raise Error(f"{lost} have results that are not finite: give narrower bounds, or look at the statuses of "
                        "the instances")
        notes = [] if kept.all() else [f"{lost} were left out, as they have results that are not finite"]
        measures = {measure: {name: found[i].reshape(values.shape[1:])[()] for i, name in enumerate(self.names)}
                    for measure, found in self._measure(flat[kept], kept).items()}
        return Indices(measures, notes)

    def __repr__(self) -> str:
        return f"<myriad_ode.designs.Design of {len(self)} sets of {', '.join(self.names)}>"


def hypercube(count: int, components: int, random: np.random.Generator) -> Array:
    """Points from 0 to 1 of a Latin hypercube, [point, component]: each of `count` parts of each range has one."""
    parts = np.stack([random.permutation(count) for _ in range(components)], axis=1)
    return (parts + random.random(parts.shape)) / count


def _bounded(bounds: ByComponent) -> list[Free]:
    free = [Free(name, given) for name, given in by_component(
        by_name(bounds, "bounds", "{k: (0.1, 10)}"), "the bounds").items()]
    if not free:
        raise Error("the bounds name no component: give those that vary, as in {k: (0.1, 10)}")
    return free


def sobol(bounds: ByComponent, size: int, *, seed: int = 0) -> Design:
    """A design for Sobol's indices, by scrambled Sobol points of the package SciPy: `size` (k + 2) sets of k
    components.

    bounds  `{k: (0.1, 10)}`, uniform within; `{k: (0.1, 10, "log")}`: the logarithm is
    size    a power of two
    seed    of the scrambling

    Measures: "first", the share of the variance of the results that goes with a component alone (Saltelli and others
    2010), "total", that with it and all its interactions (Jansen 1999), and the standard errors of both from resampled
    points, "first_error" and "total_error"."""
    free, count = _bounded(bounds), whole(size, "size")
    if count < 2 or count & (count - 1):
        raise Error(f"size is {count}: Sobol points are even in powers of two, give one, as 1024")
    try:
        from scipy.stats import qmc
    except ImportError:
        raise Error("Sobol points need the package scipy: `pip install scipy`") from None
    source = "rng" if "rng" in inspect.signature(qmc.Sobol).parameters else "seed"
    k = len(free)
    points = qmc.Sobol(2 * k, **{source: np.random.default_rng(seed)}).random(count)
    one, other = points[:, :k], points[:, k:]
    sets = np.repeat(one[:, None], k + 2, axis=1)  # the first, it with each component of the other, and the other
    sets[:, range(1, k + 1), range(k)] = other
    sets[:, -1] = other

    def estimate(values: Array) -> tuple[Array, Array]:
        values, variance = values - values.mean(axis=(0, 1)), values[:, [0, -1]].var(axis=(0, 1))
        change = values[:, 1:-1] - values[:, :1]
        with np.errstate(divide="ignore", invalid="ignore"):
            return (values[:, -1:] * change).mean(axis=0) / variance, 0.5 * (change**2).mean(axis=0) / variance

    def measure(values: Array, kept: Array) -> dict[str, Array]:
        random = np.random.default_rng(seed)
        again = [estimate(values[random.integers(len(values), size=len(values))]) for _ in range(100)]
        errors = np.std(np.array(again), axis=0, ddof=1)
        first, total = estimate(values)
        return {"first": first, "total": total, "first_error": errors[0], "total_error": errors[1]}

    return Design(free, sets.reshape(-1, k), k + 2, measure)


def morris(bounds: ByComponent, trajectories: int, *, levels: int = 4, seed: int = 0) -> Design:
    """A design for Morris' screening: k + 1 sets of k components for each trajectory, along which one component after
    the other changes, in a random order and direction, by more than half of its range.

    bounds        as of `sobol`
    trajectories  20 or more
    levels        an even number, into so many places ranges are divided
    seed          of the trajectories

    Measures of the elementary effects, changes of results over those of components as parts of their ranges: "mean",
    "mean_size", the mean of their absolute values (Campolongo and others 2007), and "deviation"; "size_error" is the
    standard error of "mean_size". A large deviation means that a component interacts, or is not linear."""
    free, count, places = _bounded(bounds), whole(trajectories, "trajectories"), whole(levels, "levels")
    if count < 2:
        raise Error(f"trajectories is {count}: give at least two")
    if places < 2 or places % 2:
        raise Error(f"levels is {places}: give an even number, as 4")
    k, random, step = len(free), np.random.default_rng(seed), places / (2 * (places - 1))
    order = np.stack([random.permutation(k) for _ in range(count)])  # the number of the change of each component
    rises = random.random((count, k)) < 0.5
    low = random.integers(places // 2, size=(count, k)) / (places - 1)
    changed = np.arange(k + 1)[None, :, None] > order[:, None, :]
    sets = low[:, None] + step * (changed == rises[:, None])

    def measure(values: Array, kept: Array) -> dict[str, Array]:
        change = np.take_along_axis(np.diff(values, axis=1), order[kept][:, :, None], axis=1)
        effects = change / np.where(rises[kept], step, -step)[:, :, None]
        size = np.abs(effects)
        return {"mean": effects.mean(axis=0), "mean_size": size.mean(axis=0), "deviation": effects.std(axis=0, ddof=1),
                "size_error": size.std(axis=0, ddof=1) / np.sqrt(len(size))}

    return Design(free, sets.reshape(-1, k), k + 1, measure)


def latin_hypercube(bounds: ByComponent, size: int, *, seed: int = 0) -> Design:
    """A Latin hypercube: each of `size` equal parts of each range has one set.

    bounds  as of `sobol`
    size    the number of sets
    seed    of their places

    Measure: "rank_correlation", the correlation of the ranks of a component and of the results, less what the ranks of
    other components explain (Marino and others 2008): 1 or -1 where the result rises or falls with it alone, 0 where
    another component explains all. It tells of monotonic dependence only."""
    free, count = _bounded(bounds), whole(size, "size")
    k = len(free)
    if count < k + 2:
        raise Error(f"size is {count}: give more than {k + 1} sets of {k} components")
    places = hypercube(count, k, np.random.default_rng(seed))

    def measure(values: Array, kept: Array) -> dict[str, Array]:
        ranks = _centred_ranks(places[kept])
        of_values = _centred_ranks(values[:, 0])
        found = np.empty((k, values.shape[2]))
        for i in range(k):
            others = np.linalg.qr(np.delete(ranks, i, axis=1))[0]
            a, b = (r - others @ (others.T @ r) for r in (ranks[:, i], of_values))
            size_of_b, before = np.linalg.norm(b, axis=0), np.linalg.norm(of_values, axis=0)
            explained = size_of_b <= 1e-9 * before
            found[i] = np.where(explained, 0.0, a @ b / np.where(explained, 1.0, np.linalg.norm(a) * size_of_b))
            found[i, before == 0] = np.nan  # results that are all equal
        return {"rank_correlation": found}

    return Design(free, places, 1, measure)


def _centred_ranks(values: Array) -> Array:
    """Ranks in each column, less their mean; equal values share the mean of theirs."""
    ranks = np.empty(values.shape)
    for i, column in enumerate(values.T):
        _, which, counts = np.unique(column, return_inverse=True, return_counts=True)
        ranks[:, i] = (np.cumsum(counts) - (counts - 1) / 2)[which]
    return ranks - ranks.mean(axis=0)


def __dir__() -> list[str]:
    return sorted(__all__)
