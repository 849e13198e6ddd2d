# SPDX-License-Identifier: MIT
"""What is around a kernel on a GPU: arguments, schedules, chunks, memory, arrays on devices and messages, on simulated
GPUs. What a GPU computes is in test_gpu.py."""

import shutil

import pytest

import simulated_gpu

pytestmark = [pytest.mark.long, pytest.mark.skipif(shutil.which("g++") is None, reason="there is no g++")]

MODEL = """
import concurrent.futures, ctypes, os, pathlib
import numpy as np, myriad_ode as my
from myriad_ode import _core
x, v, k, B, t = *my.states("x v"), my.parameter("k"), my.shared("B"), my.time
peak, n = my.accessory("peak"), my.integer_accessory("n")
model = my.model({x: v, v: x - x**3 - k * v + B * my.cos(t)}, accessories={peak: x, n: 0},
                 events=[my.event(v, direction="falling", do={peak: my.maximum(peak, x), n: n + 1})])

def sweep(size):
    return {k: np.linspace(0.2, 0.3, size), B: 0.3}

def solve(device, size, **more):
    usual = dict(start={x: -0.5, v: -0.1}, time=(0, 6), rtol=1e-9, device=device)
    return my.solve(model, sweep(size), **{**usual, **more})

def on_host(array):  # as the simulated GPU's memory is
    facts = array.__cuda_array_interface__
    flat = np.ctypeslib.as_array((ctypes.c_uint8 * (array.dtype.itemsize * int(np.prod(facts["shape"])))).from_address(
        facts["data"][0])).view(array.dtype)
    return flat.reshape(facts["shape"][::-1]).T

class OnGpu:  # an array of another library
    def __init__(self, values, strides=None):
        self.values = np.ascontiguousarray(values)
        self.__cuda_array_interface__ = dict(shape=self.values.shape, typestr=self.values.dtype.str, version=3,
                                             data=(self.values.ctypes.data, False), strides=strides)

def uploaded():  # bytes that were copied to devices
    bytes_of = ctypes.CDLL("libcuda.so.1").simulated_uploaded
    bytes_of.restype = ctypes.c_ulonglong
    return bytes_of()

def study(size, **more):
    return my.study(model, my.grid({k: my.linspace(0.2, 0.3, size)}, B=0.3),
                    **{**dict(start={x: -0.5, v: -0.1}, time=(0, 6), rtol=1e-9, keep=[x, peak, n]), **more})

def same(a, b, names):
    return all(np.array_equal(a[name], b[name], equal_nan=np.asarray(a[name]).dtype.kind == "f") for name in names)

def message(call, kind=my.Error):
    try:
        call()
    except kind as error:
        return str(error)
    raise AssertionError("no error")
"""


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    folder = tmp_path_factory.mktemp("driver")
    simulated_gpu.build_driver(folder)
    return lambda script, **variables: simulated_gpu.run(folder, MODEL + script, **variables)


def test_a_kernel_that_is_prepared_is_not_compiled_again(run, tmp_path):
    """As another process does for one that uses the GPU, and only loads."""
    run("""
from myriad_ode.base import component_kinds as kinds
from myriad_ode.kernels import nvrtc
from myriad_ode.models.any_model import names_of
from myriad_ode.models.methods import default, method_type
names = names_of(model)
nvrtc.prepare(*model.source(), method_type(default), "double", tuple(len(names[kind]) for kind in kinds.shared), 0)
assert solve("cuda", 3).report.kernel == "cache", solve("cuda", 3).report.kernel
""", MYRIAD_CACHE_DIR=tmp_path)


def test_results_are_the_cpus_in_every_schedule_and_place(run):
    run("""
for size, more in ((3, {}), (100, dict(schedule="dynamic")), (1000, dict(phases=6)),
                   (1000, dict(phases=5, carry_on=False, samples=4, precision="float", rtol=1e-5))):
    more = {"record": dict(states=[x], accessories=[peak, n], time=True), **more}
    cpu = solve("cpu", size, **more)
    for _ in range(2):  # the second time in the memory of the first
        gpu = solve("cuda", size, **more)
        assert gpu.report.device == "cuda:0" and gpu.report.registers == 99
        close = 0.1 if "precision" in more else 1e-6
        for name in ("x", "v", "peak", "k", "t"):
            assert np.allclose(cpu[name], gpu[name], atol=close), (name, size)
            if name != "t" or "samples" not in more:
                on_device = gpu.device[name]
                assert np.array_equal(on_host(on_device), gpu[name]), (name, size)
                assert _core.facts_of_own_array(on_device.__dlpack__())[1] == gpu[name].shape
        assert np.array_equal(gpu.status, cpu.status) and ("precision" in more or np.array_equal(gpu["n"], cpu["n"]))
        assert abs(gpu.report.kernel_seconds - 0.001) < 1e-6  # what the driver says, and not the compiler's time
        assert gpu.report.accepted_steps == gpu.accepted_steps.sum()
        assert gpu.report.rhs_evaluations == gpu.rhs_evaluations.sum()
        del gpu
""")


def test_paths_of_noise_are_the_cpus_also_in_chunks_of_a_study(run):
    run("""
W, w, sigma = my.wiener("W"), my.state("w"), my.parameter("sigma")
shared = my.model({x: -x, w: 0}, noise={x: {W: sigma * my.sqrt(1 + x * x)}, w: {W: 1}})
own = my.model({x: -x, w: 0}, noise={x: sigma * x, w: 1})
call = dict(start={x: 1, w: 0}, time=(0, 1), step=1 / 64, noise_step=1 / 16, seed=7)
for one, method, more in ((shared, "stochastic_heun", {}), (own, "milstein", dict(precision="float"))):
    of_call = dict(paths=50, method=method, **call, **more)
    cpu, gpu = (my.solve(one, {sigma: [0.3, 0.5]}, device=device, **of_call) for device in ("cpu", "cuda"))
    assert len(np.unique(gpu["w"])) == 100
    for name in ("x", "w"):
        assert np.allclose(cpu[name], gpu[name], atol=1e-5 if more else 1e-12), (name, method)
    study = my.study(one, {sigma: [0.3, 0.5]}, keep=[x, w], **of_call).run(device="cuda", chunk=37)
    assert np.array_equal(study["x_end"].ravel(), gpu["x"]) and np.array_equal(study["w_end"].ravel(), gpu["w"])
""")


