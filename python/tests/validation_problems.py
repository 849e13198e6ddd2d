# SPDX-License-Identifier: MIT
"""The problems of validation/problems in Python: models, ensembles, and references that are independent of Myriad:
closed forms, the values in quadruple precision that the C++ validation has, and SciPy where there is neither."""

import math
from dataclasses import dataclass, field

import numpy as np

import example_models
import myriad_ode as my

tau = 2 * np.pi


@dataclass
class Problem:
    """What is solved, and how far off a solution may be."""

    model: object
    sweep: dict
    start: dict
    end: object  # of time, from 0
    #: the largest factor by which an error of one step grows until the end (docs/validation.md)
    growth: float
    #: the solution of instance i: values by name, of those that are known; None if it is not known
    reference: object
    events: dict = field(default_factory=dict)
    event_tolerance: float = 0
    events_per_instance: int = 0
    counts: tuple = ()  # integer accessories, which have to be the reference's
    instances: tuple = ()  # whose reference is looked up; empty: all
    reference_error: float = 0
    fixed_step: float = 0.01
    stiff: bool = False
    method: str = "tsitouras_5"  # that is compiled always; the others with --all
    error_of_a_step: float = 1  # bound on an accepted step's error, in tolerances
    smallest: float = 1  # size of the smallest component that matters, to which the absolute tolerance is relative

    @property
    def size(self):
        return next(len(v) for v in (*self.sweep.values(), *self.start.values()) if np.ndim(v))

    def solve(self, tolerance, **options):
        """The ensemble, with this relative tolerance."""
        return my.solve(self.model, self.sweep, start=self.start, rtol=tolerance, atol=tolerance * self.smallest,
                        **{"time": (0, self.end), "events": self.events, **options})


def by_scipy(rhs, y, end, method="DOP853", watched=(), act=None):
    """The state at the end by SciPy at a tolerance of 1e-12. At a zero of `watched`, pairs of function(y) and
    direction, `act(number, t, y)` may change the state, with which the integration begins anew."""
    from scipy.integrate import solve_ivp

    def event(function, direction):
        def watch(t, y):
            return function(y)
        watch.terminal, watch.direction = True, direction
        return watch

    t, y = 0.0, np.array(y, float)
    y[y == 0] = 1e-300 * np.array(rhs(t, y))[y == 0]  # a zero at the start is no event
    while t < end:
        done = solve_ivp(rhs, (t, end), y, method=method, rtol=1e-12, atol=1e-12,
                         events=[event(*w) for w in watched] or None)
        t, y = done.t[-1], done.y[:, -1]
        for number, times in enumerate(done.t_events or ()):
            if len(times):
                act(number, t, y)
    return y


# ----------------------------------------------------------------------------------------------------------------------


def lorenz():
    x, y, z, rho = *my.states("x y z"), my.parameter("rho")
    known = dict(x=-7.8734410765709620402, y=-6.7133208531654644431, z=22.176159652834202702)  # quadruple precision
    return Problem(my.model({x: 10 * (y - x), y: x * (rho - z) - y, z: x * y - 8 / 3 * z}, name="lorenz"),
                   {"rho": np.linspace(0, 21, 64)}, dict(x=1, y=0, z=0), 10, 26.7, lambda i: known, instances=(63,),
                   fixed_step=0.005, method="runge_kutta_4")


def duffing():
    x, v, k = *my.states("x v"), my.parameter("k")
    B, omega = my.shared("B omega")
    t_maximum, t_rise, maximum, v_rise, maxima_sum = map(
        my.accessory, ("t_maximum", "t_rise", "maximum", "v_rise", "maxima_sum"))
    maxima, rises = my.integer_accessory("maxima"), my.integer_accessory("rises")
    model = my.model({x: v, v: x - x * x * x - k * v + B * my.cos(omega * my.time)}, name="duffing", accessories={
        t_maximum: 0, t_rise: 0, maximum: 0, v_rise: 0, maxima_sum: 0, maxima: 0, rises: 0}, events=[
            my.event(v, name="turning", direction="falling", tolerance=1e-12, do={
                t_maximum: my.time, maximum: x, maxima_sum: maxima_sum + x, maxima: maxima + 1}),
            my.event(x, name="rising", direction="rising", tolerance=1e-12, do={
                t_rise: my.time, v_rise: v, rises: rises + 1})])
    known = dict(x=1.1702802239391576732, v=0.065504462499426847300)  # quadruple precision
    return Problem(model, {"k": np.linspace(0.25, 0.35, 65), "B": 0.5, "omega": 1.2}, dict(x=0.1, v=0),
                   np.where(np.arange(65) == 32, 50.0, 19.0), 207, lambda i: known, instances=(32,),
                   event_tolerance=1e-12, events_per_instance=40, method="cash_karp")


