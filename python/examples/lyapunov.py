# SPDX-License-Identifier: MIT
"""The Lyapunov exponents of Lorenz' equations, as in the C++ example."""

import numpy as np

import myriad_ode as my

# snippet: lyapunov
x, y, z = my.states("x y z")
rho, (sigma, beta) = my.parameter("rho"), my.shared("sigma beta")
lorenz = my.model({x: sigma * (y - x), y: x * (rho - z) - y, z: x * y - beta * z}, name="lorenz")

run = my.solve(my.with_tangents(lorenz, 3, transient_phases=400), {rho: [28.0, 100.0], sigma: 10, beta: 8 / 3},
               start={x: 1, y: 1, z: 1}, time=(0, 0.25), phases=2400, method="tsitouras_5")
spectrum = my.exponents(run)              # a row for each rho, the largest exponent first
# end of snippet

assert np.allclose(spectrum.sum(axis=1), -(10 + 1 + 8 / 3), atol=1e-6)  # the divergence of the flow
assert abs(spectrum[0, 0] - 0.9056) < 0.03 and abs(spectrum[0, 1]) < 0.01, spectrum
