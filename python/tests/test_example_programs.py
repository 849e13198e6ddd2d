# SPDX-License-Identifier: MIT
"""The sweeps of the C++ examples in Python, with the numbers that the programs write: bit by bit where the inputs are
in the programs' tables, as both compilers add and multiply without contraction, else as near as rounded inputs allow.

The programs are those of a build of this checkout, or in the folder that MYRIAD_EXAMPLES names; without them these
tests are skipped. Models with events that the interpreter can run (those without round a little differently there), and
those that other tests compile, are compared always, the others with --all. What a random number in a hook draws, Python
takes from the program's table. The method of examples/own_method is a tableau of its user, and Python has methods by
name alone, so that its model is compared with the library's method that the program runs too."""

import csv
import os
import pathlib
import re
import subprocess
import types

import numpy as np
import pytest

import example_models
import myriad_ode as my

root = pathlib.Path(__file__).resolve().parents[2]
folders = [pathlib.Path(os.environ["MYRIAD_EXAMPLES"]).resolve()] if "MYRIAD_EXAMPLES" in os.environ else [
    root / "build" / preset / "examples" for preset in ("ci", "release", "dev", "nightly")]
tau = 2 * np.pi


@pytest.fixture
def run_program(tmp_path):
    """A function that runs a program of the examples, and returns what it prints."""
    def run(name, *options):
        programs = [p for folder in folders for p in folder.glob(f"*/{name}") if p.is_file() and os.access(p, os.X_OK)]
        if not programs:
            pytest.skip(f"the example {name} is not built in {' or '.join(map(str, folders))}")
        return subprocess.run([programs[0], *map(str, options)], cwd=tmp_path, capture_output=True, text=True,
                              check=True).stdout
    return run


def columns(text):
    """The columns of a table of comma-separated values by name, numbers where all are; comments are skipped."""
    rows = list(csv.reader(line for line in text.splitlines() if line and not line.startswith("#")))
    made = {}
    for name, *values in zip(*rows):
        try:
            made[name] = np.array(values, float)
        except ValueError:
            made[name] = np.array(values)
    return made


@pytest.fixture
def run_sweep(run_program, tmp_path):
    """A function that runs a program that sweeps, on the CPU, and returns its table."""
    def run(name, **options):
        given = [text for key, value in options.items() for text in ("--" + key.replace("_", "-"), value)]
        run_program(name, "--quiet", "--device", "cpu", "--output", "table.csv", *given)
        return columns((tmp_path / "table.csv").read_text())
    return run


def first_of(table, name, count):
    """One value per instance, of a table with as many rows for each."""
    return table[name].reshape(count, -1)[:, 0]


def same(table, run, names, shape=None):
    for name in names:
        found, expected = np.asarray(run[name]), table[name].reshape(np.shape(run[name]) if shape is None else shape)
        assert np.array_equal(found, expected, equal_nan=True), (name, np.abs(found - expected).max())
    statuses = run.status
    if "status" in table:
        assert np.array_equal(first_of(table, "status", run.size), statuses)


def as_close(*names):
    """Options of events that the C++ programs locate within 1e-6."""
    return {name: dict(tolerance=1e-6) for name in names}


every = pytest.mark.skipif("not config.getoption('--all')", reason="compiles models that no other test has: --all")


def test_quickstart(run_program):
    table = columns(run_program("quickstart"))  # to six digits
    run = my.solve(example_models.oscillator(), {"k": np.linspace(0.2, 0.3, 4608), "B": 0.3},
                   start={"x": -0.5, "v": -0.1}, time=(0, tau), phases=288, rtol=1e-9, record=dict(
                       from_phase=256, states="x"), method="cash_karp", device="cpu")
    np.testing.assert_allclose(run["x"].ravel(), table["x"], rtol=1e-5, atol=1e-9)


def test_duffing(run_sweep):
    table = run_sweep("duffing", instances=97, transient=8, phases=4)
    names = ["x", "v", "x_local_max", "v_second_zero", "x_global_max", "zeros"]
    run = my.solve(example_models.duffing(), {"k": first_of(table, "k", 97), "B": 0.3}, start={"x": -0.5, "v": -0.1},
                   time=(0, tau), phases=12, rtol=1e-9, atol=1e-9, step=1e-2, minimum_step=1e-12, maximum_step=1e6,
                   record=dict(from_phase=8, states=names), method="cash_karp", interpreted=True,
                   events=as_close("local_maximum", "zero"))
    same(table, run, names)


