# SPDX-License-Identifier: MIT
"""The same sweep by SciPy, as a table."""
# snippet: sweep
import numpy
from scipy.integrate import solve_ivp


def van_der_pol(t, y, mu):
    return [y[1], mu * (1 - y[0] ** 2) * y[1] - y[0]]


mu = numpy.linspace(0.5, 4.0, 1024)
x = []
for value in mu:
    solution = solve_ivp(van_der_pol, (0, 20), [1, 0], args=(value,), method="RK45", rtol=1e-8, atol=1e-8)
    x.append(solution.y[0, -1])
# end of snippet

print("mu,x")
for value, end in zip(mu, x):
    print(f"{value:.17g},{end:.17g}")
