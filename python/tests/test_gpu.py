# SPDX-License-Identifier: MIT
"""Models on a GPU: `scripts/gpu.sh --python` runs these, which need NumPy and pytest alone."""

import concurrent.futures
import os
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import example_models
import myriad_ode as my
from myriad_ode import _core
from myriad_ode.kernels import nvrtc
from myriad_ode.models.methods import fixed_step, methods, stochastic

pytestmark = pytest.mark.skipif(os.environ.get("MYRIAD_TEST_DEVICE") != "cuda" or bool(_core.no_gpu()),
                                reason="MYRIAD_TEST_DEVICE is not cuda, or there is no GPU")


def tangents():
    return my.with_tangents(example_models.duffing(), 2)


def network():
    """Twelve oscillators whose shared table of weights is too large for the constant bank."""
    phi = np.array(my.states([f"phi_{i}" for i in range(12)]))
    weights = my.table("W", np.random.default_rng(1).uniform(size=(12, 12)))
    sine, cosine = np.sin(phi), np.cos(phi)
    pull = cosine * (weights @ sine) - sine * (weights @ cosine)
    return my.model(dict(zip(phi, np.linspace(-1, 1, 12) + my.parameter("coupling") * pull)))


# Sweeps of examples, short enough not to be chaotic: inputs, initial values and options.
sweeps = {
    "duffing": (example_models.duffing, dict(k=np.linspace(0.2, 0.3, 3000), B=0.3), dict(x=-0.5, v=-0.1),
                dict(time=(0, 2 * np.pi), phases=5, record=["x", "x_local_max", "x_global_max", "zeros"])),
    "relief valve": (example_models.relief_valve, dict(q=np.linspace(0.2, 10, 3000), kappa=1.25, delta=10, beta=20,
                                                       restitution=0.8, rest_band=0),
                     dict(y=0.2, v=0, u=0), dict(time=(0, 1e6), phases=3, record=["y", "y_max", "impacts"])),
    "stick slip": (example_models.stick_slip, dict(belt=np.linspace(0.1, 0.4, 500), kinetic=0.6, breakaway=1),
                   dict(x=0, v=0, t_slip=0, x_slip=0, x_stick=0, period=0, sticks=0, slips=0),
                   dict(time=(0, 20), samples=30)),
    "summaries": (example_models.damped, dict(zeta=np.linspace(0.05, 0.9, 1000)), dict(x=1, v=0),
                   dict(time=(0, 10), phases=3, method="tsitouras_5",
                        record=["overshoot", "t_overshoot", "dissipated"])),
    "stiff": (example_models.oregonator, dict(f=np.linspace(0.8, 1.2, 200), epsilon=0.04, q=8e-4, ratio=0.01),
              dict(x=0.5, y=0.5, z=0.5), dict(time=(0, 30), method="rodas_5p", rtol=1e-7, record=["x", "z_least"])),
    "tangents": (tangents, dict(k=np.linspace(0.2, 0.3, 300), B=0.3), dict(x=-0.5, v=-0.1),
                 dict(time=(0, 1), phases=4, method="verner_7", record=["x", "growth_1", "growth_2"])),
    "tables": (network, dict(coupling=np.linspace(0, 0.3, 300)), {f"phi_{i}": 0.1 * i for i in range(12)},
               dict(time=(0, 5))),
    "hooks that write": (example_models.continuation, dict(mu=np.linspace(0.1, 0.5, 300), increment=0.05), dict(x=0.1),
                         dict(time=(0, 1), phases=4, carry_on=True, record=["x"])),
}


def integrate(name, device, **more):
    make, values, start, options = sweeps[name]
    return my.solve(make(), values, start=start, device=device, **{**dict(rtol=1e-9, atol=1e-9), **options, **more})


@pytest.mark.parametrize("name", sweeps)
def test_a_gpu_has_the_numbers_of_a_cpu(name):
    cpu, gpu = integrate(name, "cpu"), integrate(name, "cuda")
    assert gpu.report.device == "cuda:0" and 0 < gpu.report.kernel_seconds < gpu.report.total_seconds
    assert np.array_equal(cpu.status, gpu.status)
    assert abs(gpu.report.accepted_steps / cpu.report.accepted_steps - 1) < 1e-3
    for key, array in {**cpu.records, **cpu.samples, **cpu.states, **cpu.accessories, **cpu.parameters}.items():
        here, there = array, {**gpu.records, **gpu.samples, **gpu.states, **gpu.accessories, **gpu.parameters}[key]
        assert here.shape == there.shape and np.array_equal(np.isnan(here), np.isnan(there)), key
        close = np.isclose(here, there, rtol=1e-5, atol=1e-5, equal_nan=True)  # grazing events may be missed by one
        assert close.mean() > 0.998, (key, close.mean())