def van_der_pol():
    known = dict(x=2.0081497621749485920, v=-0.042508875273202146986)  # quadruple precision
    return Problem(example_models.van_der_pol(), {"mu": np.linspace(0.2, 1.8, 65)}, dict(x=2, v=0), 20, 21.5,
                   lambda i: known, instances=(32,), method="dormand_prince_5")


def bubble(C):
    """The bubble's radius, slope and extrema after one period, by SciPy; C are the constants of one instance."""
    def rhs(t, state):
        y, v = state
        mach = C[9] * v
        one, two = tau * t, tau * C[11] * t + np.pi * C[12]
        numerator = ((C[0] + C[1] * v) * y**-C[10] - C[2] * (1 + mach) - (C[3] + C[4] * v) / y
                     - (1.5 - mach / 2) * v * v - (C[5] * math.sin(one) + C[6] * math.sin(two)) * (1 + mach)
                     - y * (C[7] * math.cos(one) + C[8] * math.cos(two)))
        return v, numerator / (y - mach * y + C[4] * C[9])

    seen = dict(maxima=0, minima=0, t_maximum=0, t_minimum=0, maximum=0, minimum=0)

    def act(number, t, state):
        what = ("maximum", "minimum")[number]
        seen[f"t_{what}"], seen[what] = t, state[0]
        seen[("maxima", "minima")[number]] += 1
        state[1] = (-1e-300, 1e-300)[number]  # beyond the zero

    y, v = by_scipy(rhs, (1, 0), 1, watched=[(lambda s: s[1], -1), (lambda s: s[1], 1)], act=act)
    return dict(y=y, v=v, **seen)


def keller_miksis():
    y, v = my.states("y v")
    C = my.parameters([f"C{i}" for i in range(13)])
    t_maximum, t_minimum, maximum, minimum = map(my.accessory, ("t_maximum", "t_minimum", "maximum", "minimum"))
    maxima, minima = my.integer_accessory("maxima"), my.integer_accessory("minima")
    one, two = 2 * my.time, 2 * C[11] * my.time + C[12]
    inverse, mach = 1 / y, C[9] * v
    numerator = ((C[0] + C[1] * v) * my.pow(y, -C[10]) - C[2] * (1 + mach) - (C[3] + C[4] * v) * inverse
                 - (1.5 - 0.5 * mach) * v * v - (C[5] * my.sinpi(one) + C[6] * my.sinpi(two)) * (1 + mach)
                 - y * (C[7] * my.cospi(one) + C[8] * my.cospi(two)))
    model = my.model(
        {y: v, v: numerator / (y - mach * y + C[4] * C[9])}, name="keller_miksis", parameters=C,
        accessories={t_maximum: 0, t_minimum: 0, maximum: 0, minimum: 0, maxima: 0, minima: 0},
        events=[my.event(v, name="largest", direction="falling", tolerance=1e-11, do={
                    t_maximum: my.time, maximum: y, maxima: maxima + 1}),
                my.event(v, name="smallest", direction="rising", tolerance=1e-11, do={
                    t_minimum: my.time, minimum: y, minima: minima + 1})])
    f = np.tile(np.logspace(5, 6, 32), 2)
    one, two = np.repeat([0.8e5, 0.5e5], 32), np.repeat([0, 0.4e5], 32)
    constants = example_models.bubble_constants(one, f, two, np.repeat([1e5, 3e5], 32))
    return Problem(model, constants, dict(y=1, v=0), 1, 50.7,
                   lambda i: bubble([float(c[i]) for c in constants.values()]), instances=(4, 30, 40, 60),
                   event_tolerance=1e-11, events_per_instance=10, counts=("maxima", "minima"), reference_error=1e-9,
                   fixed_step=0.0005, method="cash_karp")