def test_adaptive_steps_along_paths_and_noise_of_units_are_the_cpus(run):
    run("""
one = my.model({x: -x}, noise={x: 0.5 * x})
each = dict(start={x: 1}, time=(0, 1), seed=7, paths=40, method="sriw1", rtol=1e-3, atol=1e-3)
cpu, gpu = (my.solve(one, device=device, **each) for device in ("cpu", "cuda"))
assert gpu.report.rejected_steps > 0 and abs(gpu.report.accepted_steps / cpu.report.accepted_steps - 1) < 0.01
assert np.abs(cpu["x"] - gpu["x"]).max() < 1e-2 and np.isclose(cpu["x"], gpu["x"], rtol=1e-12).mean() > 0.9

n = 20
units = my.units(n, threads_per_instance=8)
u, v = units.states("u v")
A = units.circulant_coupling("A", np.roll(np.eye(n), 1, axis=1), 1)
ring = my.model({u: A @ u - u, v: u - v}, noise={u: 0.1 * u, v: 0.2})
for method, more in (("milstein", dict(step=1 / 64)), ("sriw1", dict(rtol=1e-2, atol=1e-2))):
    each = dict(start={u: np.linspace(1, 2, n), v: 0}, time=(0, 1), seed=7, paths=12, method=method, **more)
    cpu, gpu = (my.solve(ring, device=device, **each) for device in ("cpu", "cuda"))
    assert gpu.report.threads_per_instance == 8
    for state in ring.states:
        assert np.allclose(cpu[state], gpu[state], atol=1e-12 if "step" in more else 0.02), (state, method)
""")


def test_a_gpu_has_the_notes_and_checks_of_a_cpu(run):
    run("""
y, rate, s = my.state("y"), my.parameter("rate"), my.states(" ".join(f"s_{i}" for i in range(12)))
one = my.model({y: rate * (my.sin(t) - y) + my.cos(t)})
many = my.model({**{a: rate * (b - a) for a, b in zip(s, s[1:])}, s[-1]: my.cos(t) - rate * s[-1]})
def notes(model, device, value, tolerance=1e-6, **more):
    return my.solve(model, {rate: np.full(200, value)}, start=dict.fromkeys(model.states, 0), time=(0, 1),
                    rtol=tolerance, atol=tolerance, device=device, **more).report.notes
assert "rodas_5p" in my.solve(one, {rate: OnGpu(np.full(200, 1e4))}, start={y: 0}, time=(0, 1), rtol=1e-6, atol=1e-6,
                              device="cuda").report.notes[0]
for model in (one, many):  # the second has more states than are interpreted
    for more in ({}, dict(precision="float", tolerance=1e-3)):
        cpu, gpu = (notes(model, device, 1e4, **more) for device in ("cpu", "cuda"))
        assert len(cpu) == len(gpu) == 1 and "rodas_5p" in gpu[0]
        assert cpu[0].partition("(")[0] == gpu[0].partition("(")[0]
for value, more in ((1.0, {}), (1e4, dict(advice=False)), (1e4, dict(method="rodas_5p"))):
    assert notes(one, "cuda", value, **more) == []

for more in ({}, dict(initialise={v: 0})):  # before which events have no values
    summit = my.model({x: v, v: 0 * x - 1}, events=[my.event(x - 1e6, name="summit", tolerance=1e-14)], **more)
    call = lambda how, **options: how(summit, start={x: 999_999, v: 10}, time=(0, 1), **options)
    for how in (lambda: call(my.solve, device="cuda"), lambda: call(my.study, sweep={}).run(device="cuda")):
        if more:
            how()
        else:
            assert "the tolerance of event 'summit' is 1e-14, but rounding changes its function" in message(how)
            my.solve(summit, start={x: OnGpu(np.full(3, 999_999.0)), v: 10}, time=(0, 1), device="cuda")  # not checked
""")


def test_chunks_have_the_bits_of_a_whole(run):
    script = """
gpu = my.solve(model, sweep(270_000), start={x: 1, v: 0.1}, time=(0, 0.1), device="cuda")
print(hash(gpu["x"].tobytes()), hash(gpu.accepted_steps.tobytes()), gpu.report.accepted_steps)
"""
    whole = run(script + "assert gpu.device['x'].shape == (270_000,)", PYTHONHASHSEED=0)
    chunks = run(script + """
assert "is not on a GPU: the run was on the CPU, or in parts" in message(lambda: gpu.device["x"])
assert "whose memory does not suffice" in message(lambda: my.solve(
    model, {k: OnGpu(np.full(2_000_000, 0.2)), B: 0.3}, start={x: 1, v: 0}, time=(0, 1), device="cuda"))
""", PYTHONHASHSEED=0, MYRIAD_SIMULATED_MEGABYTES=200)
    assert chunks == whole


def test_inputs_may_be_on_the_gpu(run):
    run("""
values, begin = np.linspace(0.2, 0.3, 500), np.linspace(-1, 1, 500)
given = lambda k_values, x_values, **more: my.solve(
    model, {k: k_values, B: 0.3}, start={x: x_values, v: 0}, time=(0, 3), **{"device": "cuda", **more})
here, there = given(values, begin), given(OnGpu(values), OnGpu(begin))
for name in ("x", "v", "k"):
    assert np.array_equal(here[name], there[name]), name
values[17] = np.inf
assert "parameter 0 (k) is inf in instance 17, and must be finite" in message(lambda: given(OnGpu(values), 0))
assert "state 0 (x) is inf in instance 17" in message(lambda: given(0.2, OnGpu(values)))
assert "in 1 of 500 instances" in message(lambda: given(values, OnGpu(begin)))
assert "'k' on the GPU has type float32, and the run is in float64" in message(
    lambda: given(OnGpu(values.astype("f4")), 0))
assert "16 bytes apart" in message(lambda: given(OnGpu(values, (16,)), 0))
assert "'k' has 2 dimensions on the GPU" in message(lambda: given(OnGpu(values.reshape(5, 100)), 0))
assert "no array of float64" in message(lambda: given(OnGpu(np.arange(500)), 0))
assert "give device=\\"cuda\\"" in message(lambda: given(OnGpu(values), 0, device="cpu"))
assert "'B' is on a GPU" in message(lambda: my.solve(
    model, {k: values, B: OnGpu(begin)}, start={x: 0, v: 0}, time=(0, 1), device="cuda"))
""")


