# SPDX-License-Identifier: MIT
"""A study whose instances the model generates where they are integrated, reduced to a histogram there."""

# snippet: generated
import myriad_ode as my

x, y, z = my.states("x y z")
lorenz = my.model({x: 10 * (y - x), y: x * (28 - z) - y, z: x * y - 8 / 3 * z}, name="lorenz",
                  generate={x: my.uniform(-10, 10), y: my.uniform(-10, 10), z: my.normal(25, 3)})

study = my.study(lorenz, draws=1_000_000, time=(0, 1), method="runge_kutta_4", step=0.01, keep=dict(status=False),
                 reduce=[my.reduce.histogram("x_end", my.linspace(-20, 20, 81))])
result = study.run()  # on a GPU, nothing is uploaded, and 80 counts come back
print(result["x_end_histogram"])
# end of snippet
assert result.complete and result["x_end_histogram"].sum() + result["x_end_outside"].sum() == 1_000_000