def test_overlap(run_sweep, tmp_path):
    run_sweep("overlap", instances=97, phases=3, chunks=1, solvers=1)
    table = columns((tmp_path / "table_chunks" / "1_of_1.csv").read_text())
    run = my.solve(example_models.duffing(), {"k": table["k"], "B": 0.3}, start={"x": -0.5, "v": -0.1}, time=(0, tau),
                   phases=3, rtol=1e-9, atol=1e-9, method="cash_karp", interpreted=True,
                   events=as_close("local_maximum", "zero"))
    same(table, run, ["x", "v", "x_global_max", "zeros"])


def test_studies(run_program, tmp_path):
    netCDF4 = pytest.importorskip("netCDF4")
    run_program("studies")
    with netCDF4.Dataset(tmp_path / "duffing_study.nc") as file:
        written = {name: np.asarray(file[name][...]) for name in ("k", "x_start", "v_start", "x", "v_end")}
    sweep = my.grid(k=written["k"], x=written["x_start"], B=0.3)
    run = my.solve(example_models.oscillator(), {"k": sweep.values("k"), "B": 0.3},
                   start={"x": sweep.values("x"), "v": written["v_start"].ravel()}, time=(0, tau), phases=68, rtol=1e-9,
                   record=dict(from_phase=64, states="x"), method="cash_karp", device="cpu")
    assert np.array_equal(run["x"], written["x"].reshape(run.size, -1))
    assert np.array_equal(run["v"], written["v_end"].ravel())


def test_moving(run_program):
    table = columns(run_program("moving"))
    run = my.solve(example_models.van_der_pol(), {"mu": table["mu"]}, start={"x": 1, "v": 0}, time=(0, 20), rtol=1e-8,
                   atol=1e-8, method="dormand_prince_5", device="cpu")
    same(table, run, ["x", "v"])


valves = dict(kappa=1.25, delta=10, beta=20, restitution=0.8, rest_band=1e-6)
valve_options = dict(start={"y": 0.2, "v": 0, "u": 0}, time=(0, np.inf), rtol=1e-10, step=1e-2, minimum_step=1e-12,
                     maximum_step=1e6, accumulation_limit=25, method="cash_karp")


def test_relief_valve(run_sweep):
    table = run_sweep("relief_valve", instances=97, transient=12, phases=4)
    names = ["y_min", "y_max", "impacts"]
    run = my.solve(example_models.relief_valve(), {"q": first_of(table, "q", 97), **valves}, phases=16, atol=1e-10,
                   record=dict(from_phase=12, accessories=names), interpreted=True,
                   events=as_close("section", "seat"), **valve_options)
    same(table, run, names)
    assert (run["impacts"] > 0).any()


@every
def test_relief_valve_contact(run_sweep):
    table = run_sweep("relief_valve_contact", instances=97, transient=40, phases=4)
    names = ["y_min", "y_max", "u_contact", "time_at_rest"]
    run = my.solve(example_models.relief_valve_contact(),
                   {"q": first_of(table, "q", 97), **valves, "slowest": 1e-4}, phases=44, atol=[1e-15, 1e-12, 1e-10],
                   events={**as_close("section"), "seat": dict(tolerance=1e-12), "opening": dict(tolerance=1e-12)},
                   record=dict(from_phase=40, accessories=names), device="cpu", **valve_options)
    same(table, run, names)
    assert (run["time_at_rest"] > 0).any()


bubble_options = dict(start={"y": 1, "v": 0}, rtol=1e-10, atol=1e-10, step=1e-2, minimum_step=1e-12, carry_on_step=True,
                      method="cash_karp")


def test_bubble_response(run_sweep):
    """At a pressure of 0.5 bar, where no bubble is chaotic; the table has rounded frequencies."""
    table = run_sweep("bubble_response", instances=37, transient=6, phases=3, pressure=0.5)
    f = 1e3 * first_of(table, "f_kHz", 37)
    run = my.solve(example_models.bubble_response(), example_models.bubble_constants(0.5e5, f, 0, f), time=(0, 1),
                   phases=9, record=dict(from_phase=6, accessories=["y_max", "maxima"]), interpreted=True,
                   **bubble_options)
    np.testing.assert_allclose(run["y_max"].ravel(), table["y_max"], rtol=1e-8)
    assert np.array_equal(run["maxima"].ravel(), table["maxima"])


