# SPDX-License-Identifier: MIT
"""Models compile by NVRTC, for GPUs that this machine need not have, and to no more registers than by nvcc."""

import concurrent.futures
import os
import pathlib
import re
import shutil
import struct
import subprocess

import numpy as np
import pytest

import example_models
import myriad_ode as my
import test_cpp
from myriad_ode import _core
from myriad_ode.kernels import compiled_files, nvrtc
from myriad_ode.gradients.adjoint import Adjoint
from myriad_ode.models.methods import method_type, methods, stochastic
from myriad_ode.models.sensitivities import with_sensitivities

pytestmark = [pytest.mark.long, pytest.mark.skipif(nvrtc.find() is None, reason="there is no NVRTC")]
# Where there is a driver, NVRTC 13 takes what it compiled before from a cache, and then tells nothing of what it did
# (github.com/NVIDIA/cuda-python/issues/1124).
os.environ["CUDA_CACHE_DISABLE"] = "1"
nvcc = shutil.which("nvcc")
include = pathlib.Path(my.__file__).parent / "include"


def lyapunov():
    """Tangents, derived from the model's own right-hand side."""
    return my.with_tangents(example_models.duffing(), 2)


def epidemic():
    """A model in C++ that draws random numbers."""
    text = (test_cpp.root / "examples/monte_carlo/epidemic.hpp").read_text()
    return my.CppModel(text, "epidemic", "s i", "R0 duration", "R0_mean R0_deviation duration_least duration_most",
                       "seed", "peak day", events="turning_point")


