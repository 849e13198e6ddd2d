# SPDX-License-Identifier: MIT
"""The C++ that models are written as: it compiles, without warnings, and computes what the examples' models compute."""

import pathlib
import shutil
import subprocess

import pytest

import example_models
import myriad as my

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
    lines += [f"#include \"{header}\"" for header in dict.fromkeys(example_models.headers.values())]
    pairs = []
    for make in example_models.headers:
        model = make()
        (tmp_path / f"{model.name}.hpp").write_text(model.cpp(f"traced_{model.name}"))
        lines.append(f"#include \"{model.name}.hpp\"")
        pairs.append(f"same_bits::compare<{model.name}, traced_{model.name}>(\"{model.name}\")")
    wrong = example_models.duffing().cpp("wrong").replace("p[k] * y[v] +", "p[k] * y[v] -")
    lines += [wrong.replace("#pragma once", ""), "int main() {",
              "if (same_bits::compare<duffing, wrong>(\"wrong\") != 3) return 1;"]
    lines.append("return " + " + ".join(pairs) + "; }")
    said = compile_cpp(tmp_path, "\n".join(lines), "-O1", "-march=native", *warnings, "-o", "compare")
    assert not said, said
    done = subprocess.run([tmp_path / "compare"], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout
    assert done.stdout.count("compared") == len(pairs) + 1
