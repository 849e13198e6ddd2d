# SPDX-License-Identifier: MIT
"""The problems of the C++ validation through Python, compiled and interpreted, on the CPU or on the GPU that
MYRIAD_TEST_DEVICE=cuda asks for. An error has to stay below the bound of docs/validation.md, which is that of the sum
of the errors of all steps, each grown as far as the problem makes errors grow.

On a GPU one method for each problem is compiled always. On the CPU, where the interpreter has the same expressions and
the C++ validation the same kernels, only the problems of `compiled` are: with events, with stiff steps and with fixed
ones. --all compiles all problems and methods."""

import functools
import os
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import myriad_ode as my
from myriad_ode import _core
from myriad_ode.codegen import tape_writer
from validation_problems import heat, problems

device = os.environ.get("MYRIAD_TEST_DEVICE", "cpu")
pytestmark = pytest.mark.skipif(device == "cuda" and bool(_core.no_gpu()), reason="there is no GPU")
explicit = ("runge_kutta_4", "cash_karp", "tsitouras_5", "dormand_prince_5", "verner_7", "dormand_prince_8",
            "verner_9")
stiff = ("rosenbrock_23", "rodas_5p")
made = {name: make() for name, make in problems.items()}
made["heat at ten points"] = heat(10)  # less stiff
tolerances = (1e-6, 1e-9)
compiled = ("relief_valve", "robertson", "lorenz")
usual = [(name, problem.method) for name, problem in made.items()
         if name in (problems if device == "cuda" else compiled)]
others = [(name, method) for name, problem in made.items() if name in problems
          for method in (stiff if problem.stiff else explicit + stiff * (name == "timed_circle"))
          if (name, method) not in usual]


@functools.cache
def reference(name, i):
    """What is known of an instance, by name."""
    try:
        return made[name].reference(i)
    except ImportError:
        pytest.skip("the reference is SciPy's, which is not installed")


@pytest.fixture(scope="module")
def solved(request):
    """Runs of all problems that are tested, at both tolerances; as many kernels are compiled at a time as there are
    cores."""
    asked = [item.callspec.params for item in request.session.items if hasattr(item, "callspec")]
    cases = [case for case in usual if dict(zip(("name", "method"), case)) in asked]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        yield {case: pool.submit(lambda case=case: [solve(*case, t, device=device) for t in tolerances])
               for case in cases}


def solve(name, method, tolerance, **options):
    problem = made[name]
    if method == "runge_kutta_4":
        options["step"] = problem.fixed_step * (1 if tolerance == tolerances[0] else 0.5)
    return problem.solve(tolerance, method=method, **options)


def check(name, method, runs):
    """Compares runs with both tolerances, or steps of both lengths, with what is known."""
    problem = made[name]
    examined = list(problem.instances or range(runs[0].size))
    known = {c: np.array([reference(name, i)[c] for i in examined]) for c in reference(name, examined[0])}
    errors = []
    for run in runs:
        assert run.report.failed == 0
        for c in problem.counts:
            assert np.array_equal(run[c][examined], known[c]), c
        errors.append({c: np.abs(run[c][examined] - known[c]) for c in known if c not in problem.counts})
    events = problem.growth * problem.events_per_instance * problem.event_tolerance
    for run, tolerance, error in zip(runs, tolerances, errors):
        steps = run.accepted_steps[examined]
        bound = problem.growth * steps * 2.3e-16 + events + problem.reference_error
        for c, found in error.items():
            size = np.maximum(1, np.abs(known[c]))
            if method == "runge_kutta_4":  # errors are a sixteenth where steps are half as long
                of_step = 2 * np.abs(runs[0][c] - runs[1][c])[examined]
            else:
                of_step = problem.growth * steps * problem.error_of_a_step * tolerance
            ratio = (found / (bound + of_step) / size).max()
            print(f"{name}, {method}, {tolerance:g}, {c}: error {found.max():.2g}, {ratio:.2g} of its bound")
            assert ratio <= 1, (c, tolerance, found.max())
    # The bounds are wide. That errors fall with the tolerance is not, where they are not those of rounding, nor steps
    # limited by stability and thus more accurate than asked for.
    if name.partition(" ")[0] in ("heat", "robertson"):
        return
    for c in errors[0]:
        coarse, fine = errors[0][c].max(), errors[1][c].max()
        if coarse > 1e3 * (problem.reference_error + events + 1e-12):
            assert fine < coarse / (12 if method == "runge_kutta_4" else 20), c


@pytest.mark.parametrize("name, method", usual)
def test_compiled(name, method, solved):
    check(name, method, solved[name, method].result())


@pytest.mark.skipif("not config.getoption('--all')", reason="compiles fifty kernels: --all")
@pytest.mark.parametrize("name, method", others)
def test_every_method(name, method):
    check(name, method, [solve(name, method, tolerance, device=device) for tolerance in tolerances])


@pytest.mark.skipif(device != "cuda", reason="MYRIAD_TEST_DEVICE is not cuda")
@pytest.mark.parametrize("name, method", usual)
def test_a_gpu_agrees_with_the_cpu(name, method, solved):
    """By twice the bound on the errors; the counts of events are the same."""
    problem, gpu = made[name], solved[name, method].result()[1]
    cpu = solve(name, method, tolerances[1], device="cpu")
    assert np.array_equal(cpu.status, gpu.status)
    bound = 2 * problem.growth * cpu.accepted_steps * problem.error_of_a_step * tolerances[1]
    for c, values in {**cpu.states, **cpu.accessories}.items():
        if values.dtype.kind == "i":
            assert np.array_equal(values, gpu[c]), c
        else:
            assert (np.abs(values - gpu[c]) <= bound * np.maximum(1, np.abs(values))).all(), c


@pytest.mark.skipif(device != "cpu", reason="models are interpreted on the CPU")
@pytest.mark.parametrize("name, method", [(name, method) for name in made for method in tape_writer.methods
                                          if method == "rodas_5p" or name not in ("heat", "oregonator")])
def test_interpreted(name, method):
    """But for what would take other methods a minute."""
    runs = [solve(name, method, tolerance, interpreted=True) for tolerance in tolerances]
    assert runs[0].report.kernel == "interpreted, as asked"
    check(name, method, runs)


def test_what_the_interpreter_refuses():
    with pytest.raises(my.Error, match="the interpreter has the methods"):
        made["oregonator"].solve(1e-6, method="verner_7", interpreted=True)
