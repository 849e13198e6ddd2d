# SPDX-License-Identifier: MIT
"""What is used most, each in a few lines: a model, events, a call, a study, a fit, files."""

import numpy as np

import myriad_ode as my

# snippet: model
x, v = my.states("x v")                               # an initial value per instance
k, B, t = my.parameter("k"), my.shared("B"), my.time  # one value per instance; one for all
peak = my.accessory("peak")                           # the model's own storage
duffing = my.model({x: v, v: x - x**3 - k * v + B * my.cos(t)}, name="duffing",
                   accessories={peak: my.phase_maximum(x)})  # also phase_minimum, time_of_maximum, integral
# end of snippet

# snippet: events
height, speed = my.states("height speed")
r, bounces = my.parameter("r"), my.integer_accessory("bounces")
ball = my.model({height: speed, speed: -9.81}, name="ball", accessories={bounces: 0}, events=[
    my.event(height, direction="falling", do={height: 0, speed: -r * speed, bounces: bounces + 1}),
], stops=[
    my.stop(1, every=0.5, count=3, do={speed: speed + 1}),       # at known times
], triggers=[
    my.trigger((bounces == 5) & (height < 1), do={my.end_instance: True}),  # where conditions come to hold
])
# end of snippet

# snippet: delays
tau = my.parameter("tau")                             # x(t - tau); before the begin x was 1
late = my.model({x: -my.delayed(x, tau)}, name="late", history={x: 1})
# end of snippet

# snippet: solve
sweep = my.grid({k: np.linspace(0.2, 0.3, 50), x: [-1.0, 1.0], B: 0.3})  # all combinations; my.zip: side by side
run = my.solve(duffing, sweep, start={v: 0}, time=(0, 2 * np.pi), phases=40,
               record=dict(from_phase=32, states=[x]),  # at the ends of phases; samples=200: along the solution
               method="tsitouras_5", rtol=1e-8, atol=1e-8,
               device="auto")                           # or "cpu", "cpu:2" (threads), "cuda", "cuda:1"
print(run.report)                                       # statuses, steps, device, notes
run["x"], run["x_end"], run["peak"], run.status         # arrays; run["x_sample"] are samples
run.to_xarray()                                         # with the grid's axes
run.plot.bifurcation(x="k", y="x").figure.savefig("cheat_sheet.png")
# end of snippet

# snippet: study
study = my.study(duffing, {k: my.linspace(0.2, 0.3, 40), B: 0.3}, draws=25, seed=1,
                 start={x: my.normal(0, 1), v: my.uniform(-1, 1)}, time=(0, 2 * np.pi), phases=32,
                 reduce=[my.reduce.mean("x_end", over="draw"),   # for each k; without over= of all instances
                         my.reduce.histogram("v_end", my.linspace(-2, 2, 41))])
result = study.run("duffing_study")                     # a folder, in which it goes on if it is run again
result["x_end_mean"], result.to_xarray()
# end of snippet

# snippet: fit
times = np.linspace(0.5, 10, 20)
data = 3 * np.exp(-0.4 * times)
amount, rate = my.state("amount"), my.parameter("rate")
decay = my.model({amount: -rate * amount}, name="decay")
fit = my.fit(decay, {"t": times, amount: data}, free={rate: (0.01, 10, "log"), amount: (1, 10)}, starts=20)
fit.best, fit.confidence(0.95)                          # by name; fit.profile() is exact, fit.plot() draws
# end of snippet

# snippet: save
run.save("run.npz")
run = my.load("run.npz")                                # without the model and without a compiler
run.to_mat("run.mat")                                   # also to_netcdf, to_csv, to_parquet
# end of snippet

assert run["x"].shape == (100, 8) and run.report.failed == 0 and np.all(run["peak"] >= run["x_end"])
assert abs(fit.best["rate"] / 0.4 - 1) < 1e-6 and abs(fit.best["amount"] / 3 - 1) < 1e-6
assert (abs(result["x_end_mean"]) < 1.5).all() and result["v_end_histogram"].sum() == 1000
bounced = my.solve(ball, {r: [0.5, 0.9]}, start={height: 1, speed: 0}, time=(0, 20))
assert np.array_equal(bounced["bounces"], [5, 5]), bounced.report
