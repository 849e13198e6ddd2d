# SPDX-License-Identifier: MIT
"""Profile likelihoods of a fit: the least loss at fixed values of one component, found by descents from all points of
all profiles at once."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from ..base import html, plots
from ..base.errors import Error
from .levenberg_marquardt import Descent
from .objective import from_logarithms, logarithms

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..symbolic.types import Array


class Fitted(Protocol):
    """What profiles need of a fit."""

    problem: Any
    loss: Array
    index: int
    variance: float
    best: dict[str, float]


class _Side:
    """The profile of a component in one direction from the best values: points in rows, nearest first, of what varies,
    and their losses."""

    def __init__(self, component: int, direction: int, best: Array, loss: float, limit: float) -> None:
        self.component, self.direction, self.limit = component, direction, limit
        self.points, self.loss = best[None], np.array([loss])

    @property
    def distance(self) -> Array:
        """How far the component is from its best value at each point."""
        return np.abs(self.points[:, self.component] - self.points[0, self.component])

    def at(self, distances: Array, others: Array) -> Array:
        """Points at distances, with other components as in the rows of `others`."""
        rows = np.array(np.broadcast_to(others, (len(distances), self.points.shape[1])))
        to_limit = self.points[0, self.component] + self.direction * self.limit
        rows[:, self.component] = np.where(distances >= self.limit, to_limit,
                                           self.points[0, self.component] + self.direction * distances)
        return rows

    def add(self, points: Array, loss: Array) -> None:
        """More points; of two with the same value of the component the one of less loss remains."""
        self.points, self.loss = np.concatenate([self.points, points]), np.concatenate([self.loss, loss])
        # the first point is the best whatever the loss of others
        order = 1 + np.lexsort((self.loss[1:], self.distance[1:]))
        order = np.concatenate([[0], order])
        new = np.diff(self.distance[order], prepend=-1.0) > 0
        self.points, self.loss = self.points[order[new]], self.loss[order[new]]


class Profile:
    """Profile likelihoods, as `fit.profile()` makes them: of each component, values and the least loss that the others
    reach there. Unlike intervals from the Fisher information, those from a profile hold for models that are not linear,
    and tell what the data do not bound."""

    def __init__(self, fit: Fitted, names: Sequence[str], level: float, width: float, points: int, iterations: int,
                 tolerance: float, best: Array, jacobian: Array) -> None:
        self._fit, self._width, self._iterations, self._tolerance = fit, width, iterations, tolerance
        self._problem = problem = fit.problem
        self.level = level  #: of confidence
        self._least_loss = float(fit.loss[fit.index])
        #: the loss within which values are in the confidence interval
        self.threshold = self._least_loss + 0.5 * fit.variance * width**2
        least, most = (logarithms(problem.free, end) for end in problem.bounds)
        sides, starts = [], []
        for name in names:
            i = problem.names.index(name)
            others, reach = _line(jacobian, i)
            reach = 1.5 * width * np.sqrt(fit.variance) / reach if reach > 0 else np.inf
            for direction, limit in ((-1, best[i] - least[i]), (1, most[i] - best[i])):
                side = _Side(i, direction, best, self._least_loss, limit)
                sides.append(side)
                distances = min(reach, limit) * np.arange(1, points + 1) / points if limit > 0 else np.empty(0)
                starts.append(side.at(distances, best + direction * distances[:, None] * others))
        self._descend(sides, starts)
        self._widen(sides)
        self._restart(sides)
        self._find_ends(sides)
        self._keep(names, sides)

    def _root(self, loss: Array) -> Array:
        """The square root of twice the rise of the loss, in standard deviations: linear in the distance, if the model
        is linear in its components."""
        return np.sqrt(2 * np.maximum(loss - self._least_loss, 0) / self._fit.variance)

    def _descend(self, sides: list[_Side], starts: list[Array]) -> None:
        """Descends from all starts of all sides, as one ensemble, and adds the points."""
        rows = np.concatenate(starts)
        if not rows.size:
            return
        counts = [len(s) for s in starts]
        pinned = np.repeat([side.component for side in sides], counts)
        descent = Descent(self._problem, rows, self._tolerance, pinned).run(self._iterations)
        for side, part in zip(sides, np.split(np.arange(len(rows)), np.cumsum(counts)[:-1])):
            side.add(descent.varied[part], descent.loss[part])

    def _widen(self, sides: list[_Side]) -> None:
        """Goes on outwards, twice as far each time, where the threshold was not reached, nor a bound."""
        while True:
            short = [s for s in sides if self._root(s.loss[-1]) < self._width and s.distance[-1] < s.limit]
            if not short:
                return
            self._descend(short, [s.at(s.distance[-1] * np.array([1.5, 2.0]), s.points[-1]) for s in short])

    def _restart(self, sides: list[_Side]) -> None:
        """Descends again from the other components of a neighbour, where these give less loss than was found."""
        for _ in range(5):
            starts = []
            for s in sides:
                inner, outer = s.points[:-1], s.points[np.minimum(np.arange(2, len(s.points) + 1), len(s.points) - 1)]
                starts.append(np.concatenate([s.at(s.distance[1:], inner), s.at(s.distance[1:], outer)]))
            rows = np.concatenate(starts)
            if not rows.size:
                return
            loss = self._problem.loss(from_logarithms(self._problem.free, rows))
            found = np.concatenate([np.tile(s.loss[1:], 2) for s in sides])
            better = np.split(np.isfinite(loss) & ~(loss >= found - 1e-6 * np.abs(found)),
                              np.cumsum([len(s) for s in starts])[:-1])
            if not any(b.any() for b in better):
                return
            self._descend(sides, [s[b] for s, b in zip(starts, better)])

    def _find_ends(self, sides: list[_Side]) -> None:
        """Adds points where the loss passes the threshold, by interpolation of the root of its rise, and by bisection
        every second time, as it may rise like a wall."""
        for attempt in range(24):
            open_, starts = [], []
            for s in sides:
                root = self._root(s.loss)
                beyond = np.flatnonzero(root >= self._width)
                if not beyond.size or np.abs(root - self._width).min() <= 1e-4 * self._width:
                    continue
                last = beyond[0]
                bisects = attempt % 2 or np.isinf(root[last])
                share = 0.5 if bisects else (self._width - root[last - 1]) / (root[last] - root[last - 1])
                between = s.points[last - 1] + share * (s.points[last] - s.points[last - 1])
                open_.append(s)
                starts.append(between[None])
            if not open_:
                return
            self._descend(open_, starts)

    def _end(self, side: _Side) -> float:
        root = self._root(side.loss)
        beyond = np.flatnonzero(root >= self._width)
        if not beyond.size:
            return side.direction * np.inf
        last = beyond[0]
        distances = side.distance[last - 1:last + 1]
        away = np.interp(self._width, root[last - 1:last + 1], distances) if root[last] < np.inf else distances[0]
        point = side.at(np.array([away]), side.points[0])
        return float(from_logarithms(self._problem.free, point)[0, side.component])

    def _keep(self, names: Sequence[str], sides: list[_Side]) -> None:
        self.values: dict[str, Array] = {}  #: of each component, ascending
        self.loss: dict[str, Array] = {}  #: the least loss at each of them
        #: all free components at each of them, [value, component], in the order of `fit.problem.names`
        self.components: dict[str, Array] = {}
        #: confidence intervals by name; an end is infinite if the loss stays below the threshold up to the bound
        self.intervals: dict[str, tuple[float, float]] = {}
        self.notes: list[str] = []  #: what to know of the profiles
        for name, below, above in zip(names, sides[::2], sides[1::2]):
            points = np.concatenate([below.points[:0:-1], above.points])
            self.components[name] = from_logarithms(self._problem.free, points)
            self.values[name] = self.components[name][:, below.component]
            self.loss[name] = np.concatenate([below.loss[:0:-1], above.loss])
            self.intervals[name] = self._end(below), self._end(above)
            free = self._problem.free[below.component]
            for end, bound, word in zip(self.intervals[name], (free.least, free.most), ("below", "above")):
                if np.isinf(end):
                    self.notes.append(f"the data do not bound {name} from {word}: its profile stays under the "
                                      f"threshold up to the bound {bound:g}")
        least = min(float(loss.min()) for loss in self.loss.values())
        if least < self._least_loss - 1e-3 * (self.threshold - self._least_loss):
            self.notes.append(f"a profile found the loss {least:.6g}, less than the {self._least_loss:.6g} of the fit: "
                              "fit from more starts=")

    def plot(self, *, axes: Any = None, **style: Any) -> Any:
        """Draws a panel for each component, into a new figure, or into as many `axes`: the loss over its values, and
        the threshold. Further arguments go to matplotlib's `plot`. Returns the axes in an array."""
        if axes is None:
            axes = plots.panels(len(self.values))
        if np.size(axes) != len(self.values):
            raise Error(f"there are {np.size(axes)} axes for the profiles of {', '.join(self.values)}: give one for "
                        "each")
        logarithmic = {f.name: f.log for f in self._problem.free}
        for i, (name, into) in enumerate(zip(self.values, np.ravel(axes))):
            plots.profile(self.values[name], self.loss[name], self.threshold, logarithmic=logarithmic[name],
                          xlabel=name, ylabel="loss" if i == 0 else "", axes=into, **style)
        return np.ravel(axes)

    def __str__(self) -> str:
        width = max(map(len, self.values))
        lines = [f"{name:{width}}  {self._fit.best[name]:.6g}  [{low:.6g}, {high:.6g}]"
                 for name, (low, high) in self.intervals.items()]
        return "\n".join([*lines, *(f"note: {note}" for note in self.notes)])

    def _repr_html_(self) -> str:
        rows = [(name, f"{self._fit.best[name]:.6g}", f"{low:.6g}", f"{high:.6g}")
                for name, (low, high) in self.intervals.items()]
        return (html.columns(["", "best", "from", "to"], rows)
                + html.paragraphs(f"note: {note}" for note in self.notes))

    __repr__ = __str__


def _line(jacobian: Array, component: int) -> tuple[Array, float]:
    """Along which line the least loss lies at fixed values of a component, if the model is linear: the change of all
    components per change of this one, and that of the residuals; 0 where the others make up for it."""
    along = jacobian[:, component]
    rest = np.delete(jacobian, component, axis=1)
    change = np.linalg.lstsq(rest, -along, rcond=1e-7)[0] if rest.size else np.empty(0)
    rise = float(np.linalg.norm(along + rest @ change))
    return np.insert(change, component, 1.0), rise if rise > 1e-7 * np.linalg.norm(along) else 0.0
