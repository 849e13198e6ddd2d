# SPDX-License-Identifier: MIT
"""Headers that are prepared once for the compiler: the same kernels in less time, nothing lost where they are bad."""

import os
import shutil
import subprocess
import sys

import pytest

import myriad_ode as my
from myriad_ode.kernels import cache, compiler

pytestmark = pytest.mark.long

MODEL = """
import sys
import myriad_ode as my
x = my.state("x")
run = my.solve(my.model({x: -x * float(sys.argv[1])}), start={x: 1}, time=(0, 1), device="cpu")
print(run.report.kernel, run["x"][0].hex(), round(run.report.compile_seconds, 3))
"""


@pytest.fixture(scope="module")
def left(tmp_path_factory):
    """A cache whose headers a first program has left, and what that told."""
    if compiler.known_compiler().kind not in ("clang++", "g++"):
        pytest.skip("this compiler prepares no headers")
    folder = tmp_path_factory.mktemp("left")
    return folder, solved(0.5, MYRIAD_CACHE_DIR=str(folder))


@pytest.fixture
def prepared(left, tmp_path, monkeypatch):
    """A copy of that cache."""
    folder, first = left
    shutil.copytree(folder, tmp_path, dirs_exist_ok=True)
    monkeypatch.setenv("MYRIAD_CACHE_DIR", str(tmp_path))
    return tmp_path, first, compiler.known_compiler()


def solved(factor, **environment):
    told = subprocess.run([sys.executable, "-c", MODEL, str(factor)], capture_output=True, text=True, check=True,
                          env={**os.environ, **environment}).stdout
    return told.split()


def headers_in(folder):
    return [p for p in folder.iterdir() if p.name.endswith((".pch", ".gch"))]


def test_the_second_model_compiles_faster_with_the_same_kernel_as_without(prepared, tmp_path_factory):
    folder, first, by = prepared
    assert len(headers_in(folder)) == 1
    second = solved(0.75)
    assert float(second[-1]) < 0.9 * float(first[-1])
    source = compiler.source_of("struct nothing {};", "double", "int", "double").partition("using myriad_method")[0] + \
        'extern "C" double twice(double x) { return 2 * x; }\n'
    made = []
    for prepared_headers in (True, False):
        workplace = tmp_path_factory.mktemp("made")
        assert by.compile(source, str(workplace), 300) == prepared_headers
        made.append((workplace / "model.so").read_bytes())
        cache.clear()
    assert made[0] == made[1]


def test_damaged_headers_cost_time_and_nothing_else(prepared):
    folder, _, _ = prepared
    path, = headers_in(folder)
    path.write_bytes(path.read_bytes()[:1000])
    assert solved(0.25)[0] == "compiled"


def test_headers_that_others_may_write_are_not_used(prepared):
    folder, _, by = prepared
    path, = headers_in(folder)
    os.chmod(path, 0o666)
    assert not by.compile("int one;", str(folder), 300)
    os.chmod(path, 0o600)
    assert by.compile("int one;", str(folder), 300)


def test_the_cache_is_emptied_of_them(prepared):
    folder, _, _ = prepared
    assert cache.clear() == 1 and not headers_in(folder)


def test_the_very_first_model_has_no_prepared_headers(tmp_path, monkeypatch):
    by = compiler.known_compiler()
    if by.kind not in ("clang++", "g++"):
        pytest.skip("this compiler prepares no headers")
    monkeypatch.setenv("MYRIAD_CACHE_DIR", str(tmp_path / "made"))
    assert cache.prepare() and cache.prepare()
    made, = headers_in(tmp_path / "made")
    before = made.stat().st_ino
    solved(0.5)
    assert [p.stat().st_ino for p in headers_in(tmp_path / "made")] == [before]  # used, and not made again
    monkeypatch.setenv("MYRIAD_CACHE_DIR", str(made))
    with pytest.raises(my.Error, match="cannot be used .Not a directory"):
        cache.prepare()
