#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Times a grid of van der Pol oscillators by Myriad and by other packages of Python, from NumPy arrays to NumPy arrays:
x0 from 1 to 2 by mu from 1 to 3, until t = 20, in double precision, relative tolerance 1e-3, absolute tolerance 1e-6.

All take Dormand and Prince's method of order five, except where it says otherwise, and for heyoka, whose Taylor method
has the relative tolerance and an order of its own, and is more accurate than asked for. What makes them comparable, and
what does not:

  Myriad       compiled for the CPU, the same with dormand_prince_8, interpreted (a tape), and compiled for the GPU if
               there is one
  diffrax      jax_enable_x64, vmap and jit; the grid is shared out over a device of XLA per core, in threads. Lanes of
               one vmap step together until the last one is done
  heyoka       batches as wide as the CPU's registers, and an integrator per core, in threads; fast_math
  SciPy        solve_ivp in a loop over a part of the grid, in one process; its time is scaled to the whole grid
  CuBIE        on a GPU alone; the grid is given by name. Its results have the initial values of x too, always

Errors are those of x at the end at 64 places of the grid, against SciPy's DOP853 at a tolerance of 1e-12. "cold" is the
first call of a fresh process with an empty cache, imports excluded, all compilation included; "warm" are later calls,
compilation excluded: their median, and the shortest, of which "times_the_first" are the ratios, as others that use the
machine disturb it least; "cpu" is the processor time of all cores. Steps are means per instance. What is not installed
is left out, with a line.