@pytest.mark.parametrize("precision", ["double", "float"])
@pytest.mark.parametrize("method", [m for m in methods if m not in stochastic])
def test_every_method_solves_the_oscillator(method, precision):
    x, v, w = *my.states("x v"), my.parameter("w")
    model = my.model({x: v, v: -w * w * x})
    frequency = np.linspace(0.5, 2, 2000)
    accuracy = 1e-8 if precision == "double" else 1e-5
    step = dict(step=0.005) if method in fixed_step else {}
    run = my.solve(model, {w: frequency}, start={x: 1, v: 0}, time=(0, 5), rtol=accuracy, atol=accuracy, samples=11,
                   method=method, precision=precision, device="cuda", **step)
    assert run["x"].dtype == ("f8" if precision == "double" else "f4")
    exact = np.cos(frequency[:, None] * np.linspace(0, 5, 11))
    # a thousand times the tolerance per step, and more for the interpolants of stiff methods, of lower order
    allowed = 1e-5 if precision == "double" else 2e-3
    assert np.abs(run["x"] - exact).max() < (max(allowed, 3e-5) if method.startswith("ro") else allowed)
    assert np.abs(run.states["x"] - exact[:, -1]).max() < allowed


def test_the_bits_of_an_instance_depend_on_nothing_else():
    make, values, start, options = sweeps["duffing"]
    whole = integrate("duffing", "cuda")
    order = np.random.default_rng(1).permutation(3000)
    for schedule in ("in_order", "dynamic", "by_cost"):
        mixed = my.solve(make(), {**values, "k": values["k"][order]}, start=start, device="cuda", schedule=schedule,
                         **{**options, "rtol": 1e-9, "atol": 1e-9})
        for name in ("x", "x_local_max", "zeros"):
            assert np.array_equal(whole[name][order], mixed[name], equal_nan=True), (schedule, name)
    part = my.solve(make(), {**values, "k": values["k"][100:103]}, start=start, device="cuda",
                    **{**options, "rtol": 1e-9, "atol": 1e-9})
    assert np.array_equal(whole["x"][100:103], part["x"])


def van_der_pol(x_values, v_values, **options):
    x, v, mu = *my.states("x v"), my.parameter("mu")
    return my.solve(my.model({x: v, v: mu * (1 - x * x) * v - x}), {mu: np.linspace(1, 3, 5000)},
                    start={x: x_values, v: v_values}, time=(0, 7), device="cuda", **options)


class Dlpack:
    """An array that has nothing but DLPack."""

    def __init__(self, array):
        self._array = array

    def __dlpack__(self, **options):
        return self._array.__dlpack__(**options)

    def __dlpack_device__(self):
        return self._array.__dlpack_device__()


@pytest.mark.parametrize("precision", ["double", "float"])
def test_results_are_inputs_without_leaving_the_gpu(precision):
    first = van_der_pol(np.linspace(1, 2, 5000), 0, precision=precision)
    x, v = first.device["x"], first.device["v"]
    assert x.__dlpack_device__() == (2, 0) and x.shape == (5000,)
    on_host = van_der_pol(first["x"], first["v"], precision=precision)
    for on_device in (van_der_pol(x, v, precision=precision), van_der_pol(Dlpack(x), Dlpack(v), precision=precision)):
        del first  # the arrays keep what they need
        first = None  # noqa: F841, for the next round to delete
        assert np.array_equal(on_device["x"], on_host["x"]) and np.array_equal(on_device["v"], on_host["v"])


@pytest.mark.parametrize("library", ["torch", "cupy", "jax"])
def test_arrays_of_other_libraries(library):
    other = pytest.importorskip(library)
    begin = np.linspace(1, 2, 5000)
    if library == "torch":
        given, back = other.tensor(begin, device="cuda"), lambda a: other.from_dlpack(a).cpu().numpy()
    elif library == "cupy":
        given, back = other.asarray(begin), lambda a: other.asnumpy(other.asarray(a))
    else:
        other.config.update("jax_enable_x64", True)
        given, back = other.numpy.asarray(begin), lambda a: np.asarray(other.dlpack.from_dlpack(a))
    run, same = van_der_pol(given, 0), van_der_pol(begin, 0)
    assert np.array_equal(run["x"], same["x"]) and np.array_equal(back(run.device["x"]), same["x"])


