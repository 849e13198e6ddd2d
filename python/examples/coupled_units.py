# SPDX-License-Identifier: MIT
"""Phases of oscillators that pull each other by a matrix, as in Kuramoto's model: how far they run together."""

# snippet: model
import numpy as np
import myriad_ode as my

n = 40
ring = my.units(n)
angle, = ring.states("angle")
speed, K = ring.parameter("speed"), my.parameter("K")
A = ring.full_coupling("A", np.ones((n, n)) / n)
sine, cosine = A @ np.sin(angle), A @ np.cos(angle)
phases = my.model({angle: speed + K * (np.cos(angle) * sine - np.sin(angle) * cosine)}, name="phases")

speeds = np.tan(np.pi * (np.arange(1, n + 1) / (n + 1) - 0.5))  # of a Lorentz distribution of width 1
run = my.solve(phases, {speed: speeds, K: np.linspace(0, 6, 25)}, start={angle: 2 * np.pi * np.arange(n) / n + 0.01},
               time=(0, 40), rtol=1e-6)
order = np.abs(np.mean([np.exp(1j * run[f"angle_{i}"]) for i in range(n)], axis=0))
# end of snippet
assert order[0] < 0.3 and order[-1] > 0.6, order  # the threshold of infinitely many is K = 2
