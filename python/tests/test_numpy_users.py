# SPDX-License-Identifier: MIT
"""What users of NumPy and SciPy take for granted: numbers of all kinds, sweeps of nothing, results as a mapping, names
that Python has, and NumPy's functions."""

import decimal
import fractions
import importlib
import pickle
import subprocess
import sys

import numpy as np
import pytest

import myriad_ode as my
from myriad_ode.symbolic.vectors import vector

x, v, k = my.state("x"), my.state("v"), my.parameter("k")


def oscillator(**more):
    return my.model({x: v, v: -k * x}, **more)


def solved(sweep=None, **options):
    return my.solve(oscillator(), {k: [1.0, 2.0]} if sweep is None else sweep,
                    **{**dict(start={x: 1, v: 0}, time=(0, 1), interpreted=True, device="cpu"), **options})


def test_a_run_is_a_mapping_from_names_to_arrays():
    run = solved(record=dict(states=[x], time=True))
    names = ["x", "t", "phase", "x_end", "v_end", "t_last", "status", "k", "x_start", "v_start", "t_begin", "t_end"]
    assert sorted(run) == sorted(run.keys()) == sorted(names) == sorted(run._ipython_key_completions_())
    assert len(run) == len(names)
    assert "x" in run and x in run and "z" not in run and 0 not in run and my.time in run
    assert run.get("z") is None and run.get("k") is not None and run.size == 2
    shapes = {name: array.shape for name, array in run.items()}
    assert shapes["x"] == shapes["t"] == (2, 1) and shapes["v_end"] == shapes["k"] == run["v"].shape == (2,)
    assert dict(run)["v_end"] is not None and run == run and run != solved() and isinstance(hash(run), int)


def test_results_of_a_study_are_a_mapping():
    result = my.study(oscillator(), {k: [1.0, 2.0]}, start={x: 1, v: 0}, time=(0, 1), interpreted=True).run(
        device="cpu")
    assert "x_end" in result and x in result and "z" not in result and 3 not in result
    assert set(result.keys()) == set(result.names) and len(result) == len(result.names)
    assert result.get("x_end").shape == (2,)


def test_a_study_of_one_instance_has_numbers():
    result = my.study(oscillator(), {k: 1.0}, start={x: 1, v: 0}, time=(0, 1), interpreted=True).run(device="cpu")
    assert result["x_end"].shape == () and float(result["x_end"]) == pytest.approx(np.cos(1))
    assert result.to_xarray()["x_end"].item() == float(result["x_end"])


@pytest.mark.parametrize("value", [
    fractions.Fraction(1, 4), decimal.Decimal("0.25"), np.float32(0.25), np.array(0.25), [fractions.Fraction(1, 4)],
    np.array([0.25, 0.25], dtype=object), np.array([0.25]).astype(np.float16),
])
def test_numbers_of_any_kind_are_numbers(value):
    for run in (solved({k: value}), solved(my.grid({k: value}))):
        assert run["x"][0] == pytest.approx(np.cos(0.5))
    assert (x * fractions.Fraction(1, 4)) is (x * 0.25) is (x * decimal.Decimal("0.25"))
    study = my.study(oscillator(), {k: value}, start={x: 1, v: 0}, time=(0, fractions.Fraction(1)), interpreted=True)
    assert np.ravel(study.run(device="cpu")["x_end"])[0] == pytest.approx(np.cos(0.5))


def test_objects_that_are_no_numbers_are_refused():
    with pytest.raises(my.Error, match="give a number"):
        solved({k: np.array([1, "fast"], dtype=object)})


def test_a_relative_tolerance_of_zero_leaves_the_error_to_the_absolute_one():
    assert solved(rtol=0, atol=1e-9)["x"] == pytest.approx(np.cos(np.sqrt([1, 2])), abs=1e-7)
    with pytest.raises(my.Error, match="rtol and atol are 0"):
        solved(rtol=0, atol=0)