def test_failures_are_reported_with_their_instance(run):
    run("""
values = np.linspace(0.2, 0.3, 100)
values[60] = np.nan
marked = my.solve(model, {k: values, B: 0.3}, start={x: 0, v: 0}, time=(0, 1), device="cuda", invalid="mark")
assert marked.report.first_failed == 60 and marked.report.by_status == {"success": 99, "invalid_input": 1}
few = solve("cuda", 50, max_steps=3)
assert few.report.by_status == {"max_steps": 50} and "instance 0 ended as max_steps at t = 0" in str(few.report)
assert "is not finite in 1 of 100 instances" in message(lambda: my.solve(
    model, {k: values, B: 0.3}, start={x: 0, v: 0}, time=(0, 1), device="cuda"))
""")


def test_an_interrupted_run_has_its_results(run):
    run("""
def stop(done, total):
    raise KeyboardInterrupt
try:
    solve("cuda", 50, record=[x], progress=stop)
except my.Interrupted as interrupted:
    whole = solve("cuda", 50, record=[x])
    assert np.array_equal(interrupted.run["x"], whole["x"]) and np.array_equal(interrupted.run["v"], whole["v"])
    assert interrupted.run.done == 50 and interrupted.run.device["x"].shape == (50, 1)
else:
    raise AssertionError("was not interrupted")
""")


def test_devices_are_chosen_by_name_and_by_what_is_there(run):
    run("""
assert solve("auto", 5).report.device == "cuda:0"
second = solve("cuda:1", 5)
assert second.report.device == "cuda:1" and second.report.kernel == "memory"
assert second.device["x"].__dlpack_device__() == (2, 1)
assert "this machine has 2 GPUs" in message(lambda: solve("cuda:2", 5))
assert "there is no 'B' on the GPU" in message(lambda: second.device["B"], KeyError)
with concurrent.futures.ThreadPoolExecutor(4) as pool:
    several = list(pool.map(lambda i: solve(f"cuda:{i % 2}", 100 + i), range(8)))
assert [r.report.device for r in several] == ["cuda:0", "cuda:1"] * 4
assert all(np.array_equal(r["x"], solve("cuda", 100 + i)["x"]) for i, r in enumerate(several))
assert solve("auto", 5, interpreted=True).report.device == "cpu"
from myriad_ode.kernels import nvrtc
nvrtc.find = lambda: pathlib.Path("libnvrtc.so.14")
assert "NVRTC of CUDA 14 compiles for newer drivers than this one, of CUDA 13" in message(
    lambda: solve("cuda", 5, precision="float"))
nvrtc.find = lambda: None
without = solve("auto", 5)
assert without.report.device == "cpu" and "no NVRTC" in str(without.report)
child = os.fork()
if child == 0:
    forked = solve("auto", 5)
    ok = forked.report.device == "cpu" and "forked" in str(forked.report) + message(lambda: solve("cuda", 5))
    os._exit(0 if ok else 1)
assert os.waitpid(child, 0)[1] == 0
""", MYRIAD_SIMULATED_GPUS=2)
    run("assert solve(\"auto\", 5).report.device == \"cpu\"\n"
        "assert \"no CUDA-capable device\" in message(lambda: solve(\"cuda\", 5))", MYRIAD_SIMULATED_GPUS=0)


def test_chunks_of_studies_run_on_all_devices_with_the_same_bits(run):
    run("""
for more in ({}, dict(phases=3, record=dict(states=[x], accessories=[peak, n], time=True)),
             dict(samples=4, precision="float", rtol=1e-5, keep=dict(end=[x, peak, n], work=True))):
    s = study(200, **more)
    names = s.run(device="cuda").names
    one = study(200, **more).run(device="cuda", chunk=200)
    whole = my.solve(model, sweep(200), start={x: -0.5, v: -0.1}, time=(0, 6), rtol=more.get("rtol", 1e-9),
                     device="cuda", **{a: b for a, b in more.items() if a not in ("rtol", "keep")})
    assert np.array_equal(one["x_end"], whole.states["x"]) and np.array_equal(one["n_end"], whole["n"][..., -1]
                                                                             if "record" in more else whole["n"])
    both = study(200, **more).run(device=["cuda:0", "cuda:1"], chunk=17)
    assert both.complete and both.by_status == {"success": 200} and same(both, one, names) and not both.warnings
    assert both.kernel == "memory"
with_cpu = study(200).run(device=["cuda:1", "cpu", "cuda:1"], chunk=9)
assert with_cpu.complete and np.allclose(with_cpu["x_end"], study(200).run(device="cpu")["x_end"], atol=1e-6)
assert study(5).run(device="auto").kernel == "memory"
assert "interpreted on the CPU alone" in message(lambda: study(5, interpreted=True).run(device="cuda"))
assert "this machine has 2 GPUs" in message(lambda: study(5).run(device="cuda:7"))
assert "names no device" in message(lambda: study(5).run(device=[]))
""", MYRIAD_SIMULATED_GPUS=2)


def test_a_study_on_an_interpreter_and_a_gpu(run):
    run("""
from myriad_ode.kernels import compiler
compiler.find_compiler = lambda: None
linear = my.model({x: v, v: -k * x}, events=[my.event(v, direction="falling", do={n: n + 1})],
                  accessories={n: 0})
made = lambda: my.study(linear, my.grid({k: my.linspace(1, 2, 300)}), start={x: 1, v: 0}, time=(0, 5),
                        rtol={x: 1e-9, v: 1e-8}, keep=[x, n])
cpu, both, gpu = (made().run(device=d, chunk=20) for d in ("cpu", ["cpu", "cuda"], "cuda"))
assert "interpreted" in cpu.kernel and "interpreted" in both.kernel and "interpreted" not in gpu.kernel
exact = np.cos(np.sqrt(np.linspace(1, 2, 300)) * 5)
assert all(np.allclose(result["x_end"], exact, atol=1e-6) for result in (cpu, both, gpu))
assert np.array_equal(cpu["n_end"], both["n_end"]) and np.array_equal(cpu["n_end"], gpu["n_end"])
""")


