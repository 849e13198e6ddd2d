#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What sensitivities cost: times over those of the same call without them, for 1, 2, 4 and 8 components, and the
largest error of the derivatives against a run with tight tolerances, in parts of the largest derivative by the same
component. The table of docs/fits.md. On a CPU the time is that of one thread's clock, the best of several calls.

Usage: sensitivities.py [--device DEVICE] [--instances N] [--calls N] [--control] [--models NAME...]"""

import argparse
import time

import numpy as np

import myriad_ode as my

COUNTS = (1, 2, 4, 8)


def lorenz():
    x, y, z = my.states("x y z")
    s, r, b, c, e = p = my.parameters("s r b c e")
    model = my.model({x: s * (y - x), y: x * (r - z) - c * y, z: e * x * y - b * z}, name="lorenz")
    return dict(model=model, vary=r, over=(0.5, 28), at={s: 10, b: 8 / 3, c: 1, e: 1}, start={x: 1, y: 0.5, z: 0.2},
                time=(0, 10), by=[*p, x, y, z], rtol=1e-7, atol=1e-7)


def morris_lecar():
    """The neuron of Morris and Lecar (Biophys. J. 35, 1981, 193)."""
    V, w = my.states("V w")
    current, g_Ca, g_K, g_L, V1, V2, V3, V4 = p = my.parameters("current g_Ca g_K g_L V1 V2 V3 V4")
    model = my.model({
        V: (current - g_L * (V + 60) - g_Ca * 0.5 * (1 + my.tanh((V - V1) / V2)) * (V - 120) - g_K * w * (V + 84)) / 20,
        w: 0.04 * (0.5 * (1 + my.tanh((V - V3) / V4)) - w) * my.cosh((V - V3) / (2 * V4))}, name="morris_lecar")
    return dict(model=model, vary=current, over=(20, 150), start={V: -60, w: 0.01}, time=(0, 200), by=list(p),
                at={g_Ca: 4.4, g_K: 8, g_L: 2, V1: -1.2, V2: 18, V3: 2, V4: 30}, rtol=1e-7, atol=1e-7)


def robertson():
    """The reactions of Robertson (1966) with inflow and dilution."""
    a, b, c = my.states("a b c")
    k1, k2, k3, inflow, dilution = p = my.parameters("k1 k2 k3 inflow dilution")
    model = my.model({a: inflow - dilution * a - k1 * a + k3 * b * c,
                      b: k1 * a - k3 * b * c - k2 * b * b - dilution * b,
                      c: k2 * b * b - dilution * c}, name="robertson")
    return dict(model=model, vary=k1, over=(0.01, 0.1), at={k2: 3e7, k3: 1e4, inflow: 1e-4, dilution: 1e-4},
                start={a: 1, b: 1e-5, c: 1e-3}, time=(0, 1000), by=[*p, a, b, c], method="rodas_5p", rtol=1e-6,
                atol=1e-10)


def measured(call, calls, cpu):
    clock = time.process_time if cpu else time.perf_counter
    best = np.inf
    for _ in range(calls + 1):  # the first compiles
        begin = clock()
        run = my.solve(**call)
        best = min(best, clock() - begin)
    return best, run


def main():
    problems = {f.__name__: f for f in (lorenz, morris_lecar, robertson)}
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--device", default="cpu:1")
    parser.add_argument("--instances", type=int, default=4096)
    parser.add_argument("--calls", type=int, default=5)
    parser.add_argument("--control", action="store_true", help="errors of derivatives take part in choosing the steps")
    parser.add_argument("--counts", type=int, nargs="+", default=COUNTS)
    parser.add_argument("--models", nargs="+", choices=problems, default=list(problems))
    options = parser.parse_args()
    cpu = options.device.startswith("cpu")
    print("model,components,milliseconds,cost,goal,steps,error")
    for name in options.models:
        problem = problems[name]()
        vary, over, at, by = (problem.pop(key) for key in ("vary", "over", "at", "by"))
        call = {**problem, "sweep": {**at, vary: np.linspace(*over, options.instances)}, "device": options.device}
        few = slice(None, None, max(options.instances // 64, 1))
        reference = my.solve(**{**call, "sweep": {**at, vary: np.linspace(*over, options.instances)[few]},
                                "rtol": 1e-11, "atol": 1e-14 if name == "robertson" else 1e-12},
                             free=by[:max(options.counts)])
        plain, run = measured(call, options.calls, cpu)
        print(f"{name},0,{1e3 * plain:.1f},1,1,{run.accepted_steps.mean():.1f},", flush=True)
        for count in options.counts:
            seconds, run = measured({**call, "free": by[:count], "sensitivity_control": options.control},
                                    options.calls, cpu)
            error = max(np.max(abs(run.sensitivity[c, k][few] - reference.sensitivity[c, k])
                               / np.max(abs(reference.sensitivity[c, k])))
                        for c in reference.sensitivity for k in by[:count])
            print(f"{name},{count},{1e3 * seconds:.1f},{seconds / plain:.2f},{1 + 0.6 * count:.1f},"
                  f"{run.accepted_steps.mean():.1f},{error:.1e}", flush=True)


if __name__ == "__main__":
    main()