@every
def test_bubble_dual_frequency(run_sweep):
    table = run_sweep("bubble_dual_frequency", instances=6, transient=6, phases=4, pressures_1=0.2, pressures_2=0.3)
    f_1, f_2 = 1e3 * table["f1_kHz"], 1e3 * table["f2_kHz"]
    run = my.solve(example_models.bubble_dual_frequency(),
                   {**example_models.bubble_constants(0.2e5, f_1, 0.3e5, f_2), "transient_phases": 6},
                   time=(0, np.inf), phases=10, carry_on=True, events={"minimum": dict(tolerance=1e-3)}, device="cpu",
                   **bubble_options)
    found = dict(expansion=run["largest"] - 1, compression=run["compression"], winding=run["winding"],
                 collapse_us=run["collapse_time"] / f_1 / 1e-6)
    for name, values in found.items():
        # times of minima are located to 1e-3 of y'
        np.testing.assert_allclose(values, table[name], rtol=1e-4 if name == "collapse_us" else 1e-6, err_msg=name)


@every
def test_duffing_trajectories(run_sweep):
    table = run_sweep("duffing_trajectories", instances=3, transient=4, phases=2)
    run = my.solve(example_models.duffing(), {"k": first_of(table, "k", 3), "B": 0.3}, start={"x": -0.5, "v": -0.1},
                   time=(0, tau), phases=6, rtol=1e-9, atol=1e-9, samples=dict(evenly=200, from_phase=4),
                   method="tsitouras_5", events={"local_maximum": dict(direction="either")}, device="cpu")
    same(table, run, ["x", "v"])
    assert np.array_equal(run.t_sample.ravel(), table["t"])


@every
def test_hybrid(run_sweep):
    table = run_sweep("hybrid", instances=97)
    belt = first_of(table, "belt", 97)
    names = ["x_slip", "x_stick", "period"]
    event = dict(direction="rising", tolerance=1e-10)
    run = my.solve(example_models.stick_slip(), {"belt": belt, "kinetic": 0.5, "breakaway": 1}, start={
        "x": 0, "v": belt, "sticks": 1, "t_slip": 0}, time=(0, np.inf), phases=3, carry_on=True, rtol=1e-10, atol=1e-10,
        events={"grip": event, "slip": {**event, "stop_after": 1}}, method="tsitouras_5",
        record=dict(from_phase=1, accessories=names), device="cpu")
    same(table, run, names)


@every
def test_poincare(run_sweep):
    table = run_sweep("poincare", instances=97, transient=20, phases=5)
    run = my.solve(example_models.roessler(), {"c": first_of(table, "c", 97), "a": 0.1, "b": 0.1},
                   start={"x": -5, "y": 0, "z": 0}, time=(0, np.inf), phases=25, rtol=1e-9, atol=1e-9,
                   carry_on_step=True, events={"section": dict(tolerance=1e-9)}, method="tsitouras_5", device="cpu",
                   record=dict(from_phase=20, states=["x", "z"], time=True))
    same({**table, "t": table["return_time"]}, run, ["x", "z", "t"])


@every
def test_lyapunov(run_sweep):
    table = run_sweep("lyapunov", instances=37, transient=20, phases=40)
    run = my.solve(my.with_tangents(example_models.lorenz(), 3, transient_phases=20),
                   {"rho": table["rho"], "sigma": 10, "beta": 8 / 3},
                   start={"x": 1, "y": 1, "z": 1}, time=(0, 0.25), phases=60, rtol=1e-8, atol=1e-8, carry_on_step=True,
                   method="tsitouras_5", device="cpu")
    exponents = my.exponents(run)
    for i in range(3):
        assert np.array_equal(exponents[:, i], table[f"lambda_{i + 1}"])


