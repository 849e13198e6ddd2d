# SPDX-License-Identifier: MIT
"""A particle in a double well that noise drives over the barrier, as in the C++ example: mean times against the
solution of the equation that they satisfy, and against Kramers' rate, its limit for weak noise."""

import matplotlib.pyplot as plt
import numpy as np

# snippet: bistable
import myriad_ode as my

x, sigma = my.state("x"), my.parameter("sigma")
bistable = my.model({x: x - x**3}, noise={x: sigma}, events=my.event(x - 1, stop_after=1), name="bistable")

run = my.solve(bistable, {sigma: [0.4, 0.5, 0.6, 0.7, 0.8]}, paths=2000, start={x: -1}, time=(0, 10_000),
               method="euler_maruyama", step=0.02, seed=1)
times = run.to_xarray()["t_last"]  # with the axes sigma and path
mean, error = times.mean("path"), times.std("path") / times.sizes["path"]**0.5
# end of snippet


def expected(sigma):
    """2 / sigma^2 times the integral over y from -1 to 1 of exp(2 V(y) / sigma^2) times that over z up to y of
    exp(-2 V(z) / sigma^2), with V = x^4 / 4 - x^2 / 2. Gardiner, Handbook of Stochastic Methods, section 5.2.7."""
    z, dz = np.linspace(-4, 1, 50_001, retstep=True)
    weight = np.exp(-2 / sigma**2 * (z**4 / 4 - z**2 / 2))
    below = np.cumsum(weight) - weight / 2
    inside = z >= -1
    return 2 / sigma**2 * (below[inside] / weight[inside]).sum() * dz**2


def kramers(sigma):
    """The time by Kramers' rate sqrt(V''(-1) |V''(0)|) / (2 pi) exp(-2 (V(0) - V(-1)) / sigma^2)."""
    return 2 * np.pi / np.sqrt(2) * np.exp(0.5 / sigma**2)


assert (run.status == "stopped_by_event").all()
exact = np.array([expected(s) for s in times["sigma"].values])
assert (np.abs(mean - exact) < 4 * error).all(), (mean, error, exact)

amplitudes = np.linspace(0.38, 0.82, 45)
figure, axes = plt.subplots(figsize=(5, 3.5), layout="constrained")
axes.semilogy(amplitudes, [expected(s) for s in amplitudes], label="exact")
axes.semilogy(amplitudes, [kramers(s) for s in amplitudes], "--", label="Kramers' rate")
axes.errorbar(times["sigma"], mean, error, fmt="o", markersize=4, label="2000 paths each")
axes.set(xlabel="sigma", ylabel="mean time over the barrier")
axes.legend()
figure.savefig("noise.png")