@pytest.mark.parametrize("sweep", [{"k": []}, {"k": np.array([])}, lambda: my.grid(k=[], B=[1.0])])
def test_a_sweep_of_no_instance_has_empty_arrays(sweep):
    run = solved({"k": []}, phases=3, record=[x])
    assert run["x"].shape == (0, 3) and run["v"].shape == run["k"].shape == run.status.shape == (0,)
    assert run["x"].dtype == float and run.size == 0 and run.t_last.shape == run.accepted_steps.shape == (0,)
    assert run.report.by_status == {} and "0 instances" in str(run.report) and not run.failed.any()
    sampled = solved({"k": []}, samples=5)
    assert sampled["x"].shape == sampled.t_sample.shape == (0, 5)
    assert solved(my.grid({k: [], x: [1.0, 2.0]}), start={v: 0}).shape == (0, 2)
    assert solved({k: 1.0}, size=0)["x"].shape == (0,)
    assert run.to_xarray()["x"].shape == (0, 3) and len(run.to_pandas()) == 0
    with pytest.raises(my.Error, match="'z' is no component"):  # as for others
        solved({"k": [], "z": 1})


def test_a_study_of_no_instance_is_refused_by_name():
    with pytest.raises(my.Error, match="'k' has no values: a study has one instance or more"):
        my.study(oscillator(), {k: []}, start={x: 1, v: 0}, time=(0, 1))


def test_an_import_of_all_leaves_pythons_own_names():
    names = {}
    exec("from myriad_ode import *", names)  # noqa: S102
    assert "solve" in names and "sin" in names and not {"abs", "round", "pow", "zip", "np"} & set(names)
    assert set(my.__all__) < set(dir(my)) and "abs" in dir(my) and not [n for n in dir(my) if not hasattr(my, n)]
    assert not {"sys", "expression", "numpy_functions"} & set(dir(my))


AGAIN = """
import importlib, sys, warnings
warnings.simplefilter("error")
import myriad_ode as my
my = importlib.reload(my)
for name in [n for n in sys.modules if n.partition(".")[0] == "myriad_ode"]:
    del sys.modules[name]
import myriad_ode as again
assert again is not my
x = again.state("x")
print(again.solve(again.model({x: -x}), start={x: 1}, time=(0, 1), interpreted=True, device="cpu")["x"][0])
try:
    again.solve(again.model({x: -x}), start={x: 1}, time=(0, 1), interpreted=True, device="cpu", phases=0)
except again.Error:
    print("refused")
"""


def test_the_package_can_be_imported_anew():
    told = subprocess.run([sys.executable, "-c", AGAIN], capture_output=True, text=True, check=False)
    assert told.stdout.startswith("0.3678794") and told.stdout.endswith("refused\n") and not told.stderr, told.stderr


def test_unknown_options_are_type_errors_too():
    with pytest.raises(TypeError, match="study has no option 't_eval'"):
        my.study(oscillator(), {k: 1.0}, start={x: 1, v: 0}, time=(0, 1), t_eval=[0, 1])


FUNCTIONS = [np.log1p, np.expm1, np.ceil, np.trunc, np.rint, np.fix, np.round, np.sign, np.degrees, np.radians,
             np.rad2deg, np.deg2rad, np.arcsinh, np.arctanh, np.sinc, np.floor, np.square, np.cbrt]


@pytest.mark.parametrize("function", FUNCTIONS, ids=lambda f: f.__name__)
def test_functions_of_numpy_have_their_values(function):
    values = np.array([-0.7, -1e-9, 0.0, 1e-12, 0.3, 0.9])
    for at in (x, vector([x, x])):
        found = function(at)
        for one in np.ravel(found) if isinstance(found, np.ndarray) else [found]:
            got = my.model({x: one * 1.0}).derivatives(0, [values])[0]
            np.testing.assert_allclose(got, function(values), rtol=1e-14, atol=0)