@every
def test_lyapunov_map(run_sweep):
    table = run_sweep("lyapunov_map", instances=7, transient=6, phases=12)
    call = dict(time=(0, tau), phases=18, rtol=1e-9, atol=1e-9, carry_on_step=True, method="dormand_prince_8",
                device="cpu")
    values, start = {"k": table["k"], "B": table["B"]}, {"x": 1, "v": 0.1}
    library = my.solve(my.with_tangents(example_models.forced_duffing(), transient_phases=6), values, start=start,
                       **call)
    assert np.array_equal(my.exponents(library)[:, 0], table["lambda_library"])
    begin = {name: library.start[f"{state}_tangent_1"] for name, state in (("a", "x"), ("b", "v"))}
    hand = my.solve(example_models.hand_tangent(), {**values, "transient": 6}, start={**start, **begin, "growth": 0},
                    **call)
    assert np.array_equal(hand["growth"] / (tau * 12), table["lambda_hand"])


@every
def test_monte_carlo(run_sweep):
    table = run_sweep("monte_carlo", instances=997)
    run = my.solve(example_models.epidemic(), {"R0": table["R0"], "duration": table["duration"]},
                   start={"s": 1 - 1e-4, "i": 1e-4}, time=(0, 20_000), rtol=1e-9, atol=1e-9, method="tsitouras_5",
                   device="cpu")
    same(table, run, ["peak", "day"])


@every
def test_basins(run_sweep):
    table = run_sweep("basins", instances=24)
    omega, height = 0.5, 0.3

    def potential(r):
        magnets = np.array([[0.57735026918962576, 0], [-0.28867513459481288, 0.5], [-0.28867513459481288, -0.5]])
        return 0.5 * omega**2 * r * r - sum(1 / np.sqrt((x + r)**2 + y * y + height**2) for x, y in magnets)

    saddle = min(potential(r) for r in np.linspace(0, 0.5, 20001))
    run = my.solve(example_models.magnetic_pendulum(),
                   dict(omega=omega, damping=0.2, height=height, barrier=saddle),
                   start={"x": table["x"], "y": table["y"], "u": 0, "v": 0}, time=(0, 4 * tau / omega), rtol=1e-8,
                   atol=1e-8, method="dormand_prince_8", device="cpu")
    along = np.stack([run["x"], -run["x"] / 2 + np.sqrt(0.75) * run["y"], -run["x"] / 2 - np.sqrt(0.75) * run["y"]])
    magnet = np.where(run.status == "stopped_by_user", 1 + along.argmax(axis=0), 0)
    assert np.array_equal(magnet, table["magnet"])
    # the barrier is that of the program to 1e-8, at which a last step may be one more
    assert (np.float32(run.t_last) == np.float32(table["t"])).mean() > 0.99


@every
def test_resonance(run_sweep):
    """The program goes on with the steps that it has; Python begins anew after the transient."""
    table = run_sweep("resonance", instances=9, transient=30, phases=3)
    omega, beta = table["omega"], table["beta"]
    backbone = omega * np.sqrt(np.maximum(omega**2 - 1, 0) / np.where(beta > 0, 0.75 * beta, 1))
    call = dict(sweep={"omega": omega, "beta": beta, "zeta": 0.05}, time=(0, tau / omega), rtol=1e-10, atol=1e-10,
                carry_on_step=True, method="tsitouras_5", device="cpu", events={"extremum": dict(tolerance=1e-8)})
    model, unset = example_models.response(), dict(maximum=0, minimum=0, integral=0, x_before=0, v_before=0)
    before = my.solve(model, start={"x": 0, "v": np.where((table["start"] > 0) & (beta > 0), backbone, 0), **unset},
                      phases=30, **call)
    x, v = np.array(before["x"]), np.array(before["v"])
    run = my.solve(model, start=dict(x=x, v=v, maximum=x, minimum=x, integral=0, x_before=x, v_before=v), phases=3,
                   samples=200, **call)
    found = dict(maximum=run["maximum"], minimum=run["minimum"], mean_square=run["integral"] / (3 * tau / omega),
                 maximum_sampled=run.samples["x"].max(axis=1), minimum_sampled=run.samples["x"].min(axis=1))
    for name, values in found.items():
        np.testing.assert_allclose(values, table[name], rtol=1e-6, atol=1e-6, err_msg=name)