@pytest.fixture
def jax():
    jax = pytest.importorskip("jax")
    jax.config.update("jax_enable_x64", True)
    if jax.default_backend() != "gpu":
        pytest.skip("JAX has no GPU")
    return jax


def prey_and_predator(device, **more):
    prey, predator = my.states("prey predator")
    birth, hunt, death, growth = rates = my.parameters("birth hunt death growth")
    model = my.model({prey: birth * prey - hunt * prey * predator,
                      predator: growth * prey * predator - death * predator})
    return my.batched(model, **{**dict(free=[*rates, prey], of=[predator, prey], start={predator: 4}, time=(0, 20),
                                       samples=np.arange(1.0, 21.0), rtol=1e-9, atol=1e-9, device=device), **more})


@pytest.mark.parametrize("count", [1, 1000, 100_000])
def test_gradients_in_jax_stay_on_the_gpu(jax, count):
    sets = np.array([0.5, 0.025, 0.9, 0.028, 30]) * np.random.default_rng(1).uniform(0.8, 1.25, (count, 5))
    there, here = prey_and_predator("cuda"), prey_and_predator("cpu")
    gradients = jax.jit(jax.vmap(jax.grad(lambda theta: 0.5 * (there.to_jax()(theta)**2).sum())))
    assert "callback" not in gradients.lower(sets).as_text()
    found = gradients(jax.numpy.asarray(sets))
    assert found.devices() == {jax.devices()[0]}
    some = slice(None, None, max(count // 100, 1))
    values, slopes = here.with_jacobian(sets[some])
    expected = np.einsum("stq,stqi->si", values, slopes)
    np.testing.assert_allclose(found[some], expected, rtol=1e-6, atol=1e-6 * np.abs(expected).max())
    np.testing.assert_allclose(there.to_jax()(sets[some]), values, rtol=1e-6, atol=1e-6)
    for _ in range(20):  # XLA's and Myriad's work on the GPU are in order
        np.testing.assert_allclose(gradients(jax.numpy.asarray(sets[::-1].copy()))[::-1], found, rtol=1e-9)


def test_failures_in_jax_on_the_gpu(jax):
    x, k = my.state("x"), my.parameter("k")
    f = my.batched(my.model({x: k * x * x}, name="bursting"), free=[k], of=x, start={x: 1}, time=(0, 2), max_steps=1000,
                   device="cuda").to_jax()
    values = np.asarray(f(np.array([[0.1], [1.0]])))
    assert np.isfinite(values[0]) and np.isnan(values[1])
    with pytest.raises(Exception, match=r"\(k\) is nan in instance 1"):
        jax.block_until_ready(jax.jit(f)(np.array([[0.1], [np.nan]])))
    assert np.isfinite(f(np.array([0.1]))).all()


def test_two_functions_in_jax_on_the_gpu_in_several_threads(jax):
    sets = np.array([0.5, 0.025, 0.9, 0.028, 30]) * np.random.default_rng(1).uniform(0.8, 1.25, (2000, 5))
    programs = [jax.jit(prey_and_predator("cuda", of=of).to_jax()) for of in ("prey", "predator")]
    expected = [np.asarray(program(sets)) for program in programs]
    with concurrent.futures.ThreadPoolExecutor(8) as threads:
        assert all(threads.map(lambda i: np.array_equal(programs[i % 2](sets), expected[i % 2]), range(200)))


def test_ptx_for_a_gpu_that_nvrtc_does_not_know(monkeypatch, tmp_path):
    monkeypatch.setenv("MYRIAD_CACHE_DIR", str(tmp_path))
    monkeypatch.setattr(nvrtc, "_loaded", {})
    cubin = van_der_pol(1, 0)["x"]
    monkeypatch.setattr(nvrtc, "_loaded", {})
    monkeypatch.setenv("MYRIAD_CACHE_DIR", str(tmp_path / "other"))
    library = nvrtc.library()
    monkeypatch.setattr(library, "target", lambda _: (f"-arch=compute_{library.architectures[0]}", "PTX"))
    assert np.allclose(van_der_pol(1, 0)["x"], cubin, rtol=1e-6)


def test_a_known_model_starts_at_once_in_another_process():
    van_der_pol(1, 0)
    script = ("import test_gpu; from myriad_ode import _core; _core.wait_for_gpu(0); "
              "print(test_gpu.van_der_pol(1, 0).report.kernel, test_gpu.van_der_pol(1.5, 0).report.kernel)")
    here = os.path.dirname(__file__)
    told = subprocess.run([sys.executable, "-c", script], cwd=here, capture_output=True, text=True)
    assert told.stdout == "cache memory\n", told.stdout + told.stderr


def all_gpus():
    found = []
    while True:
        try:
            found.append(_core.check_device(f"cuda:{len(found)}"))
        except my.Error as error:
            assert "does not exist" in str(error)
            return found


def test_all_devices_have_the_same_bits():
    first = integrate("duffing", "cuda")
    for number, name in enumerate(all_gpus()):
        other = integrate("duffing", name)
        assert other.report.device == name
        assert np.array_equal(first["x"], other["x"]) and other.device["v"].__dlpack_device__() == (2, number)


def test_several_gpus_in_one_call_have_the_bits_of_one():
    if len(all_gpus()) < 2:
        pytest.skip("there is one GPU")
    mu = np.linspace(1, 3, 1_000_000)
    for name in ("duffing", "relief valve", "stick slip", "hooks that write"):
        one, all_of_them = integrate(name, "cuda"), integrate(name, all_gpus())
        assert all_of_them.report.device == ", ".join(all_gpus()) and all_of_them.report.kernel_seconds > 0
        for key in (*one.records, *one.samples, *one.states):
            assert np.array_equal(one[key], all_of_them[key], equal_nan=True), (name, key)
    x, v, m = *my.states("x v"), my.parameter("mu")
    one, all_of_them = (my.solve(my.model({x: v, v: m * (1 - x * x) * v - x}), {m: mu}, start={x: 1, v: 0},
                                 time=(0, 5), device=d) for d in ("cuda", all_gpus()))
    assert np.array_equal(one["x"], all_of_them["x"]) and one.report.accepted_steps == all_of_them.report.accepted_steps


def a_study(name):
    make, values, start, options = sweeps[name]
    return my.study(make(), values, start=start, **{**dict(rtol=1e-9, atol=1e-9), **options})


@pytest.mark.parametrize("name", ["duffing", "relief valve", "stick slip", "tables"])
def test_studies_have_the_bits_of_calls_on_all_gpus(name, tmp_path):
    whole = integrate(name, "cuda")
    for devices, chunk in (("cuda", None), (all_gpus(), 170)):
        result = a_study(name).run(tmp_path / str(chunk), device=devices, chunk=chunk)
        assert result.complete and not result.warnings and sum(result.by_status.values()) == whole.size
        for key, array in {**whole.records, **{f"{n}_sample": s for n, s in whole.samples.items()}}.items():
            assert np.array_equal(result[key], array, equal_nan=True), (key, devices)
        if not whole.records and not whole.samples:
            assert all(np.array_equal(result[f"{n}_end"], s) for n, s in whole.states.items())


def test_a_study_uses_the_cpu_and_all_gpus_together():
    result = a_study("duffing").run(device=["cpu", *all_gpus()], chunk=64)
    cpu = integrate("duffing", "cpu")
    assert result.complete and np.isclose(result["x"], cpu["x"], rtol=1e-5, atol=1e-5).mean() > 0.998


def test_generated_instances_have_the_bits_of_those_that_the_host_lays_out():
    x, v, k, x_0, v_0 = *my.states("x v"), my.parameter("k"), my.accessory("x_0"), my.accessory("v_0")
    equations = {x: v, v: x - x**3 - k * v}
    blocks = dict(generate={x: my.uniform(-1, 1), v: my.normal(0, 0.1), k: my.instance % 100 * 0.001})
    call = dict(time=(0, 6), rtol=1e-9, keep=[x, v, k])
    begin = my.study(my.model(equations, **blocks, initialise={x_0: x, v_0: v}), draws=5000, time=(0, 1e-3),
                     keep=[x_0, v_0, k]).run(device="cuda")
    assert np.array_equal(begin["k_end"], np.arange(5000) % 100 * 0.001)
    listed = my.study(my.model(equations), {k: begin["k_end"]}, start={x: begin["x_0_end"], v: begin["v_0_end"]},
                      **call).run(device="cuda")
    mean = [my.reduce.mean("x_end"), my.reduce.histogram("x_end", my.linspace(-2, 2, 9))]
    samples = np.linspace(0, 6, 5)
    by_device = [my.study(my.model(equations, **blocks), draws=5000, time=(0, 6), samples=samples,
                          method="dormand_prince_5", rtol=1e-9, keep=dict(samples=True, end=[]),
                          reduce=my.reduce.histograms("x_sample", my.linspace(-2, 2, 9))).run(device=device)
                 for device in ("cuda", "cpu")]
    for made in by_device:
        counted = [np.histogram(column, np.linspace(-2, 2, 9))[0] for column in made["x_sample"].T]
        assert np.array_equal(made["x_sample_histograms"], counted)
    for devices, chunk in (("cuda", None), (all_gpus(), 170)):
        made = my.study(my.model(equations, **blocks), draws=5000, reduce=mean, **call).run(device=devices, chunk=chunk)
        assert made.complete and all(np.array_equal(made[n], listed[n]) for n in ("x_end", "v_end", "k_end"))
        assert np.array_equal(made["x_end_histogram"], np.histogram(made["x_end"], np.linspace(-2, 2, 9))[0])
        assert np.isclose(made["x_end_mean"], made["x_end"].mean(), rtol=1e-12)


def test_bad_inputs_are_refused_on_the_host_and_on_the_gpu():
    bad = np.linspace(1, 2, 5000)
    bad[70] = np.nan
    with pytest.raises(my.Error, match="state 0 .x. is not finite in 1 of 5000 instances, first in instance 70"):
        van_der_pol(bad, 0)
    marked = van_der_pol(bad, 0, invalid="mark")
    assert marked.report.by_status == {"success": 4999, "invalid_input": 1}
    fine = van_der_pol(1, 0)
    with pytest.raises(my.Error, match="the run is in float32"):
        van_der_pol(fine.device["x"], 0, precision="float")


def test_a_sweep_that_takes_much_of_the_memory_is_integrated_in_chunks():
    x, mu = my.state("x"), my.parameter("mu")
    model = my.model({x: -mu * x}, name="decay")
    values = np.linspace(1, 3, 300_000)
    options = dict(start={x: 1}, time=(0, 1), step=0.5, method="runge_kutta_4", device="cuda", precision="float")
    few = my.solve(model, {mu: values}, phases=2, record=[x], **options)
    many = my.solve(model, {mu: values}, phases=8000, record=[x], **options)  # 9.6 GB of records
    assert few.device["x"].shape == (300_000, 2)
    with pytest.raises(my.Error, match="is not on a GPU: the run was on the CPU, or in parts"):
        many.device["x"]
    assert np.array_equal(few["x"], many["x"][:, :2])


def endless(**more):
    """Oscillators of which two take for ever, and the seconds that the call took."""
    end = np.full(100_000, 10.0)
    end[[5, 70_000]] = 1e12
    x, v, w = *my.states("x v"), my.parameter("w")
    call = dict(sweep={w: np.linspace(1, 2, 100_000)}, start={x: 1, v: 0}, device="cuda", rtol=1e-6)
    model = my.model({x: v, v: -w * w * x}, name="endless")
    my.solve(model, time=(0, 1), **call)  # compiles it
    begin = time.perf_counter()
    try:
        run = my.solve(model, time=(0, end), max_steps=2_000_000_000, **call, **more)
    except my.Interrupted as interrupted:
        run = interrupted.run
    return run, time.perf_counter() - begin


def test_time_limit_ends_a_kernel():
    run, seconds = endless(time_limit=0.5)
    assert run.report.by_status == {"success": 99_998, "interrupted": 2} and 0.5 <= seconds < 1
    assert (run.status[[5, 70_000]] == "interrupted").all() and np.isfinite(run["x"]).all()
    again, seconds = endless(time_limit=0.1, phases=3, schedule="by_cost")
    assert again.report.by_status["interrupted"] >= 2 and seconds < 1


def test_ctrl_c_ends_a_kernel_within_a_second():
    sent = []

    def stop():
        sent.append(time.perf_counter())
        os.kill(os.getpid(), signal.SIGINT)

    endless(time_limit=0.01)  # compiled, so that the signal comes when the kernel runs
    threading.Timer(2, stop).start()
    run, _ = endless()
    assert time.perf_counter() - sent[0] < 1.2
    assert run.report.by_status.get("interrupted") == 2 and run.done == 99_998
