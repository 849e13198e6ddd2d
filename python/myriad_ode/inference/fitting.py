# SPDX-License-Identifier: MIT
"""Fits of a model to data by the method of Levenberg and Marquardt from many starts, all of which are integrated as one
ensemble in every iteration; what the result is worth."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Generic, TypeVar

import numpy as np

from ..base import html, plots
from ..base.errors import Error
from ..base.plot_parts import legend, several_colours
from ..models.components import by_component, listed, name_of, unknown
from ..results.report import Interrupted
from ..results.run import Run
from ..sweeps.inputs import whole
from .designs import hypercube
from .experiments import Experiment
from .least_squares import LeastSquares
from .levenberg_marquardt import Descent, status_names
from .likelihood import Likelihood
from .noise_models import NoiseModel
from .objective import Objective, from_logarithms, logarithms
from .profile import Profile
from .student_t import student_quantile

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..models.any_model import AnyModel
    from ..symbolic.types import Array, ByComponent, SomeComponents

__all__ = ["Fit", "fit"]

SomeObjective = TypeVar("SomeObjective", bound=Objective)


class Fit(Generic[SomeObjective]):
    """The outcome of `fit`. Arrays have one value for each start, in the order of the starts; what has no start is of
    the best one."""

    def __init__(self, problem: SomeObjective, descent: Descent, starts: Array, iterations: int) -> None:
        self.problem = problem  #: what was minimised: its `LeastSquares`, or another `Objective`
        values = from_logarithms(problem.free, descent.varied)
        #: of `my.fit` half the sum of squares of (model - data) / sigma; infinite: no solution
        self.loss: Array = descent.loss
        #: "converged", "iterations" if there were too few, "failed", "interrupted" by Ctrl-C
        self.status = [status_names[s] for s in descent.state]
        self.iterations: Array = descent.iterations  #: that each start took
        self.starts = _by_name(problem, from_logarithms(problem.free, starts))  #: where each began, by name
        self.values = _by_name(problem, values)  #: where each ended, by name
        self.index = int(np.argmin(descent.loss))  #: of the best start
        if not np.isfinite(descent.loss[self.index]):
            raise Error(problem.why_none())
        self.best = {name: float(of[self.index]) for name, of in self.values.items()}  #: the best values, by name
        residuals, self._jacobian = descent.best
        self.residuals: Array = residuals  #: in the order of `problem.labels`
        self._limits = iterations, descent.tolerance
        self._assess(descent)

    def _assess(self, descent: Descent) -> None:
        """Fisher information, standard errors, and what the fit cannot tell."""
        problem, free = self.problem, self.problem.free
        jacobian = self._jacobian
        self._varied = varied = descent.varied[self.index]
        length = np.linalg.norm(jacobian, axis=0)
        #: names of those on which no result that was compared depends
        self.without_influence = [f.name for f, size in zip(free, length) if size == 0]
        #: names of those that ended at a bound
        self.at_bound = [f.name for f, u, least, most in zip(free, varied, descent.least[0], descent.most[0])
                         if (u == least or u == most) and f.name not in self.without_influence]
        degrees = jacobian.shape[0] - (len(free) - len(self.without_influence))
        self._degrees = np.inf if problem.has_sigma else degrees
        #: the variance of the residuals, by which information is divided: 1 if `sigma` was given
        self.variance = 1.0 if problem.has_sigma else 2 * self.loss[self.index] / degrees if degrees > 0 else np.nan
        information = jacobian.T @ jacobian
        inner = np.array([self.best[f.name] if f.log else 1.0 for f in free])
        with np.errstate(divide="ignore", invalid="ignore"):
            #: J^T J / variance by the free components themselves, in the order of `problem.names`
            self.fisher_information: Array = information / np.outer(inner, inner) / self.variance
        covariance, undetermined = self._inverse(length)
        self._deviations = np.sqrt(np.diag(covariance))  # of what varies
        self.covariance: Array = covariance * np.outer(inner, inner)  #: of the free components; NaN: not determined
        self.standard_errors = _by_name(problem, np.sqrt(np.diag(self.covariance)))  #: by name
        self.notes: list[str] = self._notes(undetermined, degrees)  #: what to know of the result

    def _inverse(self, length: Array) -> tuple[Array, list[str]]:
        """The covariance of what varies, from the columns of the Jacobian and their length; and the names of those that
        the data determine in combinations alone."""
        free, jacobian, determined = self.problem.free, self._jacobian, length > 0
        covariance = np.full((len(free), len(free)), np.nan)
        if not determined.any():
            return covariance, []
        unit = jacobian[:, determined] / length[determined]
        _, singular, vectors = np.linalg.svd(unit, full_matrices=False)
        rank = int(np.sum(singular > 1e-7 * singular[0]))
        if rank < determined.sum():
            names = [f.name for f, d in zip(free, determined) if d]
            lost = np.linalg.svd(unit)[2][rank:]
            return covariance, [n for n, w in zip(names, np.abs(lost).max(axis=0)) if w > 0.1]
        inverse = (vectors.T / singular**2) @ vectors * self.variance
        covariance[np.ix_(determined, determined)] = inverse / np.outer(length[determined], length[determined])
        return covariance, []

    def _notes(self, undetermined: Sequence[str], degrees: int) -> list[str]:
        notes: list[str] = []
        if self.without_influence:
            notes.append(f"no result that is compared with data depends on {', '.join(self.without_influence)}: "
                         "leave out of free=, or compare something else")
        if undetermined:
            notes.append(f"the data determine combinations of {', '.join(undetermined)} alone, and not each of "
                         "them: fix one, or add data")
        if self.at_bound:
            notes.append(f"the fit ended at a bound of {', '.join(self.at_bound)}, where confidence intervals do "
                         "not hold: widen the bounds, or think why")
        interrupted = self.status.count("interrupted")
        if interrupted:
            notes.append(f"Ctrl-C ended the fit while {interrupted} of {len(self.status)} starts were on their "
                         "way: starts=fit.values goes on from here")
        elif self.status[self.index] != "converged":
            notes.append("the best start was still on its way: give more iterations=")
        failed = self.status.count("failed")
        if failed:
            notes.append(f"{failed} of {len(self.status)} starts had no solution up to the last time of the data")
        if degrees <= 0 and not self.problem.has_sigma:
            notes.append("there are no more data than free components: give sigma= for confidence intervals")
        return notes

    def _width(self, level: float) -> float:
        """Half the width of a confidence interval, in standard errors."""
        if not 0 < level < 1:
            raise Error(f"the level of confidence is {level!r}: give a number between 0 and 1, as 0.95")
        return student_quantile((1 + level) / 2, self._degrees)

    def confidence(self, level: float = 0.95) -> dict[str, tuple[float, float]]:
        """Confidence intervals by name, from the Fisher information: of the logarithm, where that varied. They hold for
        models that are nearly linear within them, or else many data, as `profile` shows; NaN where the data do not
        determine a component."""
        width = self._width(level) * self._deviations
        intervals = {}
        for f, w in zip(self.problem.free, width):
            value = self.best[f.name]
            intervals[f.name] = (value * float(np.exp(-w)), value * float(np.exp(w))) if f.log else (
                value - float(w), value + float(w))
        return intervals

    def profile(self, names: SomeComponents | None = None, *, level: float = 0.95, points: int = 8) -> Profile:
        """Profile likelihoods of the free components, or of some: the least loss at fixed values of each, from the best
        values outwards until it rises to the threshold of a confidence interval, or to a bound. Descents from all
        points of all profiles are integrated as one ensemble.

        level    of confidence of the intervals
        points   on either side of the best value, to begin with

        Raises `Error` if there are neither `sigma` nor residuals that could tell the deviations of the data."""
        free = self.problem.names
        if names is None:
            chosen = [name for name in free if name not in self.without_influence]
        else:
            chosen = [name_of(name) for name in listed(names)]
        for name in chosen:
            if name not in free:
                raise unknown(name, free, "free component of the fit")
        if not chosen:
            raise Error("there is nothing to profile: name at least one free component that has influence")
        if whole(points, "points") < 1:
            raise Error(f"points is {points}: give at least one on either side")
        if not self.variance > 0:
            raise Error("the residuals do not tell how far data deviate from the model, as there are no more data than "
                        "free components, or none deviate: give the fit sigma=")
        return Profile(self, chosen, level, self._width(level), points, *self._limits, self._varied,
                       self._jacobian)

    def waterfall(self, *, axes: Axes | None = None, **style: Any) -> Any:
        """Draws the losses of all starts in ascending order: steps are minima, and how many starts reach the lowest
        tells whether there were enough. Further arguments go to matplotlib's `plot`. Returns the axes."""
        return plots.waterfall(self.loss, [s == "converged" for s in self.status], tolerance=self._equal, axes=axes,
                               **style)

    def plot(self, *, axes: Any = None, **style: Any) -> Any:
        """Draws a panel for each quantity in the data, into a new figure, or into as many `axes`: the data over the
        best model, at times between those of the data too, each experiment in its colour, with a legend of
        up to 36. Triangles are values of which only is known that they are below or above a limit. Further arguments go
        to matplotlib's `plot` of the model. Returns the axes in an array."""
        curves = self.problem.curves([self.best[name] for name in self.problem.names])
        names = list(dict.fromkeys(of.experiment for several in curves.values() for of in several))
        columns = -(-len(names) // 9)  # so many are as high as a panel
        has_legend = len(names) > 1 and columns <= 4
        if axes is None:
            axes = plots.panels(len(curves), 1.3 * columns if has_legend else 0.0)
        if np.size(axes) != len(curves):
            raise Error(f"there are {np.size(axes)} axes for {', '.join(curves)}: give one for each")
        colours = dict(zip(names, several_colours(len(names))))
        for several, into in zip(curves.values(), np.ravel(axes)):
            for of in several:
                own = {"color": colours[of.experiment], "label": of.experiment, **style} if len(names) > 1 else style
                plots.data_and_model(of.t_data, of.data, of.t, of.model, sigma=of.sigma, side=of.side,
                                     data_color=own.get("color", "black") if len(names) > 1 else "black",
                                     xlabel=of.t_label, ylabel=of.label, axes=into, **own)
        if has_legend:
            lines = {line.get_label(): line for into in np.ravel(axes) for line in into.lines}
            legend(np.ravel(axes)[-1], handles=[lines[name] for name in names], ncols=columns)
        return np.ravel(axes)

    def run(self) -> Run:
        """A run of the best values, with its sensitivities."""
        return self.problem.run([self.best[name] for name in self.problem.names])

    @property
    def _equal(self) -> float:
        """Within what losses are equal: a thousandth of half the sum of the least squares, or rounding."""
        return 1e-3 * 0.5 * float(self.residuals @ self.residuals) + 1e-12

    def _reached(self) -> str:
        least = self.loss[self.index]
        near = int(np.sum(self.loss <= least + self._equal))
        return f"loss {least:.6g}, reached by {near} of {len(self.loss)} starts"

    def __str__(self) -> str:
        width = max(map(len, self.problem.names))
        lines = [f"{name:{width}}  {self.best[name]:.6g}  [{low:.6g}, {high:.6g}]"
                 for name, (low, high) in self.confidence().items()]
        return "\n".join([self._reached(), *lines, *(f"note: {note}" for note in self.notes)])

    def _repr_html_(self) -> str:
        rows = [(name, f"{self.best[name]:.6g}", f"{low:.6g}", f"{high:.6g}")
                for name, (low, high) in self.confidence().items()]
        return (html.paragraphs([self._reached()]) + html.columns(["", "best", "95% from", "to"], rows)
                + html.paragraphs(f"note: {note}" for note in self.notes))

    __repr__ = __str__


def _by_name(problem: Objective, values: Array) -> dict[str, Any]:
    return {name: values[..., i] for i, name in enumerate(problem.names)}


def fit(model: AnyModel, data: Any, *, free: ByComponent, own: SomeComponents | None = None,
        starts: int | ByComponent = 16, sweep: ByComponent | None = None, start: ByComponent | None = None,
        begin: float = 0.0, sigma: Any = None, limits: Any = None, priors: ByComponent | None = None,
        iterations: int = 100, tolerance: float = 1e-10, seed: int = 0, **options: Any) -> Fit[Any]:
    """Fits a model to data by least squares, or by likelihood, from many starts.

    model       from `my.model(...)`, or another that `solve` takes with sensitivities
    data        a dict, or a data frame, with times "t" and values of states or outputs by name; NaN: no value. Or a
                list of experiments, each of which is `my.experiment(data, ...)` with what differs in it
    free        the parameters and initial states to determine, with their bounds: `{k: (0.1, 10)}`, or
                `{k: (0.1, 10, "log")}` if the logarithm is to vary; names in `sigma=` and in experiments too
    own         those of `free` of which each experiment has its own value, "k[name]" in results; others have one in all
    starts      how many starts, in a Latin hypercube within the bounds; or where they are, arrays by name
    sweep       the values of all other parameters, one of each
    start       the initial values of all other states
    begin       the time of the initial values
    sigma       standard deviations of the data: a number, or numbers or arrays of one for each time by name; without,
                all are equal and estimated from the residuals. Or a noise model of `my.noise_models`, or a name in
                `free=`, for all data or by name: the loss is then the negative logarithm of the likelihood
    limits      of quantification, `{x: (0.1, None)}`, lower and upper: of values there or beyond counts only that they
                are. It needs `sigma`
    priors      what is known of free components, `{k: my.priors.log_normal(0.5, 0.3)}`; it needs `sigma`
    iterations  the most of each start
    tolerance   relative change of the loss at which a start has converged
    seed        of the hypercube

    Further arguments are those of `solve`: method, rtol, atol, device ... All starts of all experiments are integrated
    as one ensemble, with sensitivities, in every iteration. Ctrl-C raises `my.Interrupted`, whose `fit` is that of the
    iterations that were done."""
    several = isinstance(data, (list, tuple)) and any(isinstance(one, Experiment) for one in data)
    noise = sigma.values() if hasattr(sigma, "items") else [sigma]
    problem: Objective
    if (several or isinstance(data, Experiment) or own is not None or limits is not None or priors is not None
            or any(isinstance(one, (str, NoiseModel)) for one in noise)):
        problem = Likelihood(model, data, free, own, sweep, start, begin, sigma, limits, priors, options)
    else:
        problem = LeastSquares(model, data, free, sweep, start, begin, sigma, options)
    return minimised(problem, starts, iterations, tolerance, seed)


def minimised(problem: SomeObjective, starts: int | ByComponent, iterations: int, tolerance: float,
              seed: int) -> Fit[SomeObjective]:
    """The fit of a problem; arguments as of `fit`."""
    if isinstance(starts, Mapping):
        given = by_component(starts, "starts=")
        missing = [name for name in problem.names if name not in given]
        if missing or len(given) != len(problem.names):
            raise Error(f"starts= has {', '.join(given) or 'nothing'}: give values of {', '.join(problem.names)}")
        values = np.stack(np.broadcast_arrays(*(np.atleast_1d(np.asarray(given[n], float)) for n in problem.names)),
                          axis=1)
        least, most = problem.bounds
        if not ((values >= least) & (values <= most)).all():
            raise Error("starts= has values outside the bounds of free=: give starts within them")
        varied = logarithms(problem.free, values)
    else:
        count = whole(starts, "starts")
        if count < 1:
            raise Error(f"starts is {count}: give at least one")
        least, most = (logarithms(problem.free, end) for end in problem.bounds)
        varied = least + hypercube(count, len(problem.free), np.random.default_rng(seed)) * (most - least)
    limit = whole(iterations, "iterations")
    descent = Descent(problem, varied, tolerance)
    try:
        descent.run(limit)
    except KeyboardInterrupt:
        if not np.isfinite(descent.loss).any():
            raise
        raise Interrupted(None, Fit(problem, descent, varied, limit)) from None
    return Fit(problem, descent, varied, limit)