@every
def test_stiff_chemistry(run_sweep):
    table = run_sweep("stiff_chemistry", instances=64, transient=3, phases=1)
    f, q = table["f"], 8e-4
    b, c = 1 - q - f, 4 * q * (1 + f)
    root_of = np.sqrt(b * b + c)
    x = np.where(b > 0, (b + root_of) / 2, c / 2 / (root_of - b))
    run = my.solve(example_models.oregonator(), {"f": f, "epsilon": table["epsilon"], "q": q, "ratio": 0.01},
                   start={"x": x, "y": f * x / (q + x), "z": x * (1 + 1e-3)}, time=(0, 100), phases=4, rtol=1e-6,
                   atol=1e-10, step=1e-4, carry_on_step=True, method="rodas_5p", device="cpu",
                   events={"maximum": dict(tolerance=1e-9)}, record=dict(from_phase=3, time=True))
    turned = run.status == "stopped_by_event"
    period = np.where(turned, run["t"][:, -1], 0)
    assert np.array_equal(period, table["period"]) and np.array_equal(run["z_least"], table["z_least"])
    assert np.array_equal(run["z"], table["z_largest"]) and turned.any()


@every
def test_heat_conduction(run_sweep):
    """Matrix and start are computed by NumPy, so that they differ in last places."""
    table = run_sweep("heat_conduction", instances=8, transient=16, phases=4)
    points, outer = 24, 3
    r = 2 - np.cos(np.linspace(0, np.pi, points))
    weight = np.where(np.arange(points) % 2, -1.0, 1.0)
    weight[[0, -1]] /= 2
    D = weight / weight[:, None] / (r[:, None] - r + np.eye(points)) * (1 - np.eye(points))
    D -= np.diag(D.sum(axis=1))
    start = (outer / r - 1) / (outer - 1)
    last = np.flatnonzero(table["phase"] == 19)
    values = {name: table[name][last] for name in ("diffusivity", "through", "pulse")}
    run = my.solve(example_models.heat_conduction(D, r), {**values, "wall": 1},
                   start={**{f"T_{j}": start[j + 1] for j in range(points - 2)}, "heat": 0}, time=(0, 1 / 16),
                   phases=20, rtol=1e-7, atol=1e-7, carry_on_step=True, method="tsitouras_5", device="cpu",
                   record=dict(from_phase=16, states=["heat"]))
    np.testing.assert_allclose(16 * run["heat"][:, -1], table["heat_flow"][last], rtol=1e-5)
    np.testing.assert_allclose(16 * run["heat"].mean(axis=1), table["mean_heat_flow"][last], rtol=1e-5)


@every
def test_own_method(run_program):
    printed = run_program("own_method")
    for tolerance in (1e-4, 1e-6, 1e-8):
        run = my.solve(example_models.pendulum(), start={"angle": np.linspace(0.1, 2.5, 256), "speed": 0},
                       time=(0, 100), rtol=tolerance, atol=tolerance, method="tsitouras_5", device="cpu")
        a, g = 1.0, np.cos((0.1 + 2.4 * np.arange(256) / 255) / 2)
        for _ in range(6):
            a, g = (a + g) / 2, np.sqrt(a * g)
        error = np.abs(run["last_passage"] - 5 * np.pi / 2 / a).max()
        said = re.search(f"tsitouras_5 +tolerance {tolerance:.0e}: error (\\S+), +(\\S+) evaluations", printed)
        assert said[1] == f"{error:.1e}"
        # fewer: a traced model knows that its equations do not read what the action writes
        assert 0.9 * float(said[2]) < run.report.rhs_evaluations / 256 < float(said[2])


def test_bouncing_ball_of_hooks(run_program):
    said = re.search(r"time of the fifth impact ([\d.]+)", run_program("hooks"))
    run = my.solve(example_models.bouncing_ball(), {"r": np.linspace(0.5, 0.9, 10), "g": 9.81}, start={"x": 1, "v": 0},
                   time=(0, np.inf), rtol=1e-9, atol=1e-9, events={"impact": dict(tolerance=1e-9)},
                   method="cash_karp", interpreted=True)
    assert f"{run['t_impact'][9]:.6g}" == said[1]