def remainders():
    """Rounding, remainders, and whole numbers that go round."""
    x, n, a = my.state("x"), my.integer_accessory("n"), my.accessory("a")
    return my.model({x: round(x) - x % 0.3 + x // 0.7 + my.fmod(x, 0.1) + my.log1p(my.expm1(x))},
                    accessories={n: 0}, after_step={n: n + 1}, finalise={n: n * n // 3 - n % -5, a: n / 2 % 0.3})


def ring():
    """Units that a team of threads integrates."""
    x, v = (ring := my.units(20)).states("x v")
    A = ring.full_coupling("A", np.ones((20, 20)))
    return my.model({x: v, v: -ring.parameter("k") * np.roll(x, 1) + A @ np.sin(x)})


def bells():
    """Units in teams with hooks, events, an extremum, and two sums by one matrix."""
    x, v = (units := my.units(6, threads_per_instance=4)).states("x v")
    A, top, turns = units.full_coupling("A", np.eye(6)), units.accessory("top"), units.integer_accessory("turns")
    return my.model({x: v + A @ v, v: A @ np.sin(x) - x}, accessories={top: my.phase_maximum(x), turns: 0},
                    events=units.events(v, name="turn", do=lambda i: {turns[i]: turns[i] + 1}),
                    after_step={my.end_phase: turns[0] > 9})


def dosed():
    """Derivatives by the times of doses."""
    x, at = my.state("x"), my.parameter("at")
    stops = [my.stop(at, do={x: x + 1}), my.stop(0, every=at, name="again", do={x: x + 2})]
    return with_sensitivities(my.model({x: -x}, stops=stops), [at])


def pulsed():
    """Pulses whose times are computed for each instance, and an integral of them."""
    x, area, width, on = my.state("x"), my.accessory("area"), my.parameter("width"), my.time % my.parameter("T")
    return my.model({x: my.where(on < width, 1.0, 0.0) - x}, events=my.event(x - 0.5, do={width: 0.5 * width}),
                    accessories={area: my.integral(my.where(on < width, x, 0.0))})


def bistable():
    """A particle that noise drives over a barrier."""
    x, sigma = my.state("x"), my.parameter("sigma")
    return my.model({x: x - x**3}, noise={x: sigma * my.sqrt(1 + x * x)}, after_step={my.end_phase: x > 1})


def sharing():
    """Two states that share processes."""
    (x, v), (W, V) = my.states("x v"), my.wiener("W V")
    return my.model({x: -x, v: x - v}, noise={x: {W: 0.1 * x, V: 0.2}, v: {W: my.cos(my.time)}})


# What is compiled for each method: models with every kind of hook and event, outputs along the solution, tables.
cases = [
    (example_models.duffing, "cash_karp", (), False, "double"),
    (example_models.relief_valve, "dormand_prince_5", ("pi_control",), False, "double"),
    (example_models.damped, "tsitouras_5", (), True, "double"),
    (example_models.stick_slip, "verner_7", ("rms_norm", "automatic_first_step"), False, "double"),
    (example_models.bouncing_ball, "dormand_prince_8", ("tolerance_per_instance",), False, "float"),
    (example_models.settling, "runge_kutta_4", (), True, "float"),
    (example_models.oregonator, "rosenbrock_23", (), False, "double"),
    (lyapunov, "tsitouras_5", (), False, "double"),
    (epidemic, "cash_karp", (), False, "float"),
    (remainders, "tsitouras_5", (), False, "double"),
    (ring, "tsitouras_5", ("rms_norm",), True, "double"),
    (bells, "cash_karp", (), False, "double"),
    (dosed, "tsitouras_5", (), False, "double"),
    (pulsed, "tsitouras_5", (), False, "float"),
    (example_models.continuation, "rodas_5p", ("pid_control", "mixed_scale"), True, "double"),
    (bistable, "milstein", (), False, "double"),
    (sharing, "stochastic_heun", (), True, "float"),
]
models = (*example_models.headers, test_cpp.every_operation, epidemic)
every_model = [(model, "cash_karp", (), False, real) for model in models for real in ("double", "float")]
every_method = [(model, method, (), True, "double") for model in models for method in methods
                if method not in stochastic]
architectures = (75, 80, 90, 100, 103)


def source_of(case, edit=lambda header: header):
    model, method, control, dense, real = case
    made = model()
    header, struct = made.device_source(method, real) if isinstance(made, my.Model) else made.source()
    shared = len(made.shared) * (8 if real == "double" else 4) + 4 * len(made.shared_integers)
    return nvrtc.source_of(edit(header), struct, method_type(method, control, dense), real,
                           nvrtc.placement(shared, 232_448))


def sections_of(image):
    """The contents of the sections of an ELF file of 64 bits by name."""
    start, = struct.unpack_from("<Q", image, 40)
    size, count, names = struct.unpack_from("<3H", image, 58)
    headers = [struct.unpack_from("<IIQQQQ", image, start + i * size) for i in range(count)]
    first = headers[names][4]
    return {image[first + h[0]:image.index(b"\0", first + h[0])].decode(): image[h[4]:h[4] + h[5]] for h in headers}


def resources(image):
    """(registers, bytes of stack) of the kernel, from its machine code: what the compiler says may be missing."""
    sections = sections_of(image)
    facts, found, place = sections[".nv.info"], {}, 0
    while place < len(facts):  # a format, an attribute, and two bytes: a value, or the length of one that follows
        form, attribute, length = struct.unpack_from("<BBH", facts, place)
        place += 4
        if form == 4:  # EIFMT_SVAL
            if attribute in (0x2f, 0x11):  # EIATTR_REGCOUNT, EIATTR_FRAME_SIZE: of a function, by its symbol
                symbol, value = struct.unpack_from("<II", facts, place)
                name, = struct.unpack_from("<I", sections[".symtab"], 24 * symbol)
                if sections[".strtab"][name:].startswith(b"myriad_integrate\0"):
                    found[attribute] = value
            place += length
    return found[0x2f], found[0x11]


def by_nvrtc(case, architecture=90):
    image, said = nvrtc.library().compile(source_of(case), architecture)
    assert image[:4] == b"\x7fELF" and "warning" not in said, said
    return resources(image)


def by_nvcc(case, folder):
    name = f"{case[0].__name__}_{case[1]}_{case[3]}_{case[4]}"
    file = folder / f"{name}.cu"
    file.write_text(source_of(case, lambda header: header.replace("#pragma once", "")))
    made = folder / f"{name}.cubin"
    done = subprocess.run([nvcc, "-std=c++20", "-prec-div=false", "-arch=sm_90", "-cubin", "-diag-suppress=1427",
                           f"-I{include}", str(file), "-o", str(made)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return resources(made.read_bytes())


def all_of(function, arguments):
    """The results for several arguments, at the same time."""
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        return list(pool.map(lambda a: function(*a), arguments))


@pytest.mark.thorough
@pytest.mark.skipif(nvcc is None, reason="there is no nvcc")
def test_kernels_have_the_registers_that_nvcc_gives_them(tmp_path, request):
    chosen = [*cases, *every_model] if request.config.getoption("--all") else [cases[4]]
    pairs = all_of(lambda case: (by_nvrtc(case), by_nvcc(case, tmp_path)), [(case,) for case in chosen])
    wrong = [(case[0].__name__, *case[1:], ours, theirs) for case, (ours, theirs) in zip(chosen, pairs)
             if ours[0] > 1.1 * theirs[0] + 4 or ours[1] > theirs[1] + 64]  # of another version of the compiler
    assert not wrong, wrong


def test_all_methods_hooks_and_events_compile(request):
    of_all = request.config.getoption("--all")
    some = [case for case in cases if case[0] in (example_models.stick_slip, ring, pulsed, sharing,
                                                          example_models.continuation)]
    wanted = [(case, a) for case in cases for a in architectures] if of_all else [(case, 90) for case in some]
    found = all_of(by_nvrtc, [*wanted, *((case, 90) for case in every_method if of_all)])
    assert all(0 < registers < 256 for registers, _ in found)


@pytest.mark.thorough
def test_units_beyond_the_registers_of_a_thread_are_compiled_for_teams(monkeypatch):
    case = ring, "tsitouras_5", (), False, "double"
    stack_of_team = by_nvrtc(case)[1]
    monkeypatch.setattr(my.Model, "device_source", lambda model, method, precision: model.source())
    assert stack_of_team < 128 and by_nvrtc(case)[1] > 512


def generating():
    x, v, k = *my.states("x v"), my.parameter("k")
    return my.model({x: v, v: -k * x}, generate={x: my.uniform(-1, 1), v: my.normal(), k: my.instance % 7 * 0.1})


@pytest.mark.parametrize("precision", ["double", "float"])
def test_the_kernel_that_generates_instances_is_compiled_for_models_that_do(precision):
    header, struct = generating().source()
    asked = (header, struct, method_type("cash_karp", (), False), precision, "constant_bank")
    for generates in (True, False):
        image, said = nvrtc.library().compile(nvrtc.source_of(*asked, generates), 90)
        assert "warning" not in said, said
        assert (b"\0myriad_generate\0" in image) == generates and b"\0fill_components\0" not in image


def test_the_kernels_of_studies_compile_for_all_gpus():
    for architecture in architectures:
        image, said = nvrtc.library().compile("#include <myriad/python/study_program.cuh>\n", architecture)
        assert "warning" not in said, said
        assert all(f"\0{name}\0".encode() in image for name in ("fill_components", "gather_values", "reduce_values"))


def test_registers_and_stack_are_those_that_ptxas_tells():
    text = """extern "C" __global__ void myriad_integrate(double* a, int n) {
        double stored[100];
        for (int i = 0; i < n; ++i) stored[i] = a[i];
        for (int i = 0; i < n; ++i) a[i] += stored[n - i - 1];
    }"""
    image, said = nvrtc.library().compile(text, 90, ["--ptxas-options=-v"])
    stack, registers = re.search(r"(\d+) bytes stack frame.*?Used (\d+) registers", said, re.S).groups()
    assert resources(image) == (int(registers), int(stack)) and int(stack) >= 800


def test_tables_and_many_shared_parameters_are_read_from_shared_memory():
    x, y = my.states("x y")
    table = my.table("W", [[0.1 * i * j for i in range(40)] for j in range(8)])
    model = my.model({x: sum(table[i, 3] * y for i in range(8)), y: -x})
    header, struct = model.source()
    source = nvrtc.source_of(header, struct, "myriad::cash_karp", "double", nvrtc.placement(8 * 320, 232_448))
    assert "shared_memory" in source
    assert nvrtc.library().compile(source, 90)[0][:4] == b"\x7fELF"


def test_a_gpu_newer_than_nvrtc_gets_ptx_and_an_older_one_a_message():
    library = nvrtc.library()
    newest = library.architectures[-1]
    assert library.target(newest + 100) == (f"-arch=compute_{newest}", "PTX")
    image, _ = library.compile(source_of(cases[0]), newest + 100)
    assert f".target sm_{newest}".encode() in image and image.endswith(b"\0")
    assert library.target(90) == ("-arch=sm_90", "CUBIN")
    with pytest.raises(my.Error, match="this one has 3.5: install an older one"):
        library.target(35)


def test_an_nvrtc_that_is_too_old_is_refused(monkeypatch):
    monkeypatch.setattr(nvrtc, "_oldest", (1000, 0))
    with pytest.raises(my.Error, match="NVRTC .* is too old: install 1000.0 or newer"):
        nvrtc._Nvrtc(nvrtc.library()._functions)


def test_the_first_message_of_nvrtc_is_told():
    with pytest.raises(my.Error, match="the model does not compile .NVRTC .*: identifier \"nothing\" is undefined$"):
        nvrtc.library().compile("double a = nothing; double b = nothing_either;", 90)


def test_without_nvrtc_the_message_says_what_to_install(monkeypatch):
    monkeypatch.setattr(nvrtc, "find", lambda: None)
    monkeypatch.delenv("MYRIAD_NVRTC", raising=False)
    with pytest.raises(my.Error, match="pip install nvidia-cuda-nvrtc"):
        nvrtc.library()
    monkeypatch.setenv("MYRIAD_NVRTC", "/nowhere/libnvrtc.so")
    with pytest.raises(my.Error, match="MYRIAD_NVRTC is '/nowhere/libnvrtc.so', and there is no such file"):
        nvrtc.library()


def test_the_newest_nvrtc_that_the_driver_can_take_is_chosen(monkeypatch, tmp_path):
    paths = [tmp_path / f"libnvrtc.so.{major}" for major in (13, 12, 99)]
    for path in paths:
        path.touch()
    monkeypatch.setattr(nvrtc, "_candidates", lambda: paths)
    choose = nvrtc._find.__wrapped__
    assert [choose(None, driver).name[-2:] for driver in (12, 13, 98, 99)] == ["12", "13", "13", "99"]
    assert choose(None, 11).name[-2:] == "12"


def test_without_a_driver_the_message_says_so():
    if not _core.no_gpu():
        pytest.skip("there is a GPU")
    x = my.state("x")
    with pytest.raises(my.Error, match="device \"cuda\" is not available: .*; use \"cpu\" or \"auto\""):
        my.solve(my.model({x: -x}), start={x: 1}, time=(0, 1), device="cuda")
    assert my.solve(my.model({x: -x}), start={x: 1}, time=(0, 1), device="auto").report.device == "cpu"


def test_a_kernel_that_generates_is_not_taken_for_one_that_does_not(monkeypatch):
    """The kernels in memory are told apart by all that their file has."""
    class Core:
        gpu = staticmethod(lambda device: ("a GPU", 90, 1 << 17))

    compiled = []
    monkeypatch.setattr(nvrtc, "_core", Core)
    monkeypatch.setattr(nvrtc, "_loaded", {})
    monkeypatch.setattr(nvrtc, "_cached", lambda source, *_: (
        compiled.append(source) or compiled_files.Obtained(source, True)))
    asked = ("struct decay {};", "decay", "myriad::cash_karp", "double", (0, 0), 0)
    for generates in (False, True, False, True):
        assert ("GENERATE" in nvrtc.kernel(*asked, generates).library) == generates
    assert len(compiled) == 2


@pytest.mark.parametrize("method", ["tsitouras_5", "rodas_5p"])
def test_an_adjoint_through_jumps_and_actions_compiles(method):
    x, height = my.state("x"), my.parameter("height")
    model = my.model({x: my.where(my.time % 10 < 1, height - x * x, -x)}, events=my.event(x - 0.9, do={x: 0.5 * x}))
    made = Adjoint(model, ["height"], ["x"], {}, {"x": 0.0}, {"time": (0, 24), "method": method, "device": "cpu"}, 3)
    made._gpu = 0
    image, _ = nvrtc.library().compile(made._source(), 90)
    assert b"myriad_adjoint" in image