def test_a_device_that_fails_is_left_out_and_its_chunks_are_done_elsewhere(run):
    run("""
expected = study(300).run(device="cuda:0")
result = study(300).run(device=["cuda:0", "cuda:1"], chunk=10)
assert result.complete and same(result, expected, ["x_end", "peak_end", "n_end", "status"])
assert len(result.warnings) == 1 and "cuda:1 is left out" in result.warnings[0], result.warnings
assert "unspecified launch failure" in result.warnings[0]
alone = study(300)
assert "no device is left" in message(lambda: alone.run(device="cuda:1"))
""", MYRIAD_SIMULATED_GPUS=2, MYRIAD_SIMULATED_LAUNCHES=2)


def test_a_worker_of_an_executor_uses_its_gpu(run):
    run("""
expected = study(60).run(device="cuda")
with concurrent.futures.ThreadPoolExecutor(2) as pool:
    assert same(study(60).run(executor=pool, device="cuda", chunk=7), expected, ["x_end", "n_end", "status"])
""")


def test_several_gpus_go_on_where_another_program_takes_the_memory_of_one_meanwhile(run):
    run("""
# Instances of 8 KB, so that each GPU has several parts. The first kernel told the facts of the program.
more = dict(samples=1000, time=(0, 0.1))
expected = solve("cuda:0", 9000, **more)
both = solve(["cuda:0", "cuda:1"], 9000, **more)
assert both.report.by_status == {"success": 9000} and same(both, expected, ["x", "v", "peak", "n"])
""", MYRIAD_SIMULATED_GPUS=2, MYRIAD_SIMULATED_MEGABYTES=32, MYRIAD_SIMULATED_FULL_AFTER=2)


def test_several_gpus_in_one_call_have_the_bits_of_one(run):
    run("""
for more in (dict(record=dict(states=[x], accessories=[peak, n], time=True), phases=2), dict(samples=3)):
    one = solve("cuda:1", 1000, **more)
    all_three = solve(["cuda:0", "cuda:2", "cuda:1"], 1000, **more)
    assert all_three.report.device == "cuda:0, cuda:2, cuda:1" and all_three.report.registers == 99
    for name in ("x", "v", "peak", "n", "k", *(["t"] if "record" in more else [])):
        assert np.array_equal(one[name], all_three[name], equal_nan=True), (name, more)
    assert np.array_equal(one.accepted_steps, all_three.accepted_steps) and np.array_equal(one.status, all_three.status)
    assert one.report.accepted_steps == all_three.report.accepted_steps and one.report.by_status == {"success": 1000}
assert "is not on a GPU" in message(lambda: all_three.device["x"])
assert np.array_equal(solve(["cuda:0", "cuda:1", "cuda:2"], 2)["x"], solve("cuda", 2)["x"])
assert solve(["cuda", "cuda:0"], 2).device["x"].shape == (2,)  # one GPU
told = []
solve(["cuda:0", "cuda:1"], 100, progress=lambda done, total: told.append((done, total)))
assert told[-1] == (100, 100) and told == sorted(told)
assert "several devices of a call must be GPUs" in message(lambda: solve(["cuda", "cpu"], 5))
assert "interpreted on the CPU alone" in message(lambda: solve(["cuda", "cuda:1"], 5, interpreted=True))
given = OnGpu(np.linspace(0.2, 0.3, 50))
assert "several devices are given" in message(lambda: my.solve(
    model, {k: given, B: 0.3}, start={x: 1, v: 0}, time=(0, 1), device=["cuda:0", "cuda:1"]))
bad = np.linspace(0.2, 0.3, 50)
bad[7] = np.nan
call = lambda **more: my.solve(model, {k: bad, B: 0.3}, start={x: 1, v: 0}, time=(0, 1), device=["cuda:0", "cuda:1"],
                               **more)
assert "is not finite in 1 of 50 instances" in message(call)
assert call(invalid="mark").report.by_status == {"success": 49, "invalid_input": 1}
def stop(done, total):
    raise KeyboardInterrupt
try:
    solve(["cuda:0", "cuda:1"], 20_000, time=(0, 0.01), progress=stop)
except my.Interrupted as interrupted:
    assert 0 < interrupted.run.done <= 20_000 and interrupted.run.report.device == "cuda:0, cuda:1"
else:
    raise AssertionError("was not interrupted")
""", MYRIAD_SIMULATED_GPUS=3)


def test_a_call_on_several_gpus_ends_with_the_error_of_one_that_fails(run):
    run("""
assert "unspecified launch failure" in message(lambda: [solve(["cuda:0", "cuda:1"], 200) for _ in range(9)])
assert solve("cuda:0", 5).report.by_status == {"success": 5}
""", MYRIAD_SIMULATED_GPUS=2, MYRIAD_SIMULATED_LAUNCHES=2)


def test_parts_on_several_gpus_have_the_bits_of_a_whole(run):
    run("""
call = lambda device: my.solve(model, sweep(270_000), start={x: 1, v: 0.1}, time=(0, 0.01), device=device)
one, two = call("cuda"), call(["cuda:0", "cuda:1"])  # in four parts
for name in ("x", "v", "peak", "n"):
    assert np.array_equal(one[name], two[name]), name
""", MYRIAD_SIMULATED_GPUS=2)


GENERATED = """
s, e = my.accessory("s"), my.shared_integer("e")
drawn = my.model({x: v, v: x - x**3 - k * v + B * my.cos(t)}, accessories={peak: x},
                 events=[my.event(v, direction="falling", do={peak: my.maximum(peak, x), n: n + 1})],
                 generate={x: my.uniform(-1, 1), v: my.normal(0, 0.1), k: 0.2 + my.instance % e * 0.001 + 0 * B,
                           s: my.instance / 2, n: my.instance % 3})
kept = dict(keep=[x, v, k, peak, n, s])
names = ["x_end", "v_end", "k_end", "peak_end", "n_end", "s_end", "status"]

def generated(size, **more):
    return my.study(drawn, {B: 0.3, e: 100}, draws=size, **{**dict(time=(0, 6), rtol=1e-9), **kept, **more})
"""


