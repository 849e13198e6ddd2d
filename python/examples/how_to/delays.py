# SPDX-License-Identifier: MIT
"""Mackey and Glass's equation of blood cells, whose production answers late: the maxima of its oscillations over the
delay, from the steady state through doubled periods to chaos."""

import matplotlib.pyplot as plt
import numpy as np

import myriad_ode as my

# snippet: bifurcation
x = my.state("x")
beta, gamma, n, tau = my.parameters("beta gamma n tau")
past = my.delayed(x, tau)                # x(t - tau)
slope = beta * past / (1 + past**n) - gamma * x
mackey_glass = my.model({x: slope}, name="mackey_glass", history={x: 0.5},
                        events=my.event(slope, direction="falling", stop_after=1))  # a maximum of x ends the phase

delays = np.linspace(4.8, 18, 300)
run = my.solve(mackey_glass, {tau: delays, beta: 0.2, gamma: 0.1, n: 10}, time=(0, np.inf), phases=240,
               record=dict(from_phase=200, states=[x]), rtol=1e-7, atol=1e-7, carry_on_step=True)
axes = run.plot.bifurcation(x="tau", y="x")
# end of snippet
axes.set(xlabel="delay tau", ylabel="maxima of x")
axes.figure.set_size_inches(5, 3.5)
axes.figure.savefig("delays.png")

assert run.report.failed == 0
spread = np.ptp(run["x"], axis=1)
assert spread[(delays > 7) & (delays < 12)].max() < 1e-3  # one maximum in each period
assert spread[delays > 17].min() > 0.1

# snippet: hopf
# The steady state x = 1 loses its stability where i w = -gamma + beta f'(1) exp(-i w tau), with f'(1) = (2 - n) / 4.
slope_of_production = 0.2 * (2 - 10) / 4
w = np.sqrt(slope_of_production**2 - 0.1**2)
critical = np.arccos(0.1 / slope_of_production) / w  # 4.708
near = my.solve(mackey_glass, {tau: [0.97 * critical, 1.03 * critical], beta: 0.2, gamma: 0.1, n: 10},
                start={x: 1.01}, time=(0, 3000), events={"event_1": dict(stop_after=0)}, samples=np.arange(2900, 3000))
swing = np.ptp(near["x_sample"], axis=1)
# end of snippet
assert swing[0] < 1e-3 < 0.05 < swing[1], swing

# snippet: table
days = np.linspace(-20, 0, 41)
measured = 1.2 - 0.2 * np.cos(0.3 * days)  # before the begin
known = my.interpolate(my.time, days, measured, kind="cubic", outside="nan")
since = my.solve(my.model({x: slope}, name="since", history={x: known}), {tau: [10, 17], beta: 0.2, gamma: 0.1, n: 10},
                 time=(0, 100), samples=101)
# end of snippet
assert since.report.failed == 0 and np.all(since["x_sample"][:, 0] == measured[-1])

# snippet: exponents
with_tangent = my.with_tangents(mackey_glass, transient_phases=100)
run = my.solve(with_tangent, {tau: [12, 17, 23], beta: 0.2, gamma: 0.1, n: 10}, time=(0, np.inf), phases=1500,
               phase_length=10, events={"event_1": dict(stop_after=0)}, rtol=1e-7, atol=1e-7)
largest = my.exponents(run)[:, 0]  # a cycle: 0; chaos: 0.006 and 0.009
# end of snippet
assert abs(largest[0]) < 1e-4 and np.all(largest[1:] > 0.004), largest
plt.close("all")