def valve(q, kappa, delta, beta, restitution):
    """The valve at t = 8, its last impact and maximum, by SciPy."""
    def rhs(t, state):
        y, v, u = state
        return v, u - kappa * v - (y + delta), beta * (q - y * math.sqrt(u))

    seen = dict(maxima=0, impacts=0, t_maximum=0, t_impact=0, maximum=0, impact_speed=0)

    def act(number, t, state):
        if number == 0:
            seen["t_maximum"], seen["maximum"], state[1] = t, state[0], -1e-300
            seen["maxima"] += 1
        else:
            seen["t_impact"], seen["impact_speed"] = t, -state[1]
            seen["impacts"] += 1
            state[:2] = 1e-300, -restitution * state[1]

    y, v, u = by_scipy(rhs, (1, 0, 10), 8, watched=[(lambda s: s[1], -1), (lambda s: s[0], -1)], act=act)
    return dict(y=y, v=v, u=u, **seen)


def relief_valve():
    y, v, u, q = *my.states("y v u"), my.parameter("q")
    shared = kappa, delta, beta, restitution = my.shared("kappa delta beta restitution")
    t_maximum, t_impact, maximum, impact_speed = map(
        my.accessory, ("t_maximum", "t_impact", "maximum", "impact_speed"))
    maxima, impacts = my.integer_accessory("maxima"), my.integer_accessory("impacts")
    model = my.model(
        {y: v, v: u - kappa * v - (y + delta), u: beta * (q - y * my.sqrt(u))}, name="relief_valve", shared=shared,
        accessories={t_maximum: 0, t_impact: 0, maximum: 0, impact_speed: 0, maxima: 0, impacts: 0},
        events=[my.event(v, name="section", direction="falling", tolerance=1e-11, do={
                    t_maximum: my.time, maximum: y, maxima: maxima + 1}),
                my.event(y, name="seat", direction="falling", tolerance=1e-11, do={
                    t_impact: my.time, impact_speed: -v, impacts: impacts + 1, y: 0, v: -restitution * v})])
    q_values, others = np.linspace(3, 9, 64), dict(kappa=1.25, delta=10, beta=20, restitution=0.8)
    return Problem(model, {"q": q_values, **others}, dict(y=1, v=0, u=10), 8, 404,
                   lambda i: valve(q_values[i], **others), instances=(2, 25, 50), event_tolerance=1e-11,
                   events_per_instance=10, counts=("maxima", "impacts"), reference_error=1e-8, fixed_step=0.002)


def bouncing_ball():
    x, v, restitution = *my.states("x v"), my.parameter("restitution")
    numbers = (1, 2, 5, 10, 20)
    times = {n: my.accessory(f"t_{n}") for n in numbers}
    impacts = my.integer_accessory("impacts")
    model = my.model({x: v, v: -9.81}, name="bouncing_ball", accessories={
        **dict.fromkeys(times.values(), 0), impacts: 0}, events=[
            my.event(x, name="impact", direction="falling", tolerance=1e-12, stop_after=20, do={
                x: 0, v: -restitution * v, impacts: impacts + 1,
                **{times[n]: my.where(impacts == n - 1, my.time, times[n]) for n in numbers}})])
    r, first = np.linspace(0.75, 0.9, 64), np.sqrt(2 / 9.81)

    def reference(i):
        return {"x": 0, "v": r[i]**20 * np.sqrt(2 * 9.81), "impacts": 20,
                **{f"t_{n}": first + 2 * first * r[i] * (1 - r[i]**(n - 1)) / (1 - r[i]) for n in numbers}}

    return Problem(model, {"restitution": r}, dict(x=1, v=0), 10, 55, reference, event_tolerance=1e-12,
                   events_per_instance=20, counts=("impacts",), method="runge_kutta_4")


def heat(points=12):
    """With 10 points the closed form is that of the collocation to 2e-6 only."""
    r = 1.5 - 0.5 * np.cos(np.pi * np.arange(points) / (points - 1))
    distance = r[:, None] - r + np.eye(points)
    weight = 1 / distance.prod(axis=1)
    D = weight / weight[:, None] / distance * (1 - np.eye(points))
    D -= np.diag(D.sum(axis=1))
    temperature, kappa = np.array(my.states([f"T_{j}" for j in range(1, points - 1)])), my.parameter("kappa")
    matrix, radius = my.table("D", D), my.table("r", r)
    inside = [radius[j] * radius[j] * sum(matrix[j, k + 1] * T for k, T in enumerate(temperature))
              for j in range(points)]
    model = my.model({T: kappa * sum(matrix[j + 1, k] * inside[k] for k in range(points))
                      / (radius[j + 1] * radius[j + 1]) for j, T in enumerate(temperature)}, name="heat")
    diffusivity = np.linspace(0.2, 1, 64)
    profile = np.sin(np.pi * (r[1:-1] - 1)) / r[1:-1]
    return Problem(model, {"kappa": diffusivity}, {f"T_{j + 1}": value for j, value in enumerate(profile)}, 0.1, 4.27,
                   lambda i: {f"T_{j + 1}": value * np.exp(-diffusivity[i] * np.pi**2 * 0.1)
                              for j, value in enumerate(profile)},
                   reference_error=1e-8 if points == 12 else 3e-6, fixed_step=5e-4, method="runge_kutta_4",
                   error_of_a_step=4)


