# SPDX-License-Identifier: MIT
"""What compilers take for large models, in the CPU time of small ones, so that no machine's speed matters."""

import math
import resource
import shutil
import subprocess

import numpy as np
import pytest

import example_models
import myriad as my
from myriad import compiler
from myriad.cpp import work
from test_gpu import network

gxx = shutil.which("g++")


def cpu_seconds(model, folder, monkeypatch, limit=None):
    """The CPU time that g++ takes to compile a kernel; beyond the limit it is stopped."""
    header, struct = model.source()
    (folder / "model.cpp").write_text(compiler.source_of(header, struct, "myriad::cash_karp", "double"))
    monkeypatch.setenv("MYRIAD_CXX", gxx)
    command = [gxx, *compiler.compiler().flags, "-shared", "model.cpp", "-o", "model.so"]
    limited = limit and (lambda: resource.setrlimit(resource.RLIMIT_CPU, (math.ceil(limit),) * 2))
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, preexec_fn=limited)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    assert done.returncode == 0, f"g++ failed, or takes more than {limit} s: {done.stderr}"
    return after.ru_utime - before.ru_utime


@pytest.mark.skipif(gxx is None, reason="there is no g++")
def test_a_network_of_twelve_does_not_take_minutes_to_compile(tmp_path, monkeypatch):
    x = my.state("x")
    small = cpu_seconds(my.model({x: -x}), tmp_path, monkeypatch)
    # 6.7 s where one equation takes 3.0 and one oscillator 5; with a copy of the equations in every stage 66 s
    cpu_seconds(network(), tmp_path, monkeypatch, limit=5 * small)


def test_large_right_hand_sides_are_called_and_small_ones_copied():
    assert "large_rhs = true" in network().cpp()
    assert [make.__name__ for make in example_models.headers if "large_rhs" in make().cpp()] == []
    x, y = my.states("x y")
    assert work([x * y + my.sin(x), my.sin(x) - 1]) == 18  # shared subexpressions once
    chain = my.states([f"c{i}" for i in range(100)])
    rows = {c: before - c * c * c for before, c in zip(np.roll(np.array(chain), 1), chain)}
    assert "large_rhs" in my.model(rows).cpp()
