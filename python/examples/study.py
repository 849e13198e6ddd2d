# SPDX-License-Identifier: MIT
"""A study: random starts along an axis, kept in a folder in which it goes on, and reduced to a mean."""

# snippet: study
import myriad_ode as my

x, v = my.states("x v")
k, B, t = my.parameter("k"), my.shared("B"), my.time
duffing = my.model({x: v, v: x - x**3 - k * v + B * my.cos(t)}, name="duffing")

study = my.study(duffing, my.grid({k: my.linspace(0.2, 0.3, 40)}, {B: 0.3}), draws=25,
                 start={x: my.normal(0, 1), v: my.uniform(-1, 1)}, time=(0, 2 * my.pi), phases=32,
                 keep=[x, v], reduce=[my.reduce.mean("x_end"), my.reduce.histogram("v_end", my.linspace(-2, 2, 41))])
result = study.run("duffing_study", chunk=100)  # run again, it goes on; Ctrl-C may end it at any time
print(result)
table = result.to_xarray()  # read from the folder where it is used
print(table["x_end"].sel(k=0.25, method="nearest").mean("draw").item(), result["x_end_mean"])
# end of snippet
