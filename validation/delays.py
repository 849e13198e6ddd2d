#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs known problems with delays at a tolerance and prints how far the results are from closed solutions, from values
of another program, or from a run by verner_7 at a much smaller tolerance, in tolerances.

    validation/delays.py [--tolerance 1e-9] [--method dormand_prince_5] [--only A1]

A1 to H4 are those of DDETST: W. H. Enright, H. Hayashi, The evaluation of numerical software for delay differential
equations, in Quality of Numerical Software (1997) 179-193, as coded in SciML's DDEProblemLibrary; from E1 on they are
neutral. In H2 to H4 the lag touches zero, so that an error of the solution would make it negative: it is limited.
chain is Wille and Baker's (J. Comput. Appl. Math. 43 (1992) 301-305). linear and iterated are 1.1.1
and 1.3.10 of C. A. H. Paul, A test set of functional differential equations, Manchester report 243 (1994). pantograph:
L. Fox et al., J. Inst. Maths Applics 8 (1971) 271-307. logarithm: K. W. Neves, ACM TOMS 1 (1975) 357-368. root:
A. Feldstein, K. W. Neves, SIAM J. Numer. Anal. 21 (1984) 844-863. enzyme to robertson are examples of N. Guglielmi and
E. Hairer's RADAR5, whose values are those of its version 2.1 at a relative tolerance of 1e-12, with these constants in
double precision. oregonator, hepatitis and robertson are stiff and solved by rodas_5p.

