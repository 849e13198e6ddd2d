# SPDX-License-Identifier: MIT
"""The cache of compiled models: hits, many processes, read-only folders, its limit; and the choice of the compiler."""

import multiprocessing
import os
import pathlib
import subprocess
import sys
import time

import pytest

import myriad as my
from myriad import cache, compiler

from conftest import OSCILLATOR

SCRIPT = f"""
import time; begin = time.perf_counter()
import myriad as my
imported = time.perf_counter()
model = my.CppModel({OSCILLATOR!r}, "oscillator", "x v", "w")
run = my.solve(model, {{"w": [1.0, 2.0]}}, start={{"x": 1, "v": 0}}, time=(0, 1), rtol=1e-7)
print(run.report.kernel, time.perf_counter() - imported, run["x"].tobytes().hex())
"""


def run_script(**environment):
    told = subprocess.run([sys.executable, "-c", SCRIPT], env={**os.environ, **environment}, capture_output=True,
                          text=True, check=False)
    if told.returncode != 0:
        return told.stderr.splitlines()[-1]
    *kernel, seconds, bits = told.stdout.split()
    return " ".join(kernel), float(seconds), bits


def test_a_second_process_finds_the_kernel(tmp_path):
    first, _, bits = run_script(MYRIAD_CACHE_DIR=str(tmp_path))
    again, seconds, same = run_script(MYRIAD_CACHE_DIR=str(tmp_path))
    assert first.startswith("compiled by") and again == "cache" and bits == same
    assert seconds < 0.5  # 0.02 s alone on a core
    tmp_path.chmod(0o500)  # as on a shared, read-only home
    assert run_script(MYRIAD_CACHE_DIR=str(tmp_path))[0] == "cache"
    tmp_path.chmod(0o700)


def read(path):
    """Stands for loading a library: the content of its file without the digest."""
    return path.read_bytes()[:-32].decode()


def _obtain(folder, start, made, results):
    os.environ["MYRIAD_CACHE_DIR"] = folder

    def make(workplace):
        with made.get_lock():
            made.value += 1
        file = workplace / "it"
        file.write_text("begin")
        time.sleep(0.2)  # others would see a file that is written in place
        file.write_text("begin, end")
        return file

    start.wait()
    found = cache.obtain("0123", make, read)
    results.put((found.loaded, found.hit))


def test_64_processes_at_once_make_it_once(tmp_path):
    fork = multiprocessing.get_context("fork")
    start, made, results = fork.Event(), fork.Value("i", 0), fork.SimpleQueue()
    all_of_them = [fork.Process(target=_obtain, args=(str(tmp_path), start, made, results)) for _ in range(64)]
    for process in all_of_them:
        process.start()
    start.set()
    found = [results.get() for _ in all_of_them]
    for process in all_of_them:
        process.join()
    assert made.value == 1
    assert sorted(found) == [("begin, end", False)] + [("begin, end", True)] * 63


def _writer(text):
    def make(workplace):
        (workplace / "it").write_text(text)
        return workplace / "it"
    return make


def test_the_limit_removes_what_was_not_used_for_longest(tmp_path, monkeypatch):
    monkeypatch.setenv("MYRIAD_CACHE_DIR", str(tmp_path))
    monkeypatch.setenv("MYRIAD_CACHE_SIZE", "2500")
    for age, key in ((300, "a"), (200, "b")):
        cache.obtain(key, _writer("x" * 1000), read)
        os.utime(tmp_path / f"{key}.so", (time.time() - age, time.time() - age))
    assert cache.obtain("a", _writer("never made"), read).hit  # which makes b the older one
    cache.obtain("c", _writer("x" * 1000), read)
    assert sorted(p.name for p in tmp_path.glob("*.so")) == ["a.so", "c.so"]
    assert cache.clear() == 2 and not list(tmp_path.iterdir())
    monkeypatch.setenv("MYRIAD_CACHE_SIZE", "1 GB")
    with pytest.raises(my.Error, match="MYRIAD_CACHE_SIZE is '1 GB': give a number of bytes"):
        cache.obtain("d", _writer("x"), read)