Writes CSV; each program runs in a process of its own."""

import argparse
import copy
import csv
import importlib.metadata
import importlib.util
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np

END = 20.0  # of time
RTOL, ATOL = 1e-3, 1e-6  # unless options say otherwise
CORES = len(os.sched_getaffinity(0))
PARTS = 64  # places whose error is known


def grid(side):
    """x0 and mu of all instances."""
    x, mu = np.meshgrid(np.linspace(1, 2, side), np.linspace(1, 3, side), indexing="ij")
    return x.ravel(), mu.ravel()


def places(side):
    """The numbers of the instances whose errors are examined, which SciPy alone integrates."""
    return np.random.default_rng(1).choice(side * side, min(PARTS, side * side), replace=False)


# Each program is a function of the grid's side that returns the call to time, which returns x at the end of all
# instances, or of those examined, accepted steps per instance (None if unknown), and a factor for its time.


def by_myriad(side, **options):
    import myriad_ode as my

    x, v, mu = *my.states("x v"), my.parameter("mu")
    model = my.model({x: v, v: mu * (1 - x * x) * v - x})
    x_values, mu_values = np.linspace(1, 2, side), np.linspace(1, 3, side)

    def call():
        run = my.solve(model, my.grid({x: x_values, mu: mu_values}), start={v: 0}, time=(0, END), rtol=RTOL, atol=ATOL,
                       **{"method": "dormand_prince_5", **options})
        return np.asarray(run["x"]), run.report.accepted_steps / run.size, 1

    return call


def by_diffrax(side):
    os.environ["XLA_FLAGS"] = f"--xla_force_host_platform_device_count={CORES}"
    os.environ["JAX_PLATFORMS"] = "cpu"
    import diffrax
    import jax
    import jax.numpy as jnp

    jax.config.update("jax_enable_x64", True)
    term = diffrax.ODETerm(lambda t, y, mu: jnp.array([y[1], mu * (1 - y[0]**2) * y[1] - y[0]]))
    control = diffrax.PIDController(rtol=RTOL, atol=ATOL)

    def one(x, mu):
        done = diffrax.diffeqsolve(term, diffrax.Dopri5(), 0.0, END, None, jnp.array([x, 0.0]), mu,
                                   stepsize_controller=control, saveat=diffrax.SaveAt(t1=True), max_steps=4096)
        return done.ys[-1], done.stats["num_accepted_steps"]

    all_of = jax.jit(jax.vmap(one))
    x, mu = grid(side)

    def part(device, x, mu):
        y, steps = all_of(jax.device_put(x, device), jax.device_put(mu, device))
        return np.asarray(y[:, 0]), np.asarray(steps)

    def call():
        with ThreadPoolExecutor(CORES) as pool:  # places next to each other cost about the same
            parts = list(pool.map(part, jax.devices(), (x[k::CORES] for k in range(CORES)),
                                  (mu[k::CORES] for k in range(CORES))))
        ends, steps = np.empty_like(x), 0
        for k, (y, taken) in enumerate(parts):
            ends[k::CORES], steps = y, steps + taken.sum()
        return ends, steps / x.size, 1

    return call


def by_heyoka(side):
    import heyoka

    x_of, v_of = heyoka.make_vars("x", "v")
    equations = [(x_of, v_of), (v_of, heyoka.par[0] * (1 - x_of**2) * v_of - x_of)]
    width = heyoka.recommended_simd_size()
    x, mu = grid(side)
    padded = -(-x.size // width) * width
    x, mu = np.resize(x, padded).reshape(-1, width), np.resize(mu, padded).reshape(-1, width)

    def part(number, made):
        ends, steps = np.empty_like(x[number::CORES]), 0
        for k, (start, parameter) in enumerate(zip(x[number::CORES], mu[number::CORES])):
            made.set_time(0.0)
            made.state[0], made.state[1], made.pars[0] = start, 0.0, parameter
            made.propagate_until(END)
            ends[k], steps = made.state[0], steps + sum(taken[3] for taken in made.propagate_res)
        return ends, steps

    integrators = []

    def call():
        if not integrators:  # compiled in the first call
            first = heyoka.taylor_adaptive_batch(equations, np.zeros((2, width)), pars=np.zeros((1, width)), tol=RTOL,
                                                 compact_mode=False, fast_math=True)
            integrators.extend([first] + [copy.deepcopy(first) for _ in range(CORES - 1)])
        with ThreadPoolExecutor(CORES) as pool:
            parts = list(pool.map(part, range(CORES), integrators))
        ends = np.empty_like(x)
        for k, (y, _) in enumerate(parts):
            ends[k::CORES] = y
        return ends.ravel()[:side * side], sum(steps for _, steps in parts) / padded, 1

    return call


def by_scipy(side):
    from scipy.integrate import solve_ivp

    chosen = places(side)
    x, mu = (values[chosen] for values in grid(side))

    def call():
        ends, steps = [], 0
        for start, m in zip(x, mu):
            done = solve_ivp(lambda t, y, m=m: (y[1], m * (1 - y[0]**2) * y[1] - y[0]), (0, END), (start, 0),
                             method="RK45", rtol=RTOL, atol=ATOL)
            ends.append(done.y[0, -1])
            steps += len(done.t) - 1
        return np.array(ends), steps / len(x), side * side / len(x)

    return call


def by_cubie(side):
    import cubie

    system = cubie.create_ODE_system(["dx = v", "dv = mu * (1 - x * x) * v - x"], states={"x": 1.0, "v": 0.0},
                                     parameters={"mu": 1.0}, precision=np.float64)
    solver = cubie.Solver(system, algorithm="rk45", rtol=RTOL, atol=ATOL, save_variables=["x"])
    start, parameters = {"x": np.linspace(1, 2, side), "v": [0.0]}, {"mu": np.linspace(1, 3, side)}

    def call():
        done = solver.solve(start, parameters, duration=END, grid_type="combinatorial")  # mu varies faster
        return done.time_domain_array[-1, 0], None, 1  # a view: the next call writes there again

    return call


def gpu():
    """Whether Myriad can use a GPU here."""
    if importlib.util.find_spec("myriad_ode") is None:
        return False
    from myriad_ode import _core
    return not _core.no_gpu()


#: by name: the package, where it runs, and how
PROGRAMS = {
    "myriad": ("myriad_ode", f"CPU, {CORES} cores", lambda side: by_myriad(side, device="cpu")),
    "myriad order 8": ("myriad_ode", f"CPU, {CORES} cores",
                       lambda side: by_myriad(side, device="cpu", method="dormand_prince_8")),
    "myriad interpreted": ("myriad_ode", f"CPU, {CORES} cores", lambda side: by_myriad(side, interpreted=True)),
    "heyoka": ("heyoka", f"CPU, {CORES} cores", by_heyoka),
    "diffrax": ("diffrax", f"CPU, {CORES} cores", by_diffrax),
    "scipy": ("scipy", "CPU, one process", by_scipy),
    "myriad gpu": ("myriad_ode", "GPU", lambda side: by_myriad(side, device="cuda")),
    "cubie": ("cubie", "GPU", by_cubie),
}


def measure(name, side, calls):
    """What one program did, in this process."""
    call = PROGRAMS[name][2](side)

    def timed():
        begin, busy = time.perf_counter(), time.process_time()
        ends, steps, factor = call()
        return factor * (time.perf_counter() - begin), factor * (time.process_time() - busy), ends, steps

    cold, *_ = timed()
    warm, busy = [], []
    for _ in range(calls):  # each gives back the memory of the results before
        seconds, cpu, ends, steps = timed()
        warm.append(seconds)
        busy.append(cpu)
    if name != "scipy":  # which integrates no others
        ends = ends[places(side)]
    return dict(cold=cold, warm=statistics.median(warm), least=min(warm), busy=min(busy),
                steps=steps, ends=ends.tolist())


def reference(side):
    """x at the end at the places that are examined."""
    from scipy.integrate import solve_ivp

    x, mu = (values[places(side)] for values in grid(side))
    return np.array([solve_ivp(lambda t, y, m=m: (y[1], m * (1 - y[0]**2) * y[1] - y[0]), (0, END), (start, 0),
                               method="DOP853", rtol=1e-12, atol=1e-12).y[0, -1] for start, m in zip(x, mu)])


def why_not(name):
    """Why a program cannot run here, or nothing."""
    package, where, _ = PROGRAMS[name]
    if importlib.util.find_spec(package) is None:
        return f"{package} is not installed"
    return "there is no GPU, or no NVRTC" if where == "GPU" and not gpu() else None


def version(package):
    try:
        return importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:  # unpacked rather than installed
        return getattr(importlib.import_module(package), "__version__", "unknown")


def main():
    global RTOL, ATOL
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--side", type=int, default=128, help="values of x0 and of mu (default: 128)")
    parser.add_argument("--rtol", type=float, default=RTOL, help="relative tolerance (default: 1e-3)")
    parser.add_argument("--atol", type=float, default=ATOL, help="absolute tolerance (default: 1e-6)")
    parser.add_argument("--calls", type=int, default=5, help="warm calls (default: 5)")
    parser.add_argument("--programs", nargs="+", choices=PROGRAMS, default=list(PROGRAMS), metavar="PROGRAM",
                        help=f"which of {', '.join(PROGRAMS)} (default: all that are here)")
    parser.add_argument("--output", help="file for the table (default: standard output alone)")
    parser.add_argument("--only", choices=PROGRAMS, help=argparse.SUPPRESS)  # one of them, in this process
    options = parser.parse_args()
    RTOL, ATOL = options.rtol, options.atol
    if options.side < 1 or options.calls < 1:
        parser.error("--side and --calls are at least 1")
    if options.only:
        print(json.dumps(measure(options.only, options.side, options.calls)))
        return 0
    if importlib.util.find_spec("scipy") is None:
        parser.error("errors are found by SciPy: pip install scipy")

    print(f"grid of {options.side}^2, rtol {RTOL:g}, atol {ATOL:g}", file=sys.stderr)
    rows, failed, exact = [], False, reference(options.side)
    for name in options.programs:
        package, where, _ = PROGRAMS[name]
        if reason := why_not(name):
            print(f"{name}: left out, {reason}", file=sys.stderr)
            continue
        with tempfile.TemporaryDirectory() as cache:
            command = [sys.executable, __file__, "--only", name, "--side", options.side, "--calls", options.calls,
                       "--rtol", RTOL, "--atol", ATOL]
            caches = {"MYRIAD_CACHE_DIR": cache, "CUBIE_CACHE_DIR": cache}
            done = subprocess.run(list(map(str, command)), env={**os.environ, **caches}, text=True,
                                  stdout=subprocess.PIPE, check=False)
        if done.returncode:
            print(f"{name}: failed", file=sys.stderr)
            failed = True
            continue
        found = json.loads(done.stdout.splitlines()[-1])
        errors = np.abs(np.array(found["ends"]) - exact)
        rows.append({"program": name, "version": version(package), "where": where, "instances": options.side**2,
                     "warm_ms": f"{1e3 * found['warm']:.4g}", "shortest_ms": f"{1e3 * found['least']:.4g}",
                     "times_the_first": f"{found['least'] / (rows[0]['_'] if rows else found['least']):.3g}",
                     "cpu_ms": f"{1e3 * found['busy']:.4g}", "cold_ms": f"{1e3 * found['cold']:.4g}",
                     "steps": "" if found["steps"] is None else f"{found['steps']:.4g}",
                     "median_error": f"{np.median(errors):.2g}", "largest_error": f"{errors.max():.2g}",
                     "_": found["least"]})
        print(f"{name}: done", file=sys.stderr)
    if not rows:
        return 1
    names = [name for name in rows[0] if name != "_"]
    for file in filter(None, (sys.stdout, options.output and open(options.output, "w", encoding="utf-8"))):
        writer = csv.DictWriter(file, names, extrasaction="ignore", lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
        file.flush()
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