def test_generated_instances_are_the_cpus_and_nothing_is_uploaded(run):
    run(GENERATED + """
for more in ({}, dict(seed=5, phases=2, record=dict(states=[x], accessories=[peak, n], time=True)),
             dict(samples=4, precision="float", rtol=1e-5)):
    cpu, gpu = (generated(300, **more).run(device=d) for d in ("cpu", "cuda"))
    assert gpu.complete and gpu.by_status == {"success": 300}
    for name in gpu.names:
        close = 0.1 if "precision" in more and name not in ("k_end", "s_end") else 1e-6
        equal = np.array_equal(cpu[name], gpu[name])  # as words are
        assert equal or np.allclose(cpu[name], gpu[name], atol=close, equal_nan=True), (name, more)
    for name in ("k_end", "s_end") if "precision" not in more else ():
        assert np.array_equal(cpu[name], gpu[name]), name
    parts = generated(300, **more).run(device=["cuda:0", "cuda:1"], chunk=17)
    assert parts.complete and not parts.warnings and same(parts, gpu, gpu.names)
size = 40_000
for made in (generated, study):  # a grid's axes too are evaluated there
    before = uploaded()
    made(size, time=(0, 0.1), keep=[], reduce=[my.reduce.mean("x_end")]).run(device="cuda")
    assert uploaded() - before < size, uploaded() - before  # less than a byte for each instance
before = uploaded()
solve("cuda", size, time=(0, 0.1))
assert uploaded() - before >= 8 * size
""", MYRIAD_SIMULATED_GPUS=2)


def test_generated_instances_have_the_bits_of_those_that_the_host_lays_out_on_a_gpu(run):
    run(GENERATED + """
first, second = my.accessory("first"), my.accessory("second")
begin = my.study(my.model({x: v, v: x - x**3 - k * v + B * my.cos(t)}, generate=dict(drawn.generate),
                          initialise={first: x, second: v}),
                 {B: 0.3, e: 100}, draws=200, time=(0, 1e-3), keep=[first, second, k, s, n]).run(device="cuda")
listed = my.study(my.model({x: v, v: x - x**3 - k * v + B * my.cos(t)}, accessories={peak: x, s: s},
                           events=[my.event(v, direction="falling", do={peak: my.maximum(peak, x), n: n + 1})]),
                  {B: 0.3, k: begin["k_end"], x: begin["first_end"], v: begin["second_end"]},
                  start={s: begin["s_end"], n: begin["n_end"].astype(float)}, time=(0, 6), rtol=1e-9, **kept)
assert same(listed.run(device="cuda"), generated(200).run(device="cuda"), names)
""")


def test_reductions_of_a_study_are_those_of_the_cpu(run):
    run(GENERATED + """
reductions = lambda: [my.reduce.mean("x_end"), my.reduce.minimum("x_end"), my.reduce.maximum("x"),
                      my.reduce.histogram("x_end", my.linspace(-2, 2, 11)), my.reduce.mean("x"),
                      my.reduce.variance("x"), my.reduce.standard_error("x_end"),
                      my.reduce.histograms("x", my.linspace(-2, 2, 11)),
                      my.reduce.quantiles("x", [0, 0.5, 1], my.linspace(-2, 2, 401))]
made = lambda **more: generated(700, phases=3, record=[x], reduce=reductions(), **more)
for device in ("cuda", ["cuda", "cuda:1"]):
    result = made().run(device=device, chunk=64)
    assert np.array_equal(result["x_end_histogram"], np.histogram(result["x_end"], np.linspace(-2, 2, 11))[0])
    of_each = [np.histogram(c, np.linspace(-2, 2, 11))[0] for c in result["x"].T]
    assert np.array_equal(result["x_histograms"], of_each) and len(of_each) == 3
    assert np.abs(result["x_quantiles"][1] - np.median(result["x"], axis=0)).max() <= 0.01
    assert result["x_end_minimum"] == result["x_end"].min()
    assert np.array_equal(result["x_maximum"], result["x"].max(axis=0))
    assert np.allclose(result["x_end_mean"], result["x_end"].mean(), rtol=1e-14)
    assert np.allclose(result["x_mean"], result["x"].mean(axis=0), rtol=1e-12)
    assert np.allclose(result["x_variance"], result["x"].var(axis=0, ddof=1), rtol=1e-12)
    assert np.isclose(result["x_end_standard_error"], result["x_end"].std(ddof=1) / 700**0.5, rtol=1e-12)
sums = study(50, reduce=[my.reduce.total("total", ["x_end"], 1, lambda c: c["x_end"].sum())]).run(device="cuda")
assert np.isclose(sums["total"], sums["x_end"].sum())
""", MYRIAD_SIMULATED_GPUS=2)


@pytest.mark.thorough
def test_a_generated_study_on_a_gpu_goes_on_and_marks_what_is_not_finite(run):
    run(GENERATED + """
import tempfile
def stop(done, total):
    if done >= 100:
        raise KeyboardInterrupt
folder = tempfile.mkdtemp() + "/store"
try:
    generated(2000).run(folder, device="cuda", chunk=50, progress=stop)
except my.Interrupted:
    pass
result = generated(2000).run(folder, device="cuda", chunk=50)
assert result.complete and same(result, generated(2000).run(device="cuda"), names)
bad = my.model({x: -x}, generate={x: my.where(my.instance % 5 == 0, 1.0, 0.0) / (my.instance % 5)})
assert my.study(bad, draws=50, time=(0, 1)).run(device="cuda").by_status == {"success": 40, "invalid_input": 10}
own = my.model({x: -x}, generate={x: 1})
domains = lambda **more: my.study(own, my.grid({my.t_end: my.linspace(1, 2, 5)}), time=(0, None), **more)
assert np.allclose(domains().run(device="cuda")["x_end"], np.exp(-np.linspace(1, 2, 5)), atol=1e-6)
assert "a time domain of its own" in message(lambda: domains(samples=3).run(device="cuda"))
assert domains(samples=3).run(device="cpu").complete
on_axis = lambda: my.study(my.model({x: -x}), my.grid({my.t_end: my.linspace(1, 2, 5)}), start={x: 1}, time=(0, None),
                           samples=3)  # the host looks at the domains, and sets the instances
assert np.allclose(on_axis().run(device="cuda")["x_sample"], domains(samples=3).run(device="cpu")["x_sample"])
""")