Steps end where equations jump, by `my.with_located_switches`. C2 has kinks, where the absolute value of a state or of
the past is zero, that steps go across; "C2, events" is the same with an event there. The package must be installed.
Exit status 1 if an error is above 100 tolerances, or above what an ill-conditioned problem is allowed.
"""
import argparse
import math
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

import myriad_ode as my

t = my.time
past, past_slope = my.delayed, my.delayed_slope


@dataclass
class Problem:
    """A model, its domain, and its solution at the end if it is known."""

    equations: dict[Any, Any]
    begin: float
    end: float
    initial: dict[Any, float]
    history: dict[Any, Any] = field(default_factory=dict)
    exact: Callable[[float], Sequence[float]] | None = None
    method: str | None = None           # of stiff problems
    sizes: Sequence[float] | None = None  # of the states: what absolute tolerances are relative to; 1
    most: float = 100                   # tolerances that the error may be
    more: dict[str, Any] = field(default_factory=dict)  # of the model

    def at_end(self, method: str, tolerance: float) -> Any:
        """The run."""
        more = {**self.more, "history": self.history} if self.history else self.more
        model = my.with_located_switches(my.model(self.equations, **more))
        absolute = {state: tolerance * size for state, size in zip(self.equations, self.sizes_of_states)}
        return my.solve(model, start=self.initial, time=(self.begin, self.end), method=method, rtol=tolerance,
                        atol=absolute, history_steps=65536)

    @property
    def sizes_of_states(self) -> Sequence[float]:
        """One for each."""
        return self.sizes or [1] * len(self.equations)


def problems() -> dict[str, Problem]:
    """By their names."""
    return {**of_ddetst(), **neutral(), **with_closed_solutions(), **of_radar5()}


def of_ddetst() -> dict[str, Problem]:
    """Those of Enright and Hayashi, and the chain."""
    u, v, w, z = my.states("u v w z")
    a1 = past(u, 14)
    of = {"A1": Problem({u: 0.2 * a1 / (1 + a1**10) - 0.1 * u}, 0, 500, {u: 0.5})}
    leukemia = 10 * u / (1 + 40 * v)
    of["A2"] = Problem({u: 1.1 / (1 + math.sqrt(10) * past(u, 20)**1.25) - leukemia, v: 10 * leukemia - 2.43 * v},
                       0, 100, {u: 1.05767027 / 3, v: 1.030713491 / 3})
    of["B1"] = Problem({u: 1 - past(u, t - my.exp(1 - 1 / t))}, 0.1, 10, {u: math.log(0.1)}, {u: my.log(t)},
                       lambda end: [math.log(end)])
    of["B2"] = Problem({u: my.where(past(u, t / 2) < 0, 1, -1) - u}, 0, 2 * math.log(66), {u: 1.0},
                       exact=lambda end: [66 * math.exp(-end) - 1])
    of["C1"] = Problem({u: -2 * past(u, 1 + abs(u)) * (1 - u**2)}, 0, 30, {u: 0.5})
    c2 = past(u, v)
    of["C2"] = Problem({u: -2 * c2, v: (abs(c2) - abs(u)) / (1 + abs(c2))}, 0, 40, {u: 1.0, v: 0.5}, most=1e4)
    sign = my.state("sign")
    size = past(sign, v) * c2  # abs(c2)
    of["C2, events"] = Problem({u: -2 * c2, v: (size - sign * u) / (1 + size), sign: 0}, 0, 40,
                               {u: 1.0, v: 0.5, sign: 1.0}, more={"events": my.event(u, do={sign: -sign})})
    for name, (s0, lag, gamma, q, k, a, end, u0, w0, before) in {
            "C3": (0.0031, 6.0, 0.001, 0.0275, 2.8, 6570, 300, 3.325, 120, my.where(t < -6, 9.5, 10)),
            "C4": (0.00372, 3.0, 0.1, 0.00178, 6.65, 15600, 100, 3.5, 50, None)}.items():
        of[name] = Problem({u: s0 * past(v, lag) - gamma * u - q, v: a / (1 + 0.0382 * u**6.96) - k * v,
                            w: 1 - q * my.exp(gamma * w) / (s0 * past(v, lag + w))},
                           0, end, {u: u0, v: 10.0, w: w0}, {} if before is None else {v: before})
    d1 = my.exp(1 - v)
    of["D1"] = Problem({u: v, v: -past(v, t - d1) * v**2 * d1}, 0.1, 5, {u: math.log(0.1), v: 10.0},
                       {u: my.log(t), v: 1 / t}, lambda end: [math.log(end), 1 / end])
    r1, r2, alpha, delta = 0.02, 0.005, 3, 0.01
    seen = past(u, z) * past(v, z)
    of["D2"] = Problem({u: -r1 * u * v + r2 * w, v: -r1 * u * v + alpha * r1 * seen, w: r1 * u * v - r2 * w,
                        z: 1 + (3 * delta - u * v - w) * my.exp(delta * z) / (seen + past(w, z))},
                       0, 40, {u: 5.0, v: 0.1, w: 0.0, z: 0.0})
    of["chain"] = Problem({u: past(u, 1), v: past(u, 1) + past(v, 0.2), w: v}, 0, 5, {u: 1.0, v: 1.0, w: 1.0})
    return of


def neutral() -> dict[str, Problem]:
    """The neutral ones of Enright and Hayashi."""
    u, v = my.states("u v")
    r, c = math.pi / math.sqrt(3) + 1 / 20, math.sqrt(3) / (2 * math.pi) - 1 / 25
    of = {"E1": Problem({u: r * u * (1 - past(u, 1) - c * past_slope(u, 1))}, 0, 40, {u: 2.0}, {u: 2 + t})}
    eaten = u**2 / (u**2 + 1)
    of["E2"] = Problem({u: u * (1 - past(u, 0.42) - 2.9 * past_slope(u, 0.42)) - v * eaten, v: v * (eaten - 0.1)}, 0, 2,
                       {u: 0.33, v: 2.22}, {u: 0.33 - t / 10})
    of["F1"] = Problem({u: 2 * my.cos(2 * t) * past(u, t / 2)**(2 * my.cos(t)) + my.log(past_slope(u, t / 2))
                        - my.log(2 * my.cos(t)) - my.sin(t)}, 0, 1, {u: 1.0}, {u: 1 + 2 * t},
                       lambda end: [math.exp(math.sin(2 * end))])
    of["F2"] = Problem({u: past_slope(u, 0.5 - t)}, 0.25, 0.499, {u: math.exp(-0.0625)}, {u: my.exp(-t**2)}, f2_at)
    seen = 0.5 * t * (1 - my.cos(2 * math.pi * t))
    for name, size in {"F3": 0.2, "F4": 0.4, "F5": 0.6}.items():
        of[name] = Problem({u: my.exp(-u) + size * (my.sin(past_slope(u, t - seen)) - my.sin(1 / (3 + seen)))}, 0, 10,
                           {u: math.log(3)}, {u: my.log(t + 3)}, lambda end: [math.log(end + 3)])
    of["G1"] = Problem({u: -past_slope(u, u**2 / 4)}, 0, 1, {u: 1.0}, {u: 1 - t}, lambda end: [end + 1])
    of["G2"] = Problem({u: -past_slope(u, t + 2 - u)}, 0, 1, {u: 1.0}, {u: 1 - t}, lambda end: [end + 1])
    of["H1"] = Problem({u: -4 * t * u**2 / (4 + my.log(my.cos(2 * t))**2) + my.tan(2 * t)
                        + 0.5 * my.atan(past_slope(u, t / (1 + u**2)))}, 0, 0.225 * math.pi, {u: 0.0},
                       exact=lambda end: [-math.log(math.cos(2 * end)) / 2])
    lag, a = t * my.maximum(1 - u**2, 0), t * my.sin(t)**2
    for name, size in {"H2": 0.1, "H3": 0.3, "H4": 0.5}.items():
        of[name] = Problem({u: my.cos(t) * (1 + past(u, lag)) + size * u * past_slope(u, lag)
                            + (1 - size) * my.sin(t) * my.cos(a) - my.sin(t + a)}, 0, math.pi, {u: 0.0}, {u: my.sin(t)},
                           lambda end: [math.sin(end)])
    return of


def f2_at(end: float) -> list[float]:
    """The solution of F2, exp(-4^i t^2 + b t + c) / 2^i + k in its piece i."""
    b = c = k = 0.0
    i = 0

    def growing(time: float) -> float:
        return math.exp(-4.0**i * time**2 + b * time + c) / 2.0**i

    while (following := (1 - 2.0**-(i + 1)) / 2) < end:
        k += growing(following)
        b, c = 2 * (4.0**i + b), c - 4.0**(i - 1) - b / 2
        i += 1
        k -= growing(following)
    return [growing(end) + k]


def with_closed_solutions() -> dict[str, Problem]:
    """Equations of one state, most with delays that depend on it."""
    u = my.state("u")
    of = {"linear": Problem({u: -1.2 * past(u, 1)}, 0, 8, {u: 1.0}, exact=lambda end: [
        sum((-1.2)**n * (end - (n - 1))**n / math.factorial(n) for n in range(int(end) + 2))])}
    of["pantograph"] = Problem({u: -past(u, t / 2)}, 0, 6, {u: 1.0}, exact=lambda end: [
        sum((-end)**n * 0.5**(n * (n - 1) // 2) / math.factorial(n) for n in range(40))])
    # t to e, exp(t / e) to e^2, and from there:
    of["logarithm"] = Problem({u: u * past(u, t - my.log(u)) / t}, 1, 12, {u: 1.0}, exact=lambda end: [
        (math.e / (3 - math.log(end)))**math.e])
    # sqrt(t) to 2, and from there:
    of["root"] = Problem({u: past(u, t - (u - math.sqrt(2) + 1)) / (2 * my.sqrt(t))}, 1, 5, {u: 1.0},
                         exact=lambda end: [end / 4 + 0.5 + (1 - math.sqrt(0.5)) * math.sqrt(end)])
    # t / 2 to 4, 2 exp(t / 2 - 2) to 4 + 2 log 2, and from there:
    of["iterated"] = Problem({u: past(u, t - u)}, 2, 5.5, {u: 1.0}, {u: 0.5}, lambda end: [
        4 - 2 * math.log(5 + 2 * math.log(2) - end)])
    # The time seen, u - 2, touches the beginning again and again and does not pass it.
    of["touch"] = Problem({u: my.cos(t) * past(u, t - (u - 2))}, 0, 10, {u: 1.0}, exact=lambda end: [1 + math.sin(end)])
    return of


def of_radar5() -> dict[str, Problem]:
    """Those of Guglielmi and Hairer."""
    a, b, c, d, e, f = my.states("a b c d e f")
    z = 1 / (1 + 0.0005 * past(d, 4)**3)
    of = {"enzyme": Problem({a: 10.5 - z * a, b: z * a - b, c: b - c, d: c - 0.5 * d}, 0, 160,
                            {a: 60.0, b: 10.0, c: 10.0, d: 20.0})}
    r, s, first, second = 5e4, 1e5, my.where(t < 35, 0, 1), my.where(t < 197, 0, 1)
    a_e, b_e, c_e, a_f, b_f, c_f = (past(state, t - by) for by in (e, f) for state in (a, b, c))
    of["waltman"] = Problem(
        {a: -r * a * b - s * a * d, b: -r * a * b + 1.8 * r * a_e * b_e * first, c: r * a * b,
         d: -s * a * d - 0.002 * d + 20 * r * a_f * b_f * second, e: first * (a * b + c) / (a_e * b_e + c_e),
         f: second * (1e-12 + b + c) / (1e-12 + b_f + c_f)},
        0, 300, {a: 5e-6, b: 1e-15, c: 0.0, d: 0.0, e: 0.0, f: 0.0}, sizes=[1e-12] * 4 + [1, 1],
        more={"stops": [my.stop(35), my.stop(197)]}, most=1000,
        exact=lambda _: [6.135395e-16, 3.377503430e-07, 4.221881453e-07, 2.142869321e-06, math.nan, math.nan])
    s = past(b, 0.15)
    of["oregonator"] = Problem({a: 1.34 * 0.06 * b - 1.6e9 * a * s + 480 * a - 8e7 * a**2,
                                b: -1.34 * 0.06 * b - 1.6e9 * a * s + 480 * a}, 0, 100.5, {a: 1e-10, b: 1e-5},
                               method="rodas_5p", sizes=[1e-9, 1e-9], most=1000,
                               exact=lambda _: [2.749853015e-10, 3.559048987e-07])
    of["hepatitis"] = hepatitis()
    s = past(b, 1e-4)
    of["robertson"] = Problem({a: -0.04 * a + 1e4 * s * c, b: 0.04 * a - 1e4 * s * c - 3e7 * b**2, c: 3e7 * b**2},
                              0, 10, {a: 1.0, b: 0.0, c: 0.0}, method="rodas_5p", sizes=[1, 1e-5, 1],
                              exact=lambda _: [0.841370354052, 1.623390467e-5, 0.158613412043])
    return of


def hepatitis() -> Problem:
    """An immune response to hepatitis B: G. A. Bocharov, G. I. Marchuk, A. A. Romanyukha, Numer. Math. 73 (1996)
    131-148, as in RADAR5."""
    virus, infected, destroyed, antigen, helper_t, helper_b, killer, b_cell, plasma, antibody = states = my.states(
        "virus infected destroyed antigen helper_t helper_b killer b_cell plasma antibody")
    cells = 5e-13  # of the liver
    healthy, share = cells - infected - destroyed, 1 - destroyed / cells
    division_t, division_b = (share * 2 * past(antigen, 0.6) * past(helper, 0.6) for helper in (helper_t, helper_b))
    division_killer = share * 16 * past(antigen, 2.0) * past(helper_t, 2.0) * past(killer, 2.0)
    division_b_cell = share * 16 * past(antigen, 2.0) * past(helper_b, 2.0) * past(b_cell, 2.0)
    equations = {
        virus: 83 * infected + 5 * 6.6e14 * infected * killer - 3e11 * virus * antibody - 0.4 * virus
        - 2.5e7 * virus * healthy,
        infected: 2.3e9 * virus * healthy - 6.6e14 * infected * killer - 0.052 * infected,
        destroyed: 6.6e14 * infected * killer + 0.052 * infected - 0.15 * destroyed,
        antigen: 9.4e9 * 1e-15 * virus - 1.2 * antigen,
        helper_t: 2.7e16 * (division_t - antigen * helper_t) - 5.3e27 * antigen * helper_t * killer
        + (1e-18 - helper_t),
        helper_b: 2.7e16 * (division_b - antigen * helper_b) - 8e28 * antigen * helper_b * b_cell
        + (1e-19 - helper_b),
        killer: 5.3e33 * (division_killer - antigen * helper_t * killer) - 1.6e14 * infected * killer
        + 0.4 * (1e-18 - killer),
        b_cell: 8e32 * (division_b_cell - antigen * helper_b * b_cell) + 0.1 * (1e-18 - b_cell),
        plasma: 1.7e30 * share * 3 * past(antigen, 3.0) * past(helper_b, 3.0) * past(b_cell, 3.0)
        + 0.4 * (4.3e-22 - plasma),
        antibody: 0.85e7 * plasma - 8.6e11 * antibody * virus - 0.043 * antibody}
    begin = [2.9e-16, 0, 0, 0, 1e-18, 1e-19, 1e-18, 1e-18, 4.3e-22, 0.85e7 * 4.3e-22 / 0.043]
    found = [0, 0, 8.39560021826e-15, 4.8553037e-27, 9.99996681079e-19, 1.00002258430e-19, 2.80893978329e-11,
             2.24129636778e-12, 1.41701021850e-17, 5.94452134007e-8]
    return Problem(equations, 0, 130, dict(zip(states, begin)), method="rodas_5p", exact=lambda _: found,
                   sizes=[1e-16, 1e-16, 1e-14, 1e-26, 1e-18, 1e-19, 1e-10, 1e-11, 1e-16, 1e-7])


def main() -> int:
    """The table."""
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--tolerance", type=float, default=1e-9)
    options.add_argument("--method", default="dormand_prince_5")
    options.add_argument("--only")
    chosen = options.parse_args()
    print("problem,method,status,steps,rejected,error in tolerances")
    fine = True
    for name, problem in problems().items():
        if chosen.only not in (None, name):
            continue
        method = problem.method or chosen.method
        run = problem.at_end(method, chosen.tolerance)
        names = [str(state) for state in problem.equations]
        found = np.array([run[state][0] for state in names])
        if problem.exact is not None:
            right = np.array(problem.exact(problem.end))
        else:
            tight = problem.at_end("verner_7", 1e-13)
            right = np.array([tight[state][0] for state in names])
        known = ~np.isnan(right)
        error = float(np.max((np.abs(found - right) / np.maximum(problem.sizes_of_states, np.abs(right)))[known]))
        fine = fine and error <= problem.most * chosen.tolerance
        print(f'"{name}",{method},{run.status[0]},{run.accepted_steps[0]},{run.rejected_steps[0]},'
              f"{error / chosen.tolerance:.3g}", flush=True)
    return 0 if fine else 1


if __name__ == "__main__":
    sys.exit(main())