def kepler():
    x, y, u, v = my.states("x y u v")
    t_perihelion, orbits = my.accessory("t_perihelion"), my.integer_accessory("orbits")
    square = x * x + y * y
    inverse = 1 / (square * my.sqrt(square))
    model = my.model({x: u, y: v, u: -(x * inverse), v: -(y * inverse)}, name="kepler",
                     accessories={t_perihelion: 0, orbits: 0},
                     events=[my.event(y, name="perihelion", direction="rising", tolerance=1e-12, do={
                         t_perihelion: my.time, orbits: orbits + 1})])
    e = np.linspace(0, 0.6, 64)

    def reference(i):
        mean = np.remainder(10 + np.pi, tau) - np.pi
        E = mean
        for _ in range(50):  # Kepler's equation by Newton's method
            E -= (E - e[i] * np.sin(E) - mean) / (1 - e[i] * np.cos(E))
        width, rate = np.sqrt(1 - e[i]**2), 1 / (1 - e[i] * np.cos(E))
        return dict(x=np.cos(E) - e[i], y=width * np.sin(E), u=-np.sin(E) * rate, v=width * np.cos(E) * rate,
                    t_perihelion=tau, orbits=1)

    return Problem(model, {}, dict(x=1 - e, y=0, u=0, v=np.sqrt((1 + e) / (1 - e))), 10, 152, reference,
                   event_tolerance=1e-12, events_per_instance=1, counts=("orbits",), fixed_step=0.005,
                   method="tsitouras_5")


def timed_circle():
    u, w = my.states("u w")
    speed = 1 + my.time
    s = np.linspace(0.75, 6.75, 64)
    return Problem(my.model({u: speed * u * my.log(w), w: -(speed * w * my.log(u))}, name="timed_circle"), {},
                   dict(u=np.exp(np.sin(s)), w=np.exp(np.cos(s))), 2, 8.58,
                   lambda i: dict(u=np.exp(np.sin(s[i] + 4)), w=np.exp(np.cos(s[i] + 4))), method="cash_karp")


def robertson():
    a, b, c = my.states("a b c")
    k1, k2 = my.parameters("k1 k2")
    slow, fast, back = k1 * a, k2 * b * b, 1e4 * b * c
    known = dict(a=0.71582706871940509, b=9.1855347645577639e-6, c=0.28416374574583035)  # quadruple precision
    rates = np.linspace(0.02, 0.06, 17)
    rates[8] = 0.04
    return Problem(my.model({a: back - slow, b: slow - back - fast, c: fast}, name="robertson"),
                   {"k1": rates, "k2": np.full(17, 3e7)}, dict(a=1, b=0, c=0), 40, 2.63, lambda i: known,
                   instances=(8,), stiff=True, fixed_step=5e-4, method="rosenbrock_23",
                   smallest=1e-2)  # the reaction runs away where b is below -1e-6, which errors of 1e-6 make of 9e-6


def oregonator():
    a, b, c, s = *my.states("a b c"), my.parameter("s")
    model = my.model({a: s * (b + a * (1 - 8.375e-6 * a - b)), b: (c - (1 + a) * b) / s, c: 0.161 * (a - c)},
                     name="oregonator")
    values = np.linspace(60, 90, 64)

    def reference(i, end=30):
        def rhs(t, y, s=values[i]):
            a, b, c = y
            return s * (b + a * (1 - 8.375e-6 * a - b)), (c - (1 + a) * b) / s, 0.161 * (a - c)
        return dict(zip("abc", by_scipy(rhs, (1, 2, 3), end, method="Radau")))

    return Problem(model, {"s": values}, dict(a=1, b=2, c=3), 30, 1.4e5, reference, instances=(3, 60),
                   reference_error=1e-6, stiff=True, method="rodas_5p")


problems = {make.__name__: make for make in (lorenz, duffing, van_der_pol, keller_miksis, relief_valve, bouncing_ball,
                                             heat, kepler, timed_circle, robertson, oregonator)}