TEAMS = """
count = np.arange(n)
units = my.units(n, threads_per_instance=threads)
x, v = units.states("x v")
k, w, strength = units.parameter("k"), units.shared("w"), my.parameter("strength")
around = units.circulant_coupling("A", np.stack([np.roll([0, 0.2, *[0] * (n - 3), 0.1], i) for i in count]), 1)
sets = {k: [np.linspace(1, 2, 7) + 0.1 * i for i in range(n)], w: np.linspace(-1, 1, n)}

def compare(model, values=sets, precision="double", allowed=1e-3, **more):  # by teams, by one thread each, on the CPU
    start = {x: np.linspace(-1, 1, n), v: np.linspace(0, 1, n)}
    more = dict(start=start, time=(0, 2), rtol=1e-5, precision=precision, **more)
    names = [*model.states, *model.parameters, *model.accessories, *model.integer_accessories]
    team, here = (my.solve(model, values, device=device, **more) for device in ("cuda", "cpu"))
    usual = my.Model.device_source
    def of_one_thread(*asked):
        text, struct = usual(*asked)
        return text.replace(f"threads_per_instance = {threads}", "threads_per_instance = 1"), struct
    my.Model.device_source = of_one_thread
    alone = my.solve(model, values, device="cuda", **more)
    my.Model.device_source = usual
    assert (team.report.threads_per_instance, alone.report.threads_per_instance) == (threads, 1)
    assert same(team, alone, names) and np.array_equal(team.status, alone.status)
    assert np.array_equal(team.rhs_evaluations, alone.rhs_evaluations)
    wrong = [name for name in names if not np.allclose(team[name], here[name], rtol=allowed, atol=allowed)]
    assert not wrong, (wrong, [(team[name], here[name]) for name in wrong[:2]])
    return team
"""


@pytest.mark.parametrize("precision", ["double", "float"])
def test_teams_sum_the_matrices_of_units_as_one_thread_does(run, precision):
    run("n, threads = 19, 8" + TEAMS + f"""
full, row = np.random.default_rng(4).normal(size=(n, n)) / n, np.linspace(-0.1, 0.1, n)
F = units.full_coupling("F", full)
B = units.banded_coupling("B", np.where(np.abs(np.subtract.outer(count, count)) <= 2, full, 0), 2)
C = units.circulant_coupling("C", np.stack([np.roll(row, i) for i in count]))
force = w * (F @ np.sin(x)) + B @ v - C @ np.cos(x) + np.roll(F @ x, 1)
compare(my.model({{x: v + around @ v, v: force - k * x}}), precision={precision!r})
""")


def test_units_that_see_each_other_late_are_the_cpus_in_teams_and_by_one_thread(run):
    run("""
n, tau, strength = 18, my.parameter("tau"), my.parameter("strength")
taus = np.linspace(0.3, 1.2, 11)
def solved(device, taus, threads=None):
    units = my.units(n, threads_per_instance=threads)
    angle = units.state("angle")
    A = units.full_coupling("A", np.ones((n, n)) / n)
    sine, cosine = A @ my.delayed(np.sin(angle), tau), A @ my.delayed(np.cos(angle), tau)
    late = my.model({angle: 1 + strength * (np.cos(angle) * sine - np.sin(angle) * cosine)})
    return my.solve(late, {tau: taus, strength: 0.7}, start={angle: 0.2 * np.arange(n)}, time=(0, 6), rtol=1e-8,
                    atol=1e-8, device=device)
there, here, some = solved("cuda", taus), solved("cpu", taus), solved("cuda", taus[4:7])
alone = solved("cuda", taus, 1)  # written out
assert there.report.threads_per_instance == 16 and (there.status == "success").all()
assert alone.report.threads_per_instance == 1
for i in range(n):
    state = f"angle_{i}"
    for other in (here, alone):
        assert np.allclose(there[state], other[state], rtol=1e-12, atol=1e-12), state
    assert np.array_equal(there[state][4:7], some[state])
""")


def test_teams_integrate_units_with_lags_of_their_own_and_slopes_of_the_past_as_one_thread_does(run):
    run("n, threads = 20, 8" + TEAMS + """
late, seen = units.parameter("late"), units.accessory("seen")
far = my.delayed(np.roll(x, 1), late)
springs = my.model(
    {x: v - 0.3 * far, v: 0.2 * my.delayed_slope(x, late) - x + 0.1 * np.roll(far, 3)}, accessories={seen: 0},
    history={x: w + my.sin(my.time)}, events=units.events(x + 0.1 * np.roll(far, 2), name="pass", do=lambda i: {
        v[i]: v[i] + 0.1 * far[i], seen[i]: seen[i] + far[(i + 1) % n]}))
lags = {late: [np.linspace(0.4, 0.9, 5) + 0.03 * i for i in range(n)], w: sets[w]}
team = compare(springs, lags, history_steps=4096)
assert (team.status == "success").all() and any(team[name].any() for name in springs.accessories)
""")


