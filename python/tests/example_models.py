# SPDX-License-Identifier: MIT
"""The models of the C++ examples, traced: each compiles to what the example's header says."""

import myriad as my


def duffing():
    x, v = my.states("x v")
    k, B = my.parameter("k"), my.shared("B")
    x_local_max, v_second_zero, x_global_max = map(my.accessory, ("x_local_max", "v_second_zero", "x_global_max"))
    zeros = my.integer_accessory("zeros")
    return my.model(
        {x: v, v: x - x**3 - k * v + B * my.cos(my.time)}, name="duffing",
        accessories={x_local_max: x, v_second_zero: v, x_global_max: x, zeros: 0},
        after_step={x_global_max: my.maximum(x_global_max, x)},
        events=[my.event(v, name="local_maximum", direction="falling", do={x_local_max: my.maximum(x_local_max, x)}),
                my.event(x, name="zero", do={
                    zeros: zeros + 1, v_second_zero: my.where(my.event_count("zero") == 2, v, v_second_zero)})])


def lorenz():
    x, y, z = my.states("x y z")
    rho, sigma, beta = my.parameter("rho"), my.shared("sigma"), my.shared("beta")
    return my.model({x: sigma * (y - x), y: x * (rho - z) - y, z: x * y - beta * z}, name="lorenz")


def roessler():
    x, y, z = my.states("x y z")
    c, (a, b) = my.parameter("c"), my.shared("a b")
    return my.model({x: -y - z, y: x + a * y, z: b + z * (x - c)}, name="roessler",
                    events=[my.event(y, name="section", direction="falling", stop_after=1)])


def oregonator():
    x, y, z = my.states("x y z")
    (f, epsilon), (q, ratio) = my.parameters("f epsilon"), my.shared("q ratio")
    z_least = my.accessory("z_least")
    return my.model({x: (q * y - x * y + x * (1 - x)) / epsilon, y: (f * z - q * y - x * y) / (ratio * epsilon),
                     z: x - z}, name="oregonator", parameters=(f, epsilon), shared=(q, ratio),
                    accessories={z_least: z}, after_step={z_least: my.minimum(z_least, z)},
                    events=[my.event(x - z, name="maximum", direction="falling", stop_after=1)])


def relief_valve():
    y, v, u = my.states("y v u")
    q = my.parameter("q")
    shared = kappa, delta, beta, restitution, rest_band = my.shared("kappa delta beta restitution rest_band")
    y_min, y_max, y_lowest, rest_at = map(my.accessory, ("y_min", "y_max", "y_lowest", "rest_at"))
    steps_at_rest, impacts = map(my.integer_accessory, ("steps_at_rest", "impacts"))
    rests = my.abs(y - rest_at) <= rest_band
    steps = my.where(rests, steps_at_rest + 1, 0)
    return my.model(
        {y: v, v: u - kappa * v - (y + delta), u: beta * (q - y * my.sqrt(u))}, name="relief_valve", shared=shared,
        accessories={y_min: y, y_max: y, y_lowest: my.where(my.phase == 0, y, y_lowest), rest_at: y, steps_at_rest: 0,
                     impacts: my.where(my.phase == 0, 0, impacts)},
        after_step={y_min: my.minimum(y_min, y), y_max: my.maximum(y_max, y), y_lowest: my.minimum(y_lowest, y),
                    rest_at: my.where(rests, rest_at, y), steps_at_rest: steps, my.end_phase: steps >= 50},
        events=[my.event(v, name="section", direction="falling", stop_after=1),
                my.event(y, name="seat", direction="falling", do={v: -restitution * v, impacts: impacts + 1})])


def stick_slip():
    x, v = my.states("x v")
    belt, (kinetic, breakaway) = my.parameter("belt"), my.shared("kinetic breakaway")
    t_slip, x_slip, x_stick, period = map(my.accessory, ("t_slip", "x_slip", "x_stick", "period"))
    sticks, slips = map(my.integer_accessory, ("sticks", "slips"))
    sticking = sticks == 1
    return my.model(
        {x: my.where(sticking, belt, v), v: my.where(sticking, 0, kinetic - x)}, name="stick_slip",
        accessories={t_slip: None, x_slip: None, x_stick: None, period: None, sticks: None, slips: None},
        events=[my.event(my.where(sticking, -1, v - belt), name="grip", do={sticks: 1, v: belt, x_stick: x}),
                my.event(my.where(sticking, x - breakaway, -1), name="slip", do={
                    sticks: 0, slips: slips + 1, period: my.time - t_slip, t_slip: my.time, x_slip: x})])


