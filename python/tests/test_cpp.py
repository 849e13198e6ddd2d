# SPDX-License-Identifier: MIT
"""The C++ that models are written as: it compiles, without warnings, and computes what the examples' models compute."""

import pathlib
import re
import shutil
import subprocess

import numpy as np
import pytest

import example_models
import myriad_ode as my
from myriad_ode.symbolic import symbols

root = pathlib.Path(__file__).resolve().parents[2]
compiler = shutil.which("g++")
warnings = ["-Wall", "-Wextra", "-Wconversion", "-Wshadow", "-Wfloat-conversion", "-Werror", "-Wno-psabi"]


def compile_cpp(folder, source, *flags):
    """Compiles a text, and returns what the compiler says if it fails."""
    (folder / "source.cpp").write_text(source)
    command = [compiler, "-std=c++20", "-ffp-contract=off", f"-I{root}/include", f"-I{root}/backends/openmp",
               f"-I{root}", f"-I{folder}", f"-I{pathlib.Path(__file__).parent}", "source.cpp", *flags]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    return done.stderr if done.returncode else ""


@pytest.mark.skipif(compiler is None, reason="there is no g++")
def test_traced_examples_have_the_bits_of_the_written_ones(tmp_path):
    lines = ["#include \"same_bits.hpp\""]
    lines += [f"#include \"{header}\"" for make, header in example_models.headers.items()
              if make not in example_models.renamed]
    pairs = []
    for make, header in example_models.headers.items():
        model = make()
        written = model.name
        if make in example_models.renamed:
            lines += [f"namespace of_{model.name} {{", f"#include \"{header}\"", "}"]
            written = f"of_{model.name}::{example_models.renamed[make]}"
        (tmp_path / f"{model.name}.hpp").write_text(model.cpp(f"traced_{model.name}"))
        lines.append(f"#include \"{model.name}.hpp\"")
        pairs.append(f"same_bits::compare<{written}, traced_{model.name}>(\"{model.name}\")")
    wrong = example_models.duffing().cpp("wrong").replace("p[k] * y[v] +", "p[k] * y[v] -")
    lines += [wrong.replace("#pragma once", ""), "int main() {",
              "if (same_bits::compare<duffing, wrong>(\"wrong\") != 3) return 1;"]
    lines.append("return " + " + ".join(pairs) + "; }")
    said = compile_cpp(tmp_path, "\n".join(lines), "-O1", "-march=native", *warnings, "-o", "compare")
    assert not said, said
    done = subprocess.run([tmp_path / "compare"], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout
    assert done.stdout.count("compared") == len(pairs) + 1


def every_operation():
    """A model with all operations and functions, and with everything that hooks can assign and read."""
    x, v = my.states("x v")
    k, (B, C), n = my.parameter("k"), my.shared("B C"), my.shared_integer("n")
    mode, count = my.integer_accessory("mode"), my.integer_accessory("count")
    a, b = my.accessory("a"), my.accessory("b")
    peak, at_peak = my.accessory("peak"), my.accessory("at_peak")
    unary = (my.sqrt, my.cbrt, my.abs, my.floor, my.round, my.sin, my.cos, my.tan, my.asin, my.acos, my.atan, my.sinpi,
             my.cospi, my.sinh, my.cosh, my.tanh, my.exp, my.exp2, my.expm1, my.log, my.log1p, my.log2, my.log10,
             my.reciprocal, my.rsqrt, my.ceil, my.trunc)
    total = sum(function(0.1 + 0.05 * my.abs(v)) for function in unary)
    total += my.pow(my.abs(x) + 1, 1.7) + my.powr(my.abs(x) + 1, k) + my.hypot(x, v) + my.copysign(2, x)
    total += my.fma(x, v, 1) + my.atan2(v, x) + my.minimum(x, v, 0) + my.maximum(1.5, B) + my.pow(2, B)
    total += my.fmod(x, 0.3) + v % k + v // k + (n - 5) // 2 + n % 3
    total += x**-2 + x**7 + 2**my.minimum(x, 3) + x % 2 + x // 2 + sum(my.sincos(x)) + sum(my.sincospi(v))
    chosen = my.where((x > 0) & ~(v < 1) | my.is_finite(x) & (mode == n) | (n > 2), total, 1)
    chosen += my.where(n == 1, 2, 3) + my.where(B > 0, 0.25, 0.5) + my.where(B > C, B, 0) + 2 * n
    rest = (x - (v - x)) / (x / v * (v / 3)) - -x * -0.1 + 1e-30 * my.time - 12345678.9
    return my.model(
        {x: B * C - C / (B - 1) + my.cos(C), v: chosen - rest}, shared=(B, C), name="sink",
        accessories={peak: my.phase_maximum(x * v), at_peak: my.time_of_maximum(x * v), mode: 0},
        events=[my.event(x - my.time, name="first", do={
                    x: v, v: x, count: count * 2 + my.phase - 7 // count % mode, a: my.phase * 0.5 + count,
                    my.end_phase: (count > 2) & (x > v), my.end_instance: a > 1e9}),
                my.event(B - my.time, name="second"),
                my.event(C - x, name="third", do={v: my.where(mode == 2, v + 1, v), b: my.where(x > 0, b, 3)})],
        initialise={a: my.phase, count: my.instance, my.next_step: 0.1},
        after_step={count: my.where(x > 0, count + 1, count), a: -a, my.end_phase: B > C},
        finalise={k: k + 0.1, my.t_begin: my.t_end, count: abs(my.event_count("first") + 1 - (my.instance - 3) % 7),
                  b: my.event_count("second") / 2, mode: my.maximum(mode, 3)})


@pytest.mark.skipif(compiler is None, reason="there is no g++")
def test_every_operation_compiles_for_all_kinds_of_numbers_and_has_the_value_of_numpy(tmp_path):
    model = every_operation()
    scalar = my.model({my.state("x"): 1}, name="by_instance", after_step={
        my.integer_accessory("n"): my.integer_accessory("n") * 2, my.end_instance: my.time > 1})
    points = [(1.2, 0.7, 0.3), (-0.4, 1.9, 1.1), (2.5, -0.6, 0.9)]
    source = ["#include \"same_bits.hpp\"", *(m.cpp().replace("#pragma once", "") for m in (model, scalar)), """
        template <class R>
        constexpr bool fits = myriad::detail::hooks_fit<sink, R> && myriad::detail::hooks_fit<by_instance, R>;
        static_assert(fits<double> && fits<float> && fits<myriad::pack<double, 1>> && fits<myriad::pack<float, 1>>);
        int main() {
            const double shared[] = {0.3, 0.8};
            const std::int32_t n = 1;
            myriad::inputs<sink, double> p;
            p.shared = shared, p.shared_integer = &n, p.integer_accessory[sink::mode] = 1;
            p.accessory[sink::between_jumps] = 0.25;
            const double points[][3] = {""", ",".join(f"{{{x}, {v}, {k}}}" for x, v, k in points), """};
            for (const auto& [x, v, k] : points) {
                p.parameter[sink::k] = k;
                const auto slope = sink::rhs<double>(0.25, {x, v}, p);
                std::printf("%.17g %.17g\\n", slope[0], slope[1]);
            }
        }"""]
    said = compile_cpp(tmp_path, "\n".join(source), "-O1", "-march=native", "-Wall", "-Wextra", "-Werror", "-Wno-psabi",
                       "-o", "sink")
    assert not said, said
    printed = subprocess.run([tmp_path / "sink"], capture_output=True, text=True, check=True).stdout.splitlines()
    for (x, v, k), line in zip(points, printed, strict=True):
        expected = model.derivatives(0.25, [x, v], k=k, B=0.3, C=0.8, n=1, mode=1)
        assert [float(s) for s in line.split()] == pytest.approx(list(expected), rel=1e-13, nan_ok=True)


@pytest.mark.parametrize("free", [False, True])
def test_a_component_may_have_the_name_of_a_member_that_the_library_reads_in_other_models(free):
    sources = (path.read_text() for path in (pathlib.Path(my.__file__).parent / "include").rglob("*.hpp"))
    names = sorted({name for source in sources for name in re.findall(r"Model::(?:template )?([a-z]\w+)", source)})
    assert {"lag", "history", "condition", "diffusion"} <= {*names}
    values = [my.parameter(name) for name in names if symbols.is_allowed(name)]
    x, v = my.states("x v")
    model = my.model({x: v, v: -x * sum(values)}, events=[my.event(x, do={v: -0.9 * v})])
    run = my.solve(model, {value: 1 / len(values) for value in values}, start={x: 1.0, v: 0.0}, time=(0, 1.5),
                   free=values[:1] if free else None, interpreted=False, device="cpu", rtol=1e-9)
    assert run[x] == pytest.approx(np.cos(1.5), rel=1e-7)


def test_names_of_macros_and_of_the_struct():
    model = my.model({"traced_model": "R_OK - EIO * traced_model"}, parameters="R_OK EIO")
    run = my.solve(model, {"R_OK": [1.0, 2.0], "EIO": 1.0}, start={"traced_model": 0}, time=(0, 1), rtol=1e-9)
    assert np.allclose(run["traced_model"], [1 - np.exp(-1), 2 - 2 * np.exp(-1)])