@pytest.mark.thorough
def test_teams_call_the_hooks_of_units_and_find_their_events_and_summaries_as_one_thread_does(run):
    run("n, threads = 3, 2" + TEAMS + """
top, when, work, last = (units.accessory(name) for name in ("top", "when", "work", "last"))
turns, total, seen = units.integer_accessory("turns"), my.accessory("total"), my.integer_accessory("seen")
def turned(i):
    return {v[i]: 0.9 * v[i], v[(i + 1) % n]: v[(i + 1) % n] + 0.01 * x[i], turns[i]: turns[i] + 1, seen: seen + 1,
            last[i]: my.time}
model = my.model(
    {x: v, v: strength * (around @ x) - k * x - 0.02 * last * v + w * my.cos(3 * my.time)},
    accessories={top: my.phase_maximum(x * x), when: my.time_of_maximum(x * x), last: 0, turns: 0,
                 work: my.integral(np.roll(x, 1) * v), seen: 0, total: None},
    events=[*units.events(v, name="turn", direction="falling", do=turned),
            *units.events(x - 0.1 - 0.1 * last, name="rise", direction="rising", tolerance=1e-6,
                          do=lambda i: {k[i]: 1.01 * k[i]})],
    stops=my.stop(0.3, every=0.4, do={v: v + 0.05, strength: strength * 0.9}),
    initialise={v: v + 0.1}, after_step={last: 0.999 * last, my.end_phase: seen >= 4},
    finalise={total: sum(x), v: 0.5 * v + x})
team = compare(model, {**sets, strength: 0.4}, allowed=0.01)
assert set(team["seen"] >= 4) == {True, False} and (team["strength"] < 0.4).all()
assert sum((team[f"k_{i}"] > sets[k][i]).any() for i in range(n)) > 1
""")


def test_studies_generate_the_instances_of_units_that_teams_integrate(run):
    run("n, threads = 19, 8" + TEAMS + """
first = units.accessory("first")
drawn = {x: my.instance * 0.1 - 0.5, v: my.uniform(-1, 1), k: my.normal(2, 0.1), strength: my.uniform()}
model = my.model({x: v, v: strength * (around @ x) - k * x}, initialise={first: x}, generate=drawn)
assert "coupled_units" in model.device_source("tsitouras_5", "double")[0]
kept = [x[0], x[18], k[3], first[18], strength]
team, here = (my.study(model, draws=50, time=(0, 1), rtol=1e-8, keep=kept).run(device=d) for d in ("cuda", "cpu"))
assert all(np.array_equal(team[name], here[name]) or np.allclose(team[name], here[name], rtol=1e-6, atol=1e-6)
           for name in team.names)
assert len(set(team["k_3_end"])) == 50 and np.array_equal(team["first_18_end"], np.arange(50) * 0.1 - 0.5)
""")


ENDLESS = """
import signal, threading, time
end = np.ones(400)
end[130::200] = 1e12
def endless(device, **more):
    begin = time.perf_counter()
    try:
        return my.solve(model, sweep(400), start={x: -0.5, v: -0.1}, time=(0, end), device=device,
                        max_steps=2_000_000_000, **more)
    finally:
        assert time.perf_counter() - begin < 120  # with the time to compile it
def check(run):
    assert run.status[130] == "interrupted"  # the simulated threads run one after the other
    assert np.isfinite(run["x"]).all() and (run.t_last[130::200] < 1e12).all()
    assert set(run.report.by_status) <= {"success", "interrupted", "not_started"}
"""


@pytest.mark.parametrize("more", ["phases=2", "schedule='dynamic'"])
def test_a_kernel_that_runs_for_ever_ends_by_time_limit(run, more):
    device = "'cuda'"  # one kernel alone, as launches of this driver wait for the one before
    run(ENDLESS + f"""
limited = endless({device}, time_limit=0.5, {more})
check(limited)
assert limited.report.by_status["interrupted"] + limited.report.by_status.get("success", 0) == 400
assert any("time_limit = 0.5 s was over" in note for note in limited.report.notes)
assert endless({device}, time_limit=0.2, {more}).report.by_status["interrupted"] >= 1
assert solve({device}, 50).report.by_status == {{"success": 50}}  # the next call is not stopped
""", MYRIAD_SIMULATED_GPUS=2)


def test_ctrl_c_ends_a_kernel_that_runs_for_ever(run):
    device = "'cuda'"
    run(ENDLESS + f"""
endless({device}, time_limit=0.1)  # compiled, so that the signal comes while the kernel runs
threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
try:
    endless({device})
except my.Interrupted as interrupted:
    check(interrupted.run)
else:
    raise AssertionError("was not interrupted")
assert solve({device}, 50).report.by_status == {{"success": 50}}
""", MYRIAD_SIMULATED_GPUS=2)


JAX = """
import jax
from myriad_ode.gradients.jax_adapter import jax_function
jax.config.update("jax_enable_x64", True)

damping = my.parameter("damping")
spring = my.model({x: v, v: -k * x - damping * v}, name="spring")
sets = np.random.default_rng(0).uniform(0.1, 1, (7, 3))

def function(device, **more):
    usual = dict(free=[k, damping, v], of=[v, x], start={x: 1}, time=(0, 3), samples=4, rtol=1e-9, device=device)
    return my.batched(spring, **{name: value for name, value in {**usual, **more}.items() if value is not None})

def on_gpu(**more):  # as JAX's arrays on the CPU are in the memory of the simulated GPU
    return jax_function(function("cuda", **more), platform="cpu")

def loss(f):
    return lambda theta: (f(theta)**2).sum()

def close(a, b):
    return np.allclose(a, b, rtol=1e-12, atol=1e-13)
"""


@pytest.fixture(scope="module")
def run_jax(run):
    pytest.importorskip("jax")
    return lambda script, **variables: run(JAX + script, **variables)


@pytest.mark.thorough
def test_jax_programs_on_a_gpu_have_the_results_and_derivatives_of_the_host_in_one_call(run_jax):
    run_jax("""
from myriad_ode.gradients import forward
there, here = on_gpu(), function("cpu").to_jax()
for theta in sets, sets[0], np.stack([sets, sets]):
    found = there(theta)
    assert found.shape == (*theta.shape[:-1], 4, 2) and close(found, here(theta))
sizes, usual = [], forward.solve
forward.solve = lambda *a, **o: (sizes.append(1), usual(*a, **o))[1]
gradients = jax.jit(jax.vmap(jax.grad(loss(there))))
found = gradients(sets)
assert len(sizes) == 1
forward.solve = usual
assert close(found, jax.vmap(jax.grad(loss(here)))(sets))
assert close(jax.grad(lambda all: jax.vmap(loss(there))(all).sum())(sets), found)
assert close(jax.vmap(jax.vmap(there))(np.stack([sets, sets]))[1], here(sets))
assert close(jax.jacfwd(there)(sets[0]), jax.jacrev(here)(sets[0]))
program = gradients.lower(sets).as_text()
assert "myriad_on_gpu" in program and "callback" not in program
assert there(np.zeros((0, 3))).shape == (0, 4, 2)
for more in {"of": x}, {"samples": None}, {"options": my.Options(samples=3), "samples": None}:
    assert close(on_gpu(**more)(sets), function("cpu", **more)(sets))
""")


