#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A room that is heated by day, and an alarm if it stays cold: triggers, of which one has a delay."""

import numpy as np

import myriad_ode as my

# snippet: triggers
inside, = my.states("inside")  # temperature in degrees; the time is in hours
outside, power = my.parameters("outside power")
on, alarms = my.integer_accessory("on"), my.integer_accessory("alarms")
by_day = (my.time > 6) & (my.time < 22)

room = my.model({inside: (outside - inside) / 5 + my.where(on == 1, power, 0)}, triggers=[
    my.trigger((inside < 19) & by_day, do={on: 1}),
    my.trigger((inside > 21) | ~by_day, do={on: 0}),
    my.trigger((inside < 17) & by_day, delay=2, persistent=False, room=1, do={alarms: alarms + 1}),
], accessories={on: 0, alarms: 0}, name="room")
# end of snippet

weather = np.linspace(-10, 10, 5)
run = my.solve(room, my.grid(outside=weather, power=[5.0, 8.0]), start={"inside": 20}, time=(0, 24), rtol=1e-8)
alarms_rung = run["alarms"].reshape(5, 2)
for degrees, (weak, strong) in zip(weather, alarms_rung):
    print(f"{degrees:4.0f} degrees outside: {weak} alarms with the weak heater, {strong} with the strong one")

at_six = weather + (20 - weather) * np.exp(-6 / 5)  # below 17, so that the alarm is set and the heater switched on
warmest = weather[:, None] + 5 * np.array([5.0, 8.0])
with np.errstate(invalid="ignore"):
    until_17 = 5 * np.log((warmest - at_six[:, None]) / (warmest - 17))
np.testing.assert_array_equal(alarms_rung, (warmest < 17) | (until_17 > 2))

# snippet: switches
v, depth = my.states("v depth")
surface = my.parameter("surface")
dive = my.with_located_switches(my.model({depth: v, v: 9.81 - my.where(depth > surface, 2.0, 0.1) * v}, name="dive"))
falls = my.solve(dive, {surface: [1.0, 5.0, 10.0]}, start={v: 0, depth: 0}, time=(0, 2), free=[surface])
faster = falls.sensitivity[v, surface]  # how much faster, in the end, if the water is lower by one unit
# end of snippet

lower, higher = (my.solve(dive, {surface: np.array([1.0, 5.0, 10.0]) + by}, start={v: 0, depth: 0}, time=(0, 2),
                          rtol=1e-10, atol=1e-10)[v] for by in (1e-5, -1e-5))
np.testing.assert_allclose(faster, (lower - higher) / 2e-5, rtol=1e-4)
