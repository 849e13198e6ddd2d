# SPDX-License-Identifier: MIT
"""Lotka's and Volterra's equations fitted to the furs of hares and lynxes that the Hudson's Bay Company bought, and
sensitivities of an event's time."""

import numpy as np

import myriad_ode as my

# snippet: data
years = np.arange(1900, 1921)
hares = np.array([30, 47.2, 70.2, 77.4, 36.3, 20.6, 18.1, 21.4, 22, 25.4, 27.1, 40.3, 57, 76.6, 52.3, 19.5, 11.2, 7.6,
                  14.6, 16.2, 24.7])  # thousands
lynxes = np.array([4, 6.1, 9.8, 35.2, 59.4, 41.7, 19, 13, 8.3, 9.1, 7.4, 8, 12.3, 19.5, 45.7, 51.1, 29.7, 15.8, 9.7,
                   10.1, 8.6])
# end of snippet

# snippet: fit
hare, lynx = my.states("hare lynx")
birth, hunt, death, growth = my.parameters("birth hunt death growth")
model = my.model({hare: birth * hare - hunt * hare * lynx, lynx: growth * hare * lynx - death * lynx}, name="furs")

fit = my.fit(model, {"t": years, hare: hares, lynx: lynxes}, begin=1900, starts=40,
             free={birth: (0.1, 2, "log"), hunt: (1e-3, 1, "log"), death: (0.1, 2, "log"), growth: (1e-3, 1, "log"),
                   hare: (10, 60), lynx: (1, 20)})
print(fit)
# end of snippet

# The minimum, to the digits that SciPy's least_squares with a numerical Jacobian agrees in.
for name, least in (("birth", 0.4812), ("hunt", 0.02483), ("death", 0.9260), ("growth", 0.02753)):
    assert abs(fit.best[name] / least - 1) < 1e-3, (name, fit.best[name])
assert fit.status[fit.index] == "converged" and not fit.at_bound and not fit.without_influence

# snippet: profile
profile = fit.profile()
print(profile)
profile.plot()[0].figure.savefig("fit_profile.png")
fit.plot()[0].figure.savefig("fit.png")
fit.waterfall().figure.savefig("fit_waterfall.png")
# end of snippet
assert all(low < fit.best[name] < high for name, (low, high) in profile.intervals.items()) and not profile.notes

# snippet: scipy
problem = fit.problem  # or my.least_squares(model, data, free=...)
residuals = problem.residuals([0.5, 0.02, 0.9, 0.03, 35, 4])  # in the order of problem.names
jacobian = problem.jacobian([0.5, 0.02, 0.9, 0.03, 35, 4])    # one row for each residual
# end of snippet
assert residuals.shape == (42,) and jacobian.shape == (42, 6)

# snippet: sensitivity
x, v = my.states("x v")
r, g = my.parameters("r g")
landed = my.event(x, direction="falling", do={v: -r * v, my.end_phase: my.event_count("landed") == 2}, name="landed")
ball = my.model({x: v, v: -g}, events=landed, name="ball")

run = my.solve(ball, {r: 0.8, g: [9.81, 1.62]}, start={x: 1, v: 0}, time=(0, 10), rtol=1e-10, atol=1e-10,
               free=[r, g, x])
run.sensitivity[my.time, g]  # of the time of the second impact by gravity, one for each instance
run.sensitivity[v]           # of the speed after it, by r, g and the height x at the start
# end of snippet

# The second impact is at (1 + 2 r) sqrt(2 x / g), after which the ball has the speed r^2 sqrt(2 g x).
gravity = np.array([9.81, 1.62])
fall = np.sqrt(2 / gravity)
np.testing.assert_allclose(run.t_last, 2.6 * fall, rtol=1e-9)
np.testing.assert_allclose(run.sensitivity[my.time], np.stack([2 * fall, -1.3 * fall / gravity, 1.3 * fall], axis=1),
                           rtol=1e-7)
speed = np.sqrt(2 * gravity)
np.testing.assert_allclose(run.sensitivity[v], np.stack([1.6 * speed, 0.32 * speed / gravity, 0.32 * speed], axis=1),
                           rtol=1e-7)
