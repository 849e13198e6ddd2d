# SPDX-License-Identifier: MIT
"""Interpreted models against compiled ones and closed forms, and what they refuse."""

import os
import signal
import subprocess
import sys

import numpy as np
import pytest

import example_models
import myriad_ode as my
from myriad_ode.base.errors import CannotInterpret


def oscillator():
    x, v = my.states("x v")
    w = my.parameter("w")
    return my.model({x: v, v: -w * w * x})


def test_events_hooks_and_accessories_have_the_bits_of_compiled_ones():
    duffing = example_models.duffing()
    recorded = ["x", "v", "x_local_max", "v_second_zero", "x_global_max", "zeros"]
    call = dict(sweep={"k": np.linspace(0.2, 0.3, 101), "B": 0.3}, start={"x": -0.5, "v": -0.1}, time=(0, 2 * np.pi),
                phases=4, rtol=1e-9, record=recorded)
    compiled, interpreted = my.solve(duffing, **call), my.solve(duffing, interpreted=True, **call)
    for name in recorded:
        assert compiled[name].tobytes() == interpreted[name].tobytes(), name
    assert compiled.report.located_steps == interpreted.report.located_steps > 0
    assert interpreted.report.kernel == "interpreted, as asked"
    assert "kernel interpreted, as asked" in str(interpreted.report)


@pytest.mark.parametrize("method, tolerance", [("tsitouras_5", 1e-7), ("cash_karp", 1e-7),
                                               ("dormand_prince_5", 1e-7), ("runge_kutta_4", 1e-5),
                                               ("rodas_5p", 1e-7), ("rosenbrock_23", 1e-5)])
def test_closed_form(method, tolerance):
    w = np.linspace(1, 2, 19)
    run = my.solve(oscillator(), {"w": w}, start={"x": 1, "v": 0}, time=(0, 3), rtol=1e-10, atol=[1e-10, 1e-10],
                   step=0.01, method=method, samples=5, interpreted=True)
    np.testing.assert_allclose(run["x"], np.cos(w[:, None] * run.t_sample), atol=tolerance)
    np.testing.assert_allclose(run.states["v"], -w * np.sin(3 * w), atol=2 * tolerance)


def test_every_function_has_the_value_of_numpy():
    """y' = f(t) over one step of length 1e-3, so that y is about f times that."""
    t, (y,) = my.time, my.states("y")
    functions = {
        "sqrt": np.sqrt, "cbrt": np.cbrt, "abs": np.abs, "floor": np.floor, "sin": np.sin, "cos": np.cos,
        "tan": np.tan, "asin": np.arcsin, "acos": np.arccos, "atan": np.arctan, "sinh": np.sinh, "cosh": np.cosh,
        "tanh": np.tanh, "exp": np.exp, "exp2": np.exp2, "log": np.log, "log2": np.log2, "log10": np.log10,
        "reciprocal": lambda x: 1 / x, "rsqrt": lambda x: 1 / np.sqrt(x),
        "sinpi": lambda x: np.sin(np.pi * x), "cospi": lambda x: np.cos(np.pi * x),
        "round": np.round}
    for name, function in functions.items():
        run = my.solve(my.model({y: getattr(my, name)(0.4 + t)}), start={y: 0}, time=(0, 1e-3), interpreted=True,
                       method="runge_kutta_4", step=1e-3)
        assert run["y"][0] == pytest.approx(1e-3 * function(0.4005), rel=1e-6), name
    two = {
        my.minimum(t, 0.3): 0.0005, my.maximum(t, 0.3): 0.3, my.pow(0.4 + t, 1.5): 0.4005**1.5,
        my.powr(0.4 + t, 1.5): 0.4005**1.5, my.atan2(0.4 + t, 2.0): np.arctan2(0.4005, 2),
        my.hypot(0.4 + t, 2.0): np.hypot(0.4005, 2), my.copysign(0.4 + t, -1.0): -0.4005,
        my.fma(t + 1, 2.0, 3.0): 5.001, my.where((t < 1) & ~(t > 0.5) | (t == 7), 2.0, 3.0): 2.0,
        my.where((t >= 1) | (t != t), 2.0, -t): -0.0005, my.where(my.is_finite(1 / t), 1 + t * 2, 1.0): 1.001}
    for expression, value in two.items():
        run = my.solve(my.model({y: expression}), start={y: 0}, time=(0, 1e-3), interpreted=True,
                       method="runge_kutta_4", step=1e-3)
        assert run["y"][0] == pytest.approx(1e-3 * value, rel=1e-6), repr(expression)


SCRIPT = """
import myriad_ode as my
x, v = my.states("x v")
run = my.solve(my.model({x: v, v: -x}), start={x: 1, v: 0}, time=(0, 1))
print(run.report.kernel, float(run["x"][0]))
"""


