# SPDX-License-Identifier: MIT
"""The models of the C++ examples, traced: each compiles to what the example's header says."""

import numpy as np

import myriad_ode as my


def accessories(names):
    return [my.accessory(name) for name in names.split()]


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
    y, v, C, equations = bubble_right_hand_side()
    y_max, maxima = my.accessory("y_max"), my.integer_accessory("maxima")
    return my.model(equations, name="bubble_response", parameters=C, accessories={y_max: y, maxima: 0},
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


def oscillator():
    """Of the quickstart and of studies, where it is called `duffing`."""
    x, v = my.states("x v")
    k, B = my.parameter("k"), my.shared("B")
    return my.model({x: v, v: x - x**3 - k * v + B * my.cos(my.time)}, name="oscillator")


def highest_maximum():
    """Of the command-line program, where it is called `duffing`."""
    x, v = my.states("x v")
    (k, B), highest = my.parameters("k B"), my.accessory("highest")
    return my.model({x: v, v: x - x**3 - k * v + B * my.cos(my.time)}, name="highest_maximum", parameters=(k, B),
                    accessories={highest: x}, events=[my.event(v, name="maximum", direction="falling", do={
                        highest: my.maximum(highest, x)})])


def van_der_pol():
    x, v, mu = *my.states("x v"), my.parameter("mu")
    return my.model({x: v, v: mu * (1 - x * x) * v - x}, name="van_der_pol")


def pendulum():
    angle, speed = my.states("angle speed")
    last_passage, passages = my.accessory("last_passage"), my.integer_accessory("passages")
    return my.model({angle: speed, speed: -my.sin(angle)}, name="pendulum", events=[
        my.event(angle, name="lowest_point", tolerance=1e-12, stop_after=3, do={
            last_passage: my.time, passages: passages + 1})])


def magnetic_pendulum():
    x, y, u, v = my.states("x y u v")
    omega, damping, height, barrier = my.shared("omega damping height barrier")
    x_1, half = 0.57735026918962576, 0.5
    x_23 = -x_1 / 2

    def inverse_distance(dx, dy):
        return 1 / my.sqrt(dx * dx + dy * dy + height * height)

    dx_23 = x_23 - x
    n = inverse_distance(x_1 - x, y), inverse_distance(dx_23, half - y), inverse_distance(dx_23, half + y)
    w_1, w_2, w_3 = (a * a * a for a in n)
    stiffness = w_1 + (w_2 + w_3) + omega * omega
    potential = 0.5 * omega * omega * (x * x + y * y) - (n[0] + (n[1] + n[2]))
    return my.model({x: u, y: v, u: x_1 * w_1 + x_23 * (w_2 + w_3) - stiffness * x - damping * u,
                     v: half * (w_2 - w_3) - stiffness * y - damping * v}, name="magnetic_pendulum",
                    shared=(omega, damping, height, barrier),
                    after_step={my.end_phase: 0.5 * (u * u + v * v) + potential < barrier})


def relief_valve_contact():
    y, v, u = my.states("y v u")
    q = my.parameter("q")
    shared = my.shared("kappa delta beta restitution rest_band slowest")
    kappa, delta, beta, restitution, rest_band, slowest = shared
    y_min, y_max, y_lowest, rest_at, u_contact, t_contact, time_at_rest = accessories(
        "y_min y_max y_lowest rest_at u_contact t_contact time_at_rest")
    steps_at_rest, impacts, rests = map(my.integer_accessory, ("steps_at_rest", "impacts", "rests"))
    resting = rests == 1
    same_place = my.abs(y - rest_at) <= rest_band
    steps = my.where(same_place, steps_at_rest + 1, 0)
    rebound, closing = -restitution * v, delta - u
    bounces = 4 * rebound / ((1 - restitution) * closing)
    last = (rebound < slowest) & (closing > 0) & (20 * bounces < closing / (beta * q))
    first_phase = my.phase == 0
    return my.model(
        {y: my.where(resting, 0, v), v: my.where(resting, 0, u - kappa * v - (y + delta)),
         u: beta * (q - y * my.sqrt(u))}, name="relief_valve_contact", shared=shared,
        parameters=(q, steps_at_rest, impacts, rests),  # integers in the order of the written model
        accessories={y_min: y, y_max: y, y_lowest: my.where(first_phase, y, y_lowest), rest_at: y, u_contact: 0,
                     t_contact: 0, time_at_rest: 0, steps_at_rest: 0, impacts: my.where(first_phase, 0, impacts),
                     rests: my.where(first_phase, 0, rests)},
        after_step={y_min: my.minimum(y_min, y), y_max: my.maximum(y_max, y), y_lowest: my.minimum(y_lowest, y),
                    rest_at: my.where(same_place, rest_at, y), steps_at_rest: steps, my.end_phase: steps >= 50},
        events=[my.event(my.where(resting, -1, v), name="section", direction="falling", stop_after=1),
                my.event(my.where(resting, 1, y), name="seat", direction="falling", do={
                    y: 0, v: my.where(last, 0, rebound), impacts: impacts + 1, steps_at_rest: 0,
                    rests: my.where(last, 1, rests), u_contact: my.where(last, u, u_contact),
                    t_contact: my.where(last, my.time, t_contact)}),
                my.event(my.where(resting, u - delta, -1), name="opening", direction="rising", do={
                    rests: 0, u: delta, time_at_rest: my.time - t_contact})])


def response():
    x, v = my.states("x v")
    (omega, beta), zeta = my.parameters("omega beta"), my.shared("zeta")
    names = maximum, minimum, integral, x_before, v_before = accessories("maximum minimum integral x_before v_before")
    h = my.step
    return my.model(
        {x: v, v: my.cos(omega * my.time) - 2 * zeta * v - x - beta * x * x * x}, name="response",
        parameters=(omega, beta), accessories=dict.fromkeys(names), events=[my.event(v, name="extremum")],
        after_step={maximum: my.maximum(maximum, x), minimum: my.minimum(minimum, x), x_before: x, v_before: v,
                    integral: integral + (0.5 * h * (x_before * x_before + x * x)
                                          + h * h / 6 * (x_before * v_before - x * v))})


def bubble_constants(p_1, f_1, p_2, f_2):
    """C0 to C12 of examples/keller_miksis/constants.hpp, for arrays; pressures in Pa, frequencies in Hz."""
    vapour, density, tension, viscosity = 3166.775638952003, 997.0639504998557, 0.071977583160056, 8.902125058209557e-4
    sound, exponent, ambient, radius = 1497.251785455527, 1.4, 1e5, 10e-6
    omega_1, omega_2 = 2 * np.pi * f_1, 2 * np.pi * f_2
    q, excess = 2 * np.pi / (radius * omega_1), ambient - vapour + 2 * tension / radius
    C = [excess * q * q / density, (1 - 3 * exponent) * excess * q / (density * sound),
         (ambient - vapour) * q * q / density, 2 * tension * q * q / (density * radius),
         4 * viscosity / (density * radius * radius) / f_1, p_1 * q * q / density, p_2 * q * q / density,
         radius * omega_1 * p_1 * q * q / (density * sound), radius * omega_2 * p_2 * q * q / (density * sound),
         radius * omega_1 / (2 * np.pi * sound), 3 * exponent, omega_2 / omega_1, 0]
    return {f"C{i}": np.broadcast_to(c, np.shape(f_1)) for i, c in enumerate(C)}


def bubble_right_hand_side():
    """States and constants of the bubble, and its equations."""
    y, v = my.states("y v")
    C = my.parameters([f"C{i}" for i in range(13)])
    first, second = my.sincospi(2 * my.time), my.sincospi(2 * C[11] * my.time + C[12])
    inverse, power, mach = my.reciprocal(y), my.powr(y, -C[10]), C[9] * v
    numerator = ((C[0] + C[1] * v) * power - C[2] * (1 + mach) - C[3] * inverse - C[4] * v * inverse
                 - (1.5 - 0.5 * mach) * v * v - (C[5] * first[0] + C[6] * second[0]) * (1 + mach)
                 - y * (C[7] * first[1] + C[8] * second[1]))
    denominator = y - mach * y + C[4] * C[9]
    return y, v, C, {y: v, v: numerator * my.reciprocal(denominator)}


def bubble_dual_frequency():
    y, v, C, equations = bubble_right_hand_side()
    transient = my.shared_integer("transient_phases")
    names = accessories("y_max t_max y_min t_min largest compression collapse_time t_first winding")
    y_max, t_max, y_min, t_min, largest, compression, collapse_time, t_first, winding = names
    begins = my.phase == transient
    recorded = my.phase - transient + 1
    counts = recorded >= 1
    ratio = y_max / y_min
    strongest = counts & (ratio > compression)
    return my.model(
        equations, name="bubble_dual_frequency", parameters=C,
        accessories={y_max: y, t_max: my.time, y_min: y, t_min: my.time, largest: my.where(begins, y, largest),
                     compression: my.where(begins, 0, compression), collapse_time: None,
                     t_first: my.where(begins, my.time, t_first), winding: None},
        events=[my.event(v, name="maximum", direction="falling", stop_after=1),
                my.event(v, name="minimum", direction="rising", do={y_min: y, t_min: my.time})],
        finalise={largest: my.where(counts, my.maximum(largest, y), largest),
                  compression: my.where(strongest, ratio, compression),
                  collapse_time: my.where(strongest, t_min - t_max, collapse_time),
                  winding: my.where(counts, recorded / (my.time - t_first), winding)})


def forced_duffing():
    x, v = my.states("x v")
    k, B = my.parameters("k B")
    _, cosine = my.sincos(my.time)
    return my.model({x: v, v: x - x * x * x - k * v + B * cosine}, name="forced_duffing", parameters=(k, B))


def hand_tangent():
    x, v, a, b = my.states("x v a b")
    (k, B), transient, growth = my.parameters("k B"), my.shared_integer("transient"), my.accessory("growth")
    _, cosine = my.sincos(my.time)
    length = my.hypot(a, b)
    return my.model({x: v, v: x - x * x * x - k * v + B * cosine, a: b, b: a - 3 * x * x * a - k * b},
                    name="hand_tangent", parameters=(k, B), finalise={
                        a: a / length, b: b / length,
                        growth: my.where(my.phase >= transient, growth + my.log(length), growth)})


def epidemic():
    """Its parameters are drawn by its user, where those of the C++ example are drawn in a hook."""
    s, i = my.states("s i")
    R0, duration = my.parameters("R0 duration")
    peak, day = accessories("peak day")
    infections = R0 * s * i
    return my.model({s: -infections / duration, i: (infections - i) / duration}, name="epidemic",
                    accessories={peak: i, day: my.time}, events=[
                        my.event(R0 * s - 1, name="turning_point", direction="falling", tolerance=1e-9, stop_after=1,
                                 do={peak: i, day: my.time})])


def heat_conduction(matrix, radius):
    """A differentiation matrix at points `radius`, as a table."""
    inner = len(radius) - 2
    temperature, heat = my.states([f"T_{j}" for j in range(inner)]), my.state("heat")
    diffusivity, through, pulse = my.parameters("diffusivity through pulse")
    wall = my.shared("wall")
    D, square = my.table("D", matrix), my.table("square", radius * radius)
    inverse_square = my.table("inverse_square", 1 / (radius * radius))
    flow = through + pulse * my.cospi(2 * my.time)
    gradient = []
    for i in range(inner + 2):
        total = D[i, 0] * wall
        for j in range(inner):
            total = total + D[i, j + 1] * temperature[j]
        gradient.append(total)
    equations = {}
    for i in range(1, inner + 1):
        total = 0
        for j in range(inner + 2):
            total = total + D[i, j] * square[j] * gradient[j]
        equations[temperature[i - 1]] = (diffusivity * total - flow * gradient[i]) * inverse_square[i]
    equations[heat] = -gradient[0]
    return my.model(equations, name="heat_conduction", parameters=(diffusivity, through, pulse),
                    initialise={heat: 0}, finalise={my.t_begin: my.t_end, my.t_end: my.t_end + 1 / 16})


#: each with the header of its C++ counterpart, and the struct there if it has another name. `epidemic` and
#: `heat_conduction` are not here, as random numbers in hooks and the order of shared values are C++'s own; nor are
#: models with tangents, nor `stop_by_branch`, which is `stop_by_select` written for single instances.
headers = {
    duffing: "examples/duffing/duffing.hpp", lorenz: "examples/lyapunov/lorenz.hpp",
    roessler: "examples/poincare/roessler.hpp", oregonator: "examples/stiff_chemistry/oregonator.hpp",
    relief_valve: "examples/relief_valve/relief_valve.hpp", stick_slip: "examples/hybrid/stick_slip.hpp",
    relief_valve_contact: "examples/relief_valve/relief_valve_contact.hpp",
    bubble_response: "examples/keller_miksis/keller_miksis.hpp",
    bubble_dual_frequency: "examples/keller_miksis/keller_miksis.hpp",
    bouncing_ball: "examples/hooks/models.hpp", damped: "examples/hooks/models.hpp",
    tangent_duffing: "examples/hooks/models.hpp", settling: "examples/hooks/models.hpp",
    continuation: "examples/hooks/models.hpp", stop_by_select: "examples/hooks/models.hpp",
    oscillator: "examples/quickstart/model.hpp", highest_maximum: "examples/program/forced_duffing.hpp",
    van_der_pol: "examples/moving/model.hpp", pendulum: "examples/own_method/models.hpp",
    magnetic_pendulum: "examples/basins/magnetic_pendulum.hpp", response: "examples/resonance/oscillator.hpp",
    forced_duffing: "examples/lyapunov_map/forced_duffing.hpp",
    hand_tangent: "examples/lyapunov_map/forced_duffing.hpp",
}
#: those whose struct has the name of another model, which are put in a namespace
renamed = {oscillator: "duffing", highest_maximum: "duffing"}