def test_a_failed_compilation_leaves_nothing(tmp_path, monkeypatch):
    monkeypatch.setenv("MYRIAD_CACHE_DIR", str(tmp_path))

    def fail(workplace):
        (workplace / "half").write_text("half")
        raise my.Error("no")

    with pytest.raises(my.Error):
        cache.obtain("e", fail, read)
    assert [p.name for p in tmp_path.iterdir()] == ["e.lock"]


def test_a_folder_that_cannot_be_made(tmp_path, monkeypatch):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("MYRIAD_CACHE_DIR", str(tmp_path / "file" / "cache"))
    found = cache.obtain("f", _writer("made"), read)
    assert found == cache.Obtained("made", False, tmp_path / "file" / "cache")
    assert cache.obtain("f", _writer("again"), read).hit
    told, _, _ = run_script(MYRIAD_CACHE_DIR=str(tmp_path / "file" / "cache"))
    assert told.startswith("compiled by") and f"the cache {tmp_path}/file/cache cannot be used" in told


def test_a_damaged_entry_is_made_again(tmp_path, monkeypatch):
    monkeypatch.setenv("MYRIAD_CACHE_DIR", str(tmp_path))
    cache.obtain("g", _writer("whole"), read)
    file = tmp_path / "g.so"
    for damaged in (b"", file.read_bytes()[:20], b"X" + file.read_bytes()[1:]):
        file.write_bytes(damaged)
        assert cache.obtain("g", _writer("new"), read) == cache.Obtained("new", False)
        assert cache.obtain("g", _writer("never made"), read) == cache.Obtained("new", True)


def test_what_cannot_be_loaded_is_not_kept(tmp_path, monkeypatch):
    monkeypatch.setenv("MYRIAD_CACHE_DIR", str(tmp_path))

    def refuse(path):
        raise my.Error("undefined symbol")

    with pytest.raises(my.Error, match="undefined symbol"):
        cache.obtain("h", _writer("made"), refuse)
    assert not list(tmp_path.glob("*.so"))
    cache.obtain("h", _writer("old"), read)

    def refuse_old(path):
        return refuse(path) if read(path) == "old" else read(path)

    assert cache.obtain("h", _writer("new"), refuse_old) == cache.Obtained("new", False)


def test_a_lock_that_cannot_be_opened(tmp_path, monkeypatch):
    monkeypatch.setenv("MYRIAD_CACHE_DIR", str(tmp_path))
    (tmp_path / "j.lock").symlink_to(tmp_path / "nowhere" / "else")  # which stops root too
    assert cache.obtain("j", _writer("made"), read) == cache.Obtained("made", False, tmp_path)


def test_what_a_key_depends_on():
    parts = {"source": "a", "flags": ["-O3"]}
    assert cache.key_of(parts) == cache.key_of(dict(reversed(parts.items())))
    assert cache.key_of(parts) != cache.key_of({**parts, "flags": ["-O2"]})


def test_the_compiler_that_the_environment_names(monkeypatch):
    monkeypatch.setenv("MYRIAD_CXX", "no-such-compiler")
    with pytest.raises(my.Error, match="MYRIAD_CXX is 'no-such-compiler', and there is no such program"):
        compiler.find_compiler()
    monkeypatch.setenv("MYRIAD_CXX", sys.executable)
    assert compiler.find_compiler().command == (sys.executable,)


def test_compilers_are_told_apart_by_their_files(tmp_path, monkeypatch):
    program = pathlib.Path(tmp_path / "g++")
    program.write_text("#!/bin/sh\necho 12\n")
    program.chmod(0o700)
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv("MYRIAD_CXX", raising=False)
    found = compiler.find_compiler()
    assert found.kind == "g++" and found.command == (str(program),)
    program.write_text("#!/bin/sh\necho 12.2\n")
    assert compiler.find_compiler().identity != found.identity
    program.write_text("#!/bin/sh\necho 11\n")
    assert compiler.find_compiler() is None or compiler.find_compiler().kind == "zig"