def test_without_a_compiler_models_are_interpreted_and_the_report_tells(tmp_path):
    environment = {name: value for name, value in os.environ.items() if name != "MYRIAD_CXX"}
    told = subprocess.run([sys.executable, "-c", "import sys; sys.modules['ziglang'] = None\n" + SCRIPT],
                          env={**environment, "PATH": str(tmp_path)}, capture_output=True, text=True, check=False)
    assert told.stdout.startswith("interpreted, as there is no C++ compiler 0.5403"), told.stderr


@pytest.mark.parametrize("change, message", [
    (dict(method="dormand_prince_8"), "the interpreter has the methods tsitouras_5, cash_karp, dormand_prince_5"),
    (dict(control="pi_control"), "in double precision and with the usual control alone"),
    (dict(precision="float"), "in double precision and with the usual control alone"),
])
def test_calls_beyond_the_interpreter(change, message):
    with pytest.raises(my.Error, match=message):
        my.solve(oscillator(), {"w": 1}, start={"x": 1, "v": 0}, time=(0, 1), interpreted=True, **change)


@pytest.mark.parametrize("method", my._core.interpreted_methods())
@pytest.mark.parametrize("count, crossings", [(8, 3), (128, 64)])
def test_models_of_any_size_that_the_interpreter_has(method, count, crossings):
    """Decays at rates of their own; events count the levels that the first one passes, and mark them in accessories."""
    states, rate = my.states([f"x{i}" for i in range(count)]), my.parameter("rate")
    marks = [my.accessory(f"mark{i}") for i in range(2 * crossings)]
    levels = np.exp(-1.5 * (np.arange(crossings) + 0.5) / crossings)
    events = [my.event(states[0] - level, name=f"level{i}", direction="falling",
                       do={marks[2 * i]: my.time, marks[2 * i + 1]: states[-1]}) for i, level in enumerate(levels)]
    model = my.model({x: -rate * (1 + i / count) * x for i, x in enumerate(states)}, events=events)
    rates = np.linspace(1, 2, 11)
    steps = {"step": 1 / 256} if method == "runge_kutta_4" else {"rtol": 1e-9, "atol": 1e-12}
    if method == "rosenbrock_23":  # of order two
        steps = {"rtol": 1e-7, "atol": 1e-10}
    accuracy = 1e-4 if method == "rosenbrock_23" else 1e-6
    run = my.solve(model, {rate: rates}, start={x: 1 for x in states} | {m: 0 for m in marks}, time=(0, 2),
                   interpreted=True, method=method, **steps)
    assert not run.failed.any()
    for i in (0, count // 2, count - 1):
        np.testing.assert_allclose(run[states[i]], np.exp(-2 * rates * (1 + i / count)), rtol=accuracy)
    for i, level in enumerate(levels):
        at = -np.log(level) / rates
        np.testing.assert_allclose(run[marks[2 * i]], at, rtol=accuracy)
        np.testing.assert_allclose(run[marks[2 * i + 1]], np.exp(-rates * (2 - 1 / count) * at), rtol=accuracy)


def ring(count):
    """Coupled cells whose matrix is sparse, and whose slopes read the time."""
    x, d = my.states([f"x{i}" for i in range(count)]), my.parameter("d")
    return my.model({x[i]: d * (x[i - 1] - 2 * x[i] + x[(i + 1) % count]) - x[i]**3 + my.cos(my.time) * my.exp(-x[i])
                     for i in range(count)}, name="ring")


@pytest.mark.parametrize("count", [3, 9])
def test_stiff_methods_have_the_bits_of_compiled_ones(count):
    """Dense factors with pivots, of derivatives by dual numbers; and sparse ones, of those that are written."""
    model = ring(count)
    call = dict(sweep={"d": np.linspace(1, 1e3, 11)}, start={f"x{i}": 0.1 * i for i in range(count)}, time=(0, 10),
                method="rodas_5p", rtol=1e-7, atol=1e-9)
    compiled, interpreted = my.solve(model, **call), my.solve(model, interpreted=True, **call)
    for name in model.states:
        assert compiled[name].tobytes() == interpreted[name].tobytes(), name
    for one in ("states", "jacobian_entries", "factor_entries", "jacobian_evaluations"):
        assert getattr(compiled.report.matrix, one) == getattr(interpreted.report.matrix, one), one


def test_large_sparse_matrices_that_no_compiler_takes_stay_sparse():
    """Diffusion on a grid, compared with its eigenvalues: its factors take more than 4096 multiplications, of the
    4 million of dense ones."""
    side, names = 15, np.array([f"x{i}" for i in range(15 * 15)]).reshape(15, 15)
    x, d = np.array(my.states(list(names.ravel()))).reshape(side, side), my.parameter("d")
    inflow = {}
    for i in range(side):
        for j in range(side):
            there = [x[i + a, j + b] for a, b in ((1, 0), (-1, 0), (0, 1), (0, -1))
                     if 0 <= i + a < side and 0 <= j + b < side]
            inflow[x[i, j]] = d * (sum(there) - 4 * x[i, j])
    run = my.solve(my.model(inflow, name="grid"), {d: 3.0}, start={n: float(n == "x0") for n in names.ravel()},
                   time=(0, 1), method="rodas_5p", rtol=1e-8, atol=1e-12, interpreted=True)
    matrix = run.report.matrix
    assert matrix.states == 225 and matrix.jacobian_entries == 1065
    assert 2000 < matrix.factor_entries < 8000
    line = 2 * np.eye(side) - np.eye(side, k=1) - np.eye(side, k=-1)
    values, vectors = np.linalg.eigh(line)
    along = vectors @ (np.exp(-3 * values) * vectors[0])
    expected = np.outer(along, along)
    np.testing.assert_allclose([run[n][0] for n in names.ravel()], expected.ravel(), rtol=1e-6, atol=1e-9)



@pytest.mark.parametrize("method", ["tsitouras_5", "rodas_5p"])
def test_a_thousand_states_are_interpreted(method):
    """Decays of a chain, each of which the next one feeds: x_i = exp(-t) t^i / i! for the first ones."""
    states = my.states([f"x{i}" for i in range(1000)])
    model = my.model({x: (states[i - 1] if i else 0.0) - x for i, x in enumerate(states)})
    start = {x: float(i == 0) for i, x in enumerate(states)}
    run = my.solve(model, start=start, time=(0, 1), rtol=1e-8, atol=1e-10, method=method, interpreted=True)
    for i, value in enumerate(np.exp(-1) / np.array([1, 1, 2, 6, 24])):
        assert run[states[i]][0] == pytest.approx(value, rel=1e-6)
    assert run[states[-1]][0] == pytest.approx(0, abs=1e-9)


def test_a_first_call_loads_no_module_that_takes_longer_than_the_run():
    script = SCRIPT.replace("time=(0, 1))", "time=(0, 1), interpreted=True)")
    script += "import sys; print('numpy.ma' in sys.modules)"
    told = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert told.stdout.endswith("False\n"), told


@pytest.mark.skipif(os.name != "posix", reason="needs a shell")
@pytest.mark.parametrize("compiler, seconds, message", [
    ("sleep 60", "1", "has not compiled the model after 1 s, and was ended: give it more time by the environment"),
    ("sleep 60", "-1", "MYRIAD_COMPILE_SECONDS is '-1', and not a number of seconds above zero"),
    ("sleep 60", "", None)])  # and Ctrl-C after two seconds
def test_a_compiler_that_hangs_is_told_of_and_ended(tmp_path, compiler, seconds, message):
    hanging = tmp_path / "g++"
    hanging.write_text(f"""#!/bin/sh
case "$*" in *model.cpp*) {compiler};; *) exec g++ "$@";; esac
""")
    hanging.chmod(0o755)
    environment = {**os.environ, "MYRIAD_CXX": str(hanging), "MYRIAD_COMPILE_SECONDS": seconds,
                   "MYRIAD_CACHE_DIR": str(tmp_path / "cache")}
    with subprocess.Popen([sys.executable, "-c", SCRIPT], env=environment, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True) as program:
        if message is None:
            assert program.stderr.readline() == "compiling model (some seconds, once)\n"
            program.send_signal(signal.SIGINT)
        said = program.communicate(timeout=30)[1]
    assert (message or "KeyboardInterrupt") in said
    if seconds == "1":
        assert said.startswith("compiling model (some seconds, once)\n")


def test_models_beyond_the_interpreter():
    x, = my.states("x")
    many = [my.event(x - i / 300, name=f"e{i}") for i in range(300)]
    with pytest.raises(CannotInterpret, match="it has 300 events, and the interpreter 251 at the most: install a C"):
        my.solve(my.model({x: -x}, events=many), start={x: 1}, time=(0, 1), interpreted=True)
    peak = my.accessory("peak")
    with pytest.raises(CannotInterpret, match="extrema or integrals over a phase"):
        my.solve(my.model({x: -x}, accessories={peak: my.phase_maximum(x)}), start={x: 1}, time=(0, 1),
                 interpreted=True)
    with pytest.raises(CannotInterpret, match="as it is written in C"):
        my.solve(my.CppModel("struct a", "a", "x"), start={"x": 1}, time=(0, 1), interpreted=True)