@every
def test_hooks(run_program):
    """The first number that the program prints for each of its models."""
    printed = run_program("hooks")

    def says(what, value):
        assert f"{what} {value:.6g}" in printed.replace("-0,", "0,"), (what, value)

    call = dict(method="tsitouras_5", device="cpu")
    run = my.solve(example_models.tangent_duffing(), {"k": [0.22, 0.24], "B": 0.3}, start={
        "x": -0.5, "v": -0.1, "a": 1, "b": 0, "growth": 0}, time=(0, tau), phases=1300, record=["growth"], **call)
    growth = (run["growth"][:, -1] - run["growth"][:, 299]) / (1000 * tau)
    assert [f"{value:.5g}" for value in growth] == [
        f"{float(value):.5g}" for value in re.search(r"Lyapunov exponents +(\S+) +(\S+)", printed).groups()]

    run = my.solve(example_models.damped(), {"zeta": np.linspace(0.05, 0.5, 10)}, start={"x": 1, "v": 0}, time=(0, 20),
                   **call)
    says("overshoot", run["overshoot"][1])
    says("time of the overshoot", run["t_overshoot"][1])
    says("dissipated energy", run["dissipated"][1])

    run = my.solve(example_models.settling(), {"k": np.linspace(0.5, 2, 100), "limit": 0.01}, start={"x": 1},
                   time=(0, 1000), maximum_step=0.01, **call)
    says("decays stopped", run.report.by_status["stopped_by_user"])
    says("integral of the first", run["integral_"][0])

    run = my.solve(example_models.continuation(), {"mu": [0, 1, 2], "increment": 0.1}, start={"x": 0.5}, time=(0, 5),
                   phases=10, **call)
    says("parameter after ten phases", run["mu"][1])
    says("equilibrium", run["x"][1])

    run = my.solve(example_models.stop_by_select(), {"gap": np.full(3, 10), "K": 10}, start={"x": 2, "v": 0},
                   time=(0, 10), samples=101, **call)
    says("samples differ from 2 cos t by", np.abs(run["x"] - 2 * np.cos(run.t_sample)).max())


def test_noise(run_program):
    """Along the same paths, as seed and instances are the same."""
    printed = run_program("noise")
    x, sigma = my.state("x"), my.parameter("sigma")
    model = my.model({x: x - x**3}, noise={x: sigma}, events=my.event(x - 1, stop_after=1))
    for value in (0.5, 0.6, 0.7):
        times = my.solve(model, {sigma: value}, paths=4000, start={x: -1}, time=(0, 10_000), step=0.02, seed=1,
                         method="euler_maruyama", device="cpu").t_last
        assert f"sigma {value}: {times.mean():.2f} +- {times.std() / 4000**0.5:.2f}, expected" in printed


def test_the_program_myriad_has_the_same_bits(tmp_path):
    """Compiler and flags are the same, so that a chaotic orbit is the same."""
    programs = [folder.parent / "bin" / "myriad" for folder in folders]
    program = next((p for p in programs if p.is_file()), None)
    if program is None:
        pytest.skip(f"the program is not built: {' or '.join(map(str, programs))}")
    text = (root / "examples" / "quickstart" / "model.hpp").read_text()
    (tmp_path / "model.hpp").write_text(text)
    (tmp_path / "study.toml").write_text("""
        model = "duffing"
        header = "model.hpp"
        method = "cash_karp"
        time_domain = [0, "2 pi"]
        axes.k = {linspace = [0.2, 0.3, 37]}
        set = {B = 0.3, x = -0.5, v = -0.1}
        [options]
        phases = 100
        relative_tolerance = 1e-9
        record = {from_phase = 90, states = ["x"]}
        """)
    subprocess.run([program, "run", "study.toml", "--quiet"], cwd=tmp_path, check=True, capture_output=True)
    theirs = my.open_study(tmp_path / "study")
    run = my.solve(my.CppModel(text, "duffing", "x v", "k", "B"), {"k": my.linspace(0.2, 0.3, 37), "B": 0.3},
                   start={"x": -0.5, "v": -0.1}, time=(0, tau), phases=100, rtol=1e-9, method="cash_karp",
                   record=dict(from_phase=90, states=["x"]), device="cpu")
    assert np.ptp(run["x"]) > 1
    np.testing.assert_array_equal(theirs["x"], run["x"])


def defined_by(program):
    """What the snippets `model` and `solve` of a Python case study define, which its page shows."""
    text = (root / "python" / "examples" / "case_studies" / f"{program}.py").read_text(encoding="utf-8")
    names = {"np": np, "my": my}
    for part in re.findall(r"# snippet: (?:model|solve)\n(.*?)# end of snippet", text, re.DOTALL):
        exec(part, names)  # pylint: disable=exec-used
    return types.SimpleNamespace(**names)


