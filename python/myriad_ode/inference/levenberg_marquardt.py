# SPDX-License-Identifier: MIT
"""Levenberg's and Marquardt's method for many starts at once, all of which are one ensemble in every iteration."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .objective import Objective, from_logarithms, logarithms

if TYPE_CHECKING:
    from ..symbolic.types import Array

_running, _converged, _stopped, _failed, _interrupted = range(5)
status_names = ("running", "converged", "iterations", "failed", "interrupted")
_largest_damping = 1e16  # beyond, a step changes nothing


class Descent:
    """Levenberg's and Marquardt's method for many starts within bounds; damping as of Nielsen (1999), scaled by the
    largest diagonal of J^T J so far (More 1978). Components at a bound, whose gradient leads out of it, rest.

    Arrays have a row for each start: of `varied`, which are the values or logarithms that vary, and of the columns that
    `pinned` gives, one for each start, which keep their values."""

    def __init__(self, problem: Objective, varied: Array, tolerance: float, pinned: Array | None = None) -> None:
        problem.check_derivatives()
        self.problem, self.tolerance = problem, tolerance
        self.least, self.most = (np.tile(logarithms(problem.free, end), (len(varied), 1)) for end in problem.bounds)
        self.varied = np.clip(varied, self.least, self.most)
        if pinned is not None:
            place = np.arange(len(varied)), pinned
            self.least[place] = self.most[place] = self.varied[place]
        #: the loss, J^T J, J^T r and half the sum of squares of r, which is the loss if that is of least squares
        self.loss, self.normal, self.gradient, self.squares, residuals, jacobian = self._evaluate(self.varied)
        best = np.argmin(self.loss)
        #: residuals and their derivatives where the least loss is: copies, as there are large ones of all starts
        self.best = residuals[best].copy(), jacobian[best].copy()
        count = len(varied)
        self.state = np.where(np.isfinite(self.loss), _running, _failed)
        self.damping, self.growth = np.full(count, 1e-3), np.full(count, 2.0)
        self.scale = np.zeros(varied.shape)
        self.iterations = np.zeros(count, int)

    def derivatives(self, varied: Array) -> tuple[Array, Array, Array]:
        """The loss, residuals, and their derivatives by what varies, at points in rows."""
        values = from_logarithms(self.problem.free, varied)
        loss, residuals, jacobian = self.problem.evaluate(values)
        inner = np.stack([values[:, i] if f.log else np.ones(len(values))
                          for i, f in enumerate(self.problem.free)], axis=1)
        jacobian *= inner[:, None, :]
        return loss, residuals, jacobian

    def _evaluate(self, varied: Array) -> tuple[Array, Array, Array, Array, Array, Array]:
        """The loss, infinite where there is none, J^T J, the gradient J^T r, r^T r / 2, r and J at points in rows."""
        loss, residuals, jacobian = self.derivatives(varied)
        transposed = jacobian.transpose(0, 2, 1)
        with np.errstate(over="ignore", invalid="ignore"):
            return np.where(np.isfinite(loss), loss, np.inf), transposed @ jacobian, \
                (transposed @ residuals[..., None])[..., 0], 0.5 * np.sum(residuals * residuals, axis=1), \
                residuals, jacobian

    def run(self, iterations: int) -> Descent:
        """Iterates until no start goes on, or so many times. After Ctrl-C all is as the last iteration left it."""
        try:
            for _ in range(iterations):
                if not self._step():
                    break
        except KeyboardInterrupt:
            self.state[self.state == _running] = _interrupted
            raise
        self.state[self.state == _running] = _stopped
        return self

    def _step(self) -> bool:
        """One iteration of all starts that go on. Returns whether there were any."""
        on = np.flatnonzero(self.state == _running)
        if not on.size:
            return False
        u, squares, normal, gradient = self.varied[on], self.squares[on], self.normal[on], self.gradient[on]
        least, most = self.least[on], self.most[on]
        diagonal = np.einsum("spp->sp", normal)
        self.scale[on] = np.maximum(self.scale[on], diagonal)
        scale = np.where(self.scale[on] > 0, self.scale[on], 1.0)
        rests = ((u <= least) & (gradient >= 0)) | ((u >= most) & (gradient <= 0)) | (diagonal == 0)
        # the cosine of the angle between the residuals and each column
        size = np.sqrt(diagonal * (2 * squares)[:, None])
        slant = np.where(rests | (size == 0), 0.0, np.abs(gradient) / np.where(size == 0, 1.0, size))
        flat = slant.max(axis=1) <= 1e-9
        moves = ~rests
        matrix = normal * (moves[:, :, None] & moves[:, None, :])
        count = matrix.shape[-1]
        matrix[:, range(count), range(count)] += self.damping[on][:, None] * scale + rests * scale
        move = np.linalg.solve(matrix, -(gradient * moves)[..., None])[..., 0]
        to = np.clip(u + move, least, most)
        move = to - u
        predicted = -np.einsum("sp,sp->s", gradient, move) - 0.5 * np.einsum("sp,spq,sq->s", move, normal, move)
        still = flat | (np.abs(move) <= 1e-12 * (1e-12 + np.abs(u))).all(axis=1)
        self.state[on[still]] = _converged
        goes = np.flatnonzero(~still)
        if goes.size:
            self._take(on[goes], to[goes], predicted[goes])
        return True

    def _take(self, on: Array, to: Array, predicted: Array) -> None:
        """Tries the steps, and takes those that lessen the loss."""
        (new, normal, gradient, squares, residuals, jacobian), old = self._evaluate(to), self.loss[on]
        size = self.squares[on]
        self.iterations[on] += 1
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio = (old - new) / predicted
        better = (new < old) & np.isfinite(normal).all(axis=(1, 2))
        taken = on[better]
        self.varied[taken], self.loss[taken] = to[better], new[better]
        self.normal[taken], self.gradient[taken] = normal[better], gradient[better]
        self.squares[taken] = squares[better]
        best = np.flatnonzero(better & (on == np.argmin(self.loss)))
        if best.size:
            self.best = residuals[best[0]].copy(), jacobian[best[0]].copy()
        factor = np.maximum(1 / 3, 1 - (2 * np.clip(ratio[better], 0, 1) - 1) ** 3)
        self.damping[taken] = np.maximum(self.damping[taken] * factor, 1e-15)
        self.growth[taken] = 2
        refused = on[~better]
        self.damping[refused] *= self.growth[refused]
        self.growth[refused] *= 2
        done = better & (old - new <= self.tolerance * size) & (predicted <= self.tolerance * size)
        self.state[on[done]] = _converged
        self.state[on[self.damping[on] > _largest_damping]] = _converged  # no shorter step lessens the loss