def test_select_piecewise_polyval_and_fmod_have_the_values_of_numpy():
    values = np.linspace(-3, 3, 25)

    def check(function):
        np.testing.assert_allclose(my.model({x: function(x)}).derivatives(0, [values])[0], function(values),
                                   rtol=1e-14, atol=1e-15)

    check(lambda x: np.select([x > 1, x < -1], [x, -2 * x], 0.5))
    check(lambda x: np.select([x > 1, x > 0], [x * x, x], default=x + 7))
    check(lambda x: np.piecewise(x, [x < -1, x > 1], [lambda x: -x, lambda x: x * x, 0.25]))
    check(lambda x: np.piecewise(x, [x < 1, x > -1], [1.0, 2.0]))  # the last that holds decides
    check(lambda x: np.polyval([1.0, -2.0, 3.0, 0.5], x))
    check(lambda x: np.fmod(x, 0.7))
    check(lambda x: np.fmod(7.0, x + 0.1))
    check(lambda x: np.clip(x, -1, None))
    check(lambda x: np.clip(x, a_min=-1, a_max=0.5))
    check(lambda x: np.logaddexp(x, 2.0))
    check(lambda x: np.where(np.isnan(x) | np.isinf(x), 0.0, x))
    check(lambda x: np.float64(2.5) % (x + 10) + np.float64(7) // (x + 10))


def test_the_largest_of_a_vector_is_taken_by_instance():
    model = my.model(lambda t, y: [np.max(y), y.min()], states="a b")
    assert model.derivatives(0, [np.array([1.0, 3.0]), np.array([2.0, -1.0])]).tolist() == [[2.0, 3.0], [1.0, -1.0]]


def test_calls_of_numpys_functions_that_do_not_fit_are_refused():
    for call in (lambda: np.where(x > 0), lambda: np.round(x, 2), lambda: np.interp(x, [0, 1], [0, 1]),
                 lambda: solved({k: 10**400})):
        with pytest.raises(my.Error, match="test_numpy_users.py"):
            call()


def test_polynomials_of_symbols_and_vectors_are_taken():
    model = my.model(lambda t, y: np.polyval([1, 2, 3], y) + np.select([y > 0], [y], -y), states="a b")
    assert model.derivatives(0, [2.0, -1.0]).tolist() == [13.0, 3.0]


@pytest.mark.as_users_compile
def test_a_compiler_may_have_arguments_and_one_that_calls_it(monkeypatch):
    from myriad_ode.kernels import compiler

    real = compiler.known_compiler()
    monkeypatch.delenv("MYRIAD_CXX", raising=False)
    for chosen in (f"{real.command[0]} -fno-plt -DGREETING='a b'", f"env {real.command[0]} -fno-plt",
                   f"  {real.command[0]}  "):
        monkeypatch.setenv("CXX", chosen)
        found = compiler.known_compiler()
        assert found.kind == real.kind and found.command[0].endswith(("env", real.command[0]))
    assert compiler.known_compiler().identity != real.identity or compiler.known_compiler().command == real.command
    monkeypatch.setenv("CXX", f"env {real.command[0]} -DSOMETHING='a b'")
    y = my.state("y")
    run = my.solve(my.model({y: -y * 0.125}), start={y: 1}, time=(0, 1), device="cpu")
    assert run["y"][0] == pytest.approx(np.exp(-0.125)) and run.report.kernel.startswith("compiled by")
    monkeypatch.setenv("CXX", f"{sys.executable} -S")  # no compiler of C++: another one is found
    assert compiler.known_compiler().command == real.command
    monkeypatch.setenv("CXX", "no-such-compiler -O2")
    with pytest.raises(my.Error, match="CXX is 'no-such-compiler -O2', and there is no such program"):
        compiler.known_compiler()


def test_errors_and_expressions_survive_pickling():
    assert pickle.loads(pickle.dumps(x % 0.3 + np.log1p(v))) is (x % 0.3 + np.log1p(v))
    assert importlib.import_module("myriad_ode") is my


def test_derivatives_keep_the_sign_of_zero_and_compute_small_integers_as_real_numbers():
    x, v = my.states("x v")
    model = my.model({x: my.atan2(x, v), v: x * v})
    assert model.derivatives(0.0, [-0.0, -1.0])[0] == -np.pi
    assert model.derivatives(0, np.array([100, 100], dtype=np.int8))[1] == 10_000
    assert list(my.model({x: -x}).derivatives(0, np.array([[1, 2]], dtype=np.uint8))[0]) == [-1, -2]


@pytest.mark.parametrize("interpreted", [None, True])
def test_the_inverse_of_sinh_is_right_for_large_numbers(interpreted):
    x, k = my.state("x"), my.parameter("k")
    values = np.array([1e300, -1e200, 1e151, 1e149, 3.0, -1e-300, 0.0])
    run = my.solve(my.model({x: np.arcsinh(k)}), {k: values}, start={x: 0}, time=(0, 1), device="cpu",
                   interpreted=interpreted)
    assert np.allclose(run["x"], np.arcsinh(values), rtol=1e-14, atol=0)
