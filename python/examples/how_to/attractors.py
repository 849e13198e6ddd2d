# SPDX-License-Identifier: MIT
"""What orbits come to and from where: attractors, basins, hysteresis, steady states."""

import numpy as np

import myriad_ode as my

# snippet: basins
x, v = my.states("x v")
k, B = my.parameters("k B")
wells = my.model({x: v, v: x - x**3 - k * v + B * my.cos(my.time)}, name="wells")  # a particle in two wells, driven

places = np.linspace(-2, 2, 160)
found = my.attractors(wells, {k: 0.1, B: 0.2}, start=my.grid({x: places, v: places}), time=(0, 2 * np.pi),
                      transient=100, phases=60, rtol=1e-6, atol=1e-6)
print(found)
found.plot().figure.savefig("attractors.png", dpi=150)
# end of snippet

assert [one.returns for one in found] == [1, 1, 1] and (found.labels >= 0).all()

# snippet: stability
drawn = my.attractors(wells, {k: 0.1, B: 0.2}, start={x: my.uniform(-2, 2), v: my.uniform(-2, 2)}, draws=2000,
                      time=(0, 2 * np.pi), transient=100, phases=60, rtol=1e-6, atol=1e-6)
print(drawn.shares, drawn.errors)
# end of snippet

assert (np.abs(drawn.shares - found.shares) < 4 * drawn.errors).all()

# snippet: hysteresis
hard = my.model({x: v, v: -x - x**3 - k * v + B * my.cos(2 * my.time)}, name="hard")  # a spring that stiffens
there_and_back = my.hysteresis(hard, {k: 0.2, B: np.linspace(0.2, 4, 77)}, start={x: 0, v: 0}, time=(0, np.pi),
                               transient=60, phases=8)
print(there_and_back.interval())
there_and_back.plot(x).figure.savefig("hysteresis.png", dpi=150)
# end of snippet

low, high = there_and_back.interval()

# snippet: continuation
along = my.continuation(hard, {k: 0.2, B: np.linspace(0.2, 4, 39)}, start=my.grid({x: np.linspace(-3, 3, 12),
                        v: np.linspace(-6, 6, 12)}), time=(0, np.pi), transient=60, phases=24)
print(along)
along.plot().figure.savefig("continuation.png", dpi=150)
# end of snippet

several = along.values[(along.shares > 0).sum(axis=1) > 1]
assert along.shares.shape[1] == 2 and abs(several.min() - low) < 0.11 and abs(several.max() - high) < 0.11

# snippet: steady
undriven = my.model({x: v, v: x - x**3 - k * v}, name="undriven")
for state in my.steady_states(undriven, {k: 0.15}, start=my.grid({x: [-2, 0.1, 2], v: [-1, 1]})):
    print(state)
# end of snippet

assert [one.kind for one in my.steady_states(undriven, {k: 0.15}, start={x: [-2, 0.1, 2], v: 0})] == [
    "stable focus", "saddle", "stable focus"]