def test_jax_programs_that_a_gpu_cannot_integrate_go_by_the_host(run_jax):
    run_jax("""
def program(f, theta=sets):
    return jax.jit(f).lower(theta).as_text()
assert "callback" in program(on_gpu(), sets.astype(np.float32))
for more in ({"of": [x, my.time], "samples": None}, {"make_consistent": True}, {"invalid": "mark"},
             {"precision": "float"}):
    assert "myriad_on_gpu" not in program(on_gpu(**more)), more
single = on_gpu(precision="float", rtol=1e-4)
assert "myriad_on_gpu" in program(single, sets.astype(np.float32))
assert np.allclose(single(sets.astype(np.float32)), function("cpu")(sets), atol=1e-3)
assert "myriad_on_gpu" not in program(jax_function(function("cpu"), platform="cpu"))
assert "myriad_on_gpu" not in program(jax_function(function(["cuda:0", "cuda:1"]), platform="cpu"))
""", MYRIAD_SIMULATED_GPUS=2)


def test_jax_programs_on_a_gpu_tell_of_failures(run_jax):
    run_jax("""
failing = my.batched(my.model({x: k * x * x}, name="bursting"), free=k, of=x, start={x: 1}, time=(0, 2), max_steps=1000,
                     device="cuda")
f = jax_function(failing, platform="cpu")
values, slopes = f(np.array([[0.1], [1.0]])), jax.vmap(jax.jacrev(f))(np.array([[0.1], [1.0]]))
assert np.isfinite(values[0]) and np.isnan(values[1]) and np.isfinite(slopes[0]).all() and np.isnan(slopes[1]).all()
wrong = sets.copy()
wrong[3, 1] = np.nan
for f in on_gpu(), jax.jit(jax.vmap(jax.grad(loss(on_gpu())))):
    assert "parameter 1 (damping) is nan in instance 3" in message(lambda: jax.block_until_ready(f(wrong)), Exception)
there = jax_function(function("cuda:1"), platform="cpu")
assert 'give device="cuda:0" to my.batched' in message(lambda: jax.block_until_ready(there(sets)), Exception)
assert close(on_gpu()(sets), function("cpu")(sets))  # and goes on
""", MYRIAD_SIMULATED_GPUS=2)


def test_jax_programs_run_in_several_threads_and_after_their_functions_are_gone(run_jax):
    run_jax("""
import gc, sys
sys.setswitchinterval(1e-5)
def compiled(of):
    return jax.jit(on_gpu(of=of)).lower(sets).compile()
of_x, of_v = compiled(x), compiled(v)
gc.collect()
both = function("cpu")(sets)
def check(number):
    program, expected = ((of_x, both[..., 1:]), (of_v, both[..., :1]))[number % 2]
    return close(program(sets), expected)
with concurrent.futures.ThreadPoolExecutor(4) as threads:
    assert all(threads.map(check, range(40)))
""")


def test_samples_that_stay_on_a_gpu_take_no_memory_of_the_host(run):
    run("""
size, samples = 2000, 2000
def memory():  # that the process has, in bytes
    return int(pathlib.Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")
solve("cuda", size, samples=10)
before = memory()
all = solve("cuda", size, samples=samples)
taken, bytes_of_samples = memory() - before, size * samples * 8 * 3
assert 0.5 * bytes_of_samples < taken < 1.5 * bytes_of_samples, (taken, bytes_of_samples)  # the simulated GPU's own
assert np.isfinite(all["x"]).all() and np.array_equal(all["x"], on_host(all.device["x"]))
""", MYRIAD_SIMULATED_MEGABYTES=4096)


ADJOINT = """
from myriad_ode.gradients import adjoint
x, y = my.states("x y")
a, b, c = my.parameters("a b c")
model = my.model({x: a * x - b * x * y, y: b * x * y - y + c * my.exp(-x * x)},
                 events=[my.event(x - 1.5, direction="falling", do={y: 0.5 * y + c})],
                 stops=[my.stop([0.7], do={x: x + 0.1 * a})])
rows = np.random.default_rng(1).uniform(0.5, 1.5, (50, 4))
usual = dict(free=[a, b, c, x], of=[y, x], start={y: 1.0}, time=(0, 3), rtol=1e-6, atol=1e-6, adjoint=True)

def gradient(device, **more):
    weights = lambda values: np.cos(values)
    return my.batched(model, **{**usual, "device": device, **more}).vjp(rows, weights)

def close(found, expected):
    for one, other in zip(found, expected):
        np.testing.assert_allclose(one, other, rtol=1e-11, atol=1e-11)
"""


@pytest.mark.parametrize("method", ["dormand_prince_5", pytest.param("rodas_5p", marks=pytest.mark.thorough)])
def test_an_adjoint_on_a_gpu_has_the_gradients_of_the_cpu(run, method):
    run(MODEL + ADJOINT + f"""
for samples in (None, [0.0, 0.5, 0.7, 2.9, 3.0]):
    of = dict(samples=samples, method="{method}")
    close(gradient("cuda", **of), gradient("cpu", **of))
""")


@pytest.mark.thorough
def test_an_adjoint_on_a_gpu_takes_instances_in_groups_that_have_room(run):
    run(MODEL + ADJOINT + """
expected = gradient("cpu")
made = my.batched(model, **usual, device="cuda")
assert made.adjoint._most_on_gpu == 1 << 30  # more than there is
close(made.vjp(rows, np.cos), expected)
assert made.adjoint._most_on_gpu < 1 << 20, made.adjoint._most_on_gpu
""", MYRIAD_SIMULATED_MEGABYTES=4)
    run(MODEL + ADJOINT + """
said = message(lambda: gradient(["cuda", "cpu"]))
assert "several devices" in said and "leave out adjoint=True" in said, said
""")
