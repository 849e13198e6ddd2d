# SPDX-License-Identifier: MIT
"""Robertson's three reactions with the sum of the concentrations as an algebraic equation: a singular mass matrix."""

import numpy as np

import myriad_ode as my

# snippet: dae
a, b, c = my.states("a b c")
fast = my.parameter("fast")
slow, back = 0.04 * a, 1e4 * b * c
reactions = my.model({a: back - slow, b: slow - back - fast * b * b,
                      c: a + b + c - 1},  # 0 = a + b + c - 1
                     mass_matrix={c: 0}, name="reactions")

run = my.solve(reactions, {fast: [3e7, 3e8]}, start={a: 1, b: 0, c: 0}, time=(0, 40), method="rodas_5p",
               rtol=1e-8, atol={a: 1e-10, b: 1e-14, c: 1e-10})
# end of snippet

# The end values at t = 40 that the manual of CVODE has for the first, and the sum to rounding.
assert np.allclose([run["a"][0], run["b"][0], run["c"][0]], [0.7158, 9.185e-6, 0.2842], rtol=2e-4)
assert abs(run["a"] + run["b"] + run["c"] - 1).max() < 1e-14
assert run["b"][1] < run["b"][0]