@pytest.mark.long
def test_basins_of_the_page(run_sweep):
    table = run_sweep("basins", instances=24)
    places = table["x"][:24]
    run, magnet = defined_by("basins").released(places, device="cpu")
    # the program's rows have x fastest; on a border between basins rounding decides
    assert (run.sweep.unstack(magnet) == table["magnet"].reshape(24, 24).T).mean() > 0.99


@pytest.mark.long
def test_poincare_section_of_the_page(run_sweep):
    """Up to c = 8, where no orbit is chaotic."""
    table = run_sweep("poincare", instances=97, transient=200, phases=5)
    regular = first_of(table, "c", 97) < 8
    run = defined_by("poincare").returns(first_of(table, "c", 97)[regular], 200, 5, device="cpu")
    for name, column in (("x", "x"), ("z", "z"), ("t", "return_time")):
        np.testing.assert_allclose(run[name], table[column].reshape(97, 5)[regular], rtol=1e-5, atol=1e-6)


@pytest.mark.long
def test_monte_carlo_of_the_page(run_sweep):
    table = run_sweep("monte_carlo", instances=997)
    page = defined_by("monte_carlo")
    run = my.solve(page.epidemic, {page.R0: table["R0"], page.duration: table["duration"]}, **page.usual, device="cpu")
    np.testing.assert_allclose(run["peak"], table["peak"], rtol=1e-7)
    np.testing.assert_allclose(run["day"], table["day"], rtol=1e-6, atol=1e-6)
    # What the page draws has the distribution of what the program drew, by Kolmogorov and Smirnov at the level of 1e-4.
    drawn, there = np.sort(np.asarray(page.study.run(device="cpu")["peak_end"])), np.sort(table["peak"])
    both = np.concatenate([drawn, there])
    apart = [np.searchsorted(of, both, "right") / of.size for of in (drawn, there)]
    assert np.abs(apart[0] - apart[1]).max() < 2.23 * np.sqrt(1 / drawn.size + 1 / there.size)


@pytest.mark.long
def test_bubbles_of_the_page(run_sweep):
    """At 0.5 bar, where no bubble is chaotic. The page's constants are rounded to a few digits. Its largest
    radius of a period may be at an end of it, the program's is that of a maximum or of the begin."""
    table = run_sweep("bubble_response", instances=37, transient=6, phases=3, pressure=0.5)
    page = defined_by("bubble_resonance")
    run = page.oscillations({page.f: 1e3 * first_of(table, "f_kHz", 37), page.pressure: np.full(37, 0.5e5)}, 6, 3,
                            rtol=1e-10, atol=1e-10, device="cpu")
    relative = run["y_max"].ravel() / table["y_max"] - 1
    assert relative.min() > -1e-3 and (relative < 1e-3).mean() > 0.85


@pytest.mark.long
def test_relief_valve_of_the_page(run_sweep):
    """Valves that oscillate, as a program's phase also ends where a valve rests; not near q = 0.8 and 6.5, where they
    are chaotic."""
    table = run_sweep("relief_valve", instances=97, transient=12, phases=4)
    flows = first_of(table, "q", 97)
    chosen = (flows > 1.5) & (flows < 5.5) | (flows > 7.6) & (flows < 8.3)
    run = defined_by("relief_valve").oscillations(flows[chosen], 12, 4, rtol=1e-10, atol=1e-10, method="cash_karp",
                                                  events=as_close("top", "seat"), device="cpu")
    expected = {name: table[name].reshape(97, 4)[chosen] for name in ("y_min", "y_max", "impacts")}
    np.testing.assert_allclose(run["y_max"], expected["y_max"], rtol=1e-5)
    assert np.array_equal(run["impacts"][:, 1:], np.diff(expected["impacts"], axis=1))  # the program counts all of them
    np.testing.assert_allclose(run["y_min"], expected["y_min"], atol=1e-3)  # the program's least is that of steps' ends


@pytest.mark.long
def test_lyapunov_map_of_the_page(run_sweep):
    table = run_sweep("lyapunov_map", instances=7, transient=6, phases=12)
    page = defined_by("chaos_over_a_plane")
    _, exponents = page.spectra({page.k: table["k"], page.B: table["B"]}, 1, 6, 12, rtol=1e-9, atol=1e-9,
                                method="dormand_prince_8", device="cpu")
    np.testing.assert_allclose(exponents[:, 0], table["lambda_library"], rtol=1e-9)