def bubble_response():
    y, v = my.states("y v")
    C = my.parameters([f"C{i}" for i in range(13)])
    first, second = my.sincospi(2 * my.time), my.sincospi(2 * C[11] * my.time + C[12])
    inverse, power, mach = my.reciprocal(y), my.powr(y, -C[10]), C[9] * v
    numerator = ((C[0] + C[1] * v) * power - C[2] * (1 + mach) - C[3] * inverse - C[4] * v * inverse
                 - (1.5 - 0.5 * mach) * v * v - (C[5] * first[0] + C[6] * second[0]) * (1 + mach)
                 - y * (C[7] * first[1] + C[8] * second[1]))
    denominator = y - mach * y + C[4] * C[9]
    y_max, maxima = my.accessory("y_max"), my.integer_accessory("maxima")
    return my.model({y: v, v: numerator * my.reciprocal(denominator)}, name="bubble_response", parameters=C,
                    accessories={y_max: y, maxima: 0},
                    events=[my.event(v, name="maximum", direction="falling", do={
                        y_max: my.maximum(y_max, y), maxima: maxima + 1})])


def bouncing_ball():
    x, v = my.states("x v")
    r, g, t_impact = my.parameter("r"), my.shared("g"), my.accessory("t_impact")
    return my.model({x: v, v: -g}, name="bouncing_ball", events=[my.event(x, name="impact", direction="falling", do={
        x: 0, v: -r * v, t_impact: my.time, my.end_phase: my.event_count("impact") == 5})])


def damped():
    x, v = my.states("x v")
    zeta = my.parameter("zeta")
    overshoot, t_overshoot, dissipated = map(my.accessory, ("overshoot", "t_overshoot", "dissipated"))
    return my.model({x: v, v: -x - 2 * zeta * v}, name="damped", accessories={
        overshoot: my.phase_minimum(x), t_overshoot: my.time_of_minimum(x),
        dissipated: my.integral(2 * zeta * v * v)})


def tangent_duffing():
    x, v, a, b = my.states("x v a b")
    k, B, growth = my.parameter("k"), my.shared("B"), my.accessory("growth")
    length = my.hypot(a, b)
    return my.model({x: v, v: x - x * x * x - k * v + B * my.cos(my.time), a: b, b: (1 - 3 * x * x) * a - k * b},
                    name="tangent_duffing",
                    finalise={a: a / length, b: b / length, growth: growth + my.log(length)})


def settling():
    x = my.state("x")
    k, limit = my.parameter("k"), my.shared("limit")
    total, x_before = my.accessory("integral_"), my.accessory("x_before")
    return my.model({x: -k * x}, name="settling", accessories={total: 0, x_before: x},
                    after_step={total: total + 0.5 * my.step * (x_before + x), x_before: x, my.end_phase: x < limit})


def continuation():
    x, mu, increment = my.state("x"), my.parameter("mu"), my.shared("increment")
    return my.model({x: mu - x * x * x}, name="continuation",
                    finalise={mu: mu + increment, my.t_end: my.t_end + 1})


def stop_by_select():
    x, v = my.states("x v")
    gap, K = my.parameter("gap"), my.shared("K")
    return my.model({x: v, v: -x - my.where(x > gap, K * (x - gap), 0)}, name="stop_by_select")


#: each with the header of its C++ counterpart
headers = {
    duffing: "examples/duffing/duffing.hpp", lorenz: "examples/lyapunov/lorenz.hpp",
    roessler: "examples/poincare/roessler.hpp", oregonator: "examples/stiff_chemistry/oregonator.hpp",
    relief_valve: "examples/relief_valve/relief_valve.hpp", stick_slip: "examples/hybrid/stick_slip.hpp",
    bubble_response: "examples/keller_miksis/keller_miksis.hpp", bouncing_ball: "examples/hooks/models.hpp",
    damped: "examples/hooks/models.hpp", tangent_duffing: "examples/hooks/models.hpp",
    settling: "examples/hooks/models.hpp", continuation: "examples/hooks/models.hpp",
    stop_by_select: "examples/hooks/models.hpp",
}
