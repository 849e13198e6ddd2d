# SPDX-License-Identifier: MIT
"""The cache of compiled models: hits, many processes, read-only folders, its limit; and the choice of the compiler."""

import multiprocessing
import os
import pathlib
import re
import signal
import subprocess
import sys
import time

import pytest

import myriad_ode as my
from myriad_ode.kernels import cache, compiled_files, compiler

from conftest import OSCILLATOR

pytestmark = pytest.mark.as_users_compile

SCRIPT = f"""
import time
import myriad_ode as my
imported = time.process_time()
model = my.CppModel({OSCILLATOR!r}, "oscillator", "x v", "w")
run = my.solve(model, {{"w": [1.0, 2.0]}}, start={{"x": 1, "v": 0}}, time=(0, 1), rtol=1e-7)
print(run.report.kernel, time.process_time() - imported, run["x"].tobytes().hex())
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


def obtain(made_from, make, load):
    return compiled_files.obtain(made_from.encode(), make, load)


def file_of(made_from):
    """The name of the file of the cache that was made from a text: its hash, FNV-1a."""
    hashed = 0xcbf29ce484222325
    for byte in made_from.encode():
        hashed = (hashed ^ byte) * 0x100000001b3 % 2**64
    return f"{hashed:016x}.so"


def read(path):
    """Stands for loading a library: the content of its file without what the cache puts behind it, which is the text
    that it was made from, the length of that in 8 bytes, and a checksum in 4."""
    content = pathlib.Path(path).read_bytes()[:-4]
    return content[:-8 - int.from_bytes(content[-8:], "little")].decode()


def _obtain(folder, start, made, results):
    os.environ["MYRIAD_CACHE_DIR"] = folder

    def make(workplace):
        with made.get_lock():
            made.value += 1
        file = pathlib.Path(workplace, "model.so")
        file.write_text("begin")
        time.sleep(0.2)  # others would see a file that is written in place
        file.write_text("begin, end")

    start.wait()
    found = obtain("0123", make, read)
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
        pathlib.Path(workplace, "model.so").write_text(text)
    return make


def test_the_limit_removes_what_was_not_used_for_longest(tmp_path, monkeypatch):
    monkeypatch.setenv("MYRIAD_CACHE_DIR", str(tmp_path))
    monkeypatch.setenv("MYRIAD_CACHE_SIZE", "2500")
    for age, key in ((300, "a"), (200, "b")):
        obtain(key, _writer("x" * 1000), read)
        os.utime(tmp_path / file_of(key), (time.time() - age, time.time() - age))
    assert obtain("a", _writer("never made"), read).hit  # which makes b the older one
    obtain("c", _writer("x" * 1000), read)
    assert {p.name for p in tmp_path.glob("*.so")} == {file_of("a"), file_of("c")}
    assert cache.clear() == 2 and not list(tmp_path.iterdir())
    monkeypatch.setenv("MYRIAD_CACHE_SIZE", "1 GB")
    with pytest.raises(my.Error, match="MYRIAD_CACHE_SIZE is '1 GB': give a number of bytes"):
        obtain("d", _writer("x"), read)


def test_a_failed_compilation_leaves_nothing(tmp_path, monkeypatch):
    monkeypatch.setenv("MYRIAD_CACHE_DIR", str(tmp_path))

    def fail(workplace):
        pathlib.Path(workplace, "half").write_text("half")
        raise my.Error("no")

    with pytest.raises(my.Error):
        obtain("e", fail, read)
    assert not list(tmp_path.iterdir())


def test_a_folder_that_cannot_be_made(tmp_path, monkeypatch):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("MYRIAD_CACHE_DIR", str(tmp_path / "file" / "cache"))
    found = obtain("f", _writer("made"), read)
    assert found == compiled_files.Obtained(
        "made", False, f"compiled models are not kept in {tmp_path}/file/cache, as it cannot be used (Not a "
                       "directory): set MYRIAD_CACHE_DIR to a folder that can")
    assert obtain("f", _writer("again"), read).hit
    told, _, _ = run_script(MYRIAD_CACHE_DIR=str(tmp_path / "file" / "cache"))
    assert told.startswith("compiled by") and f"not kept in {tmp_path}/file/cache" in told


def test_a_damaged_entry_is_made_again(tmp_path, monkeypatch):
    monkeypatch.setenv("MYRIAD_CACHE_DIR", str(tmp_path))
    obtain("g", _writer("whole"), read)
    file = tmp_path / file_of("g")
    for damaged in (b"", file.read_bytes()[:10], b"X" + file.read_bytes()[1:]):
        file.write_bytes(damaged)
        assert obtain("g", _writer("new"), read) == compiled_files.Obtained("new", False)
        assert obtain("g", _writer("never made"), read) == compiled_files.Obtained("new", True)


def test_what_cannot_be_loaded_is_not_kept(tmp_path, monkeypatch):
    monkeypatch.setenv("MYRIAD_CACHE_DIR", str(tmp_path))

    def refuse(path):
        raise my.Error("undefined symbol")

    with pytest.raises(my.Error, match="undefined symbol"):
        obtain("h", _writer("made"), refuse)
    assert not list(tmp_path.glob("*.so"))
    obtain("h", _writer("old"), read)

    def refuse_old(path):
        return refuse(path) if read(path) == "old" else read(path)

    assert obtain("h", _writer("new"), refuse_old) == compiled_files.Obtained("new", False)


def test_a_lock_that_cannot_be_opened(tmp_path, monkeypatch):
    monkeypatch.setenv("MYRIAD_CACHE_DIR", str(tmp_path))
    (tmp_path / file_of("j")).with_suffix(".lock").symlink_to(tmp_path / "nowhere" / "else")  # which stops root too
    assert obtain("j", _writer("made"), read) == compiled_files.Obtained("made", False)  # others may make the same
    assert obtain("j", _writer("never made"), read).hit


def test_under_umask_0_the_cache_is_the_users_alone(tmp_path, monkeypatch):
    monkeypatch.setenv("MYRIAD_CACHE_DIR", str(tmp_path / "of" / "mine"))
    before = os.umask(0)
    try:
        obtain("k", _writer("made"), read)
    finally:
        os.umask(before)
    modes = {p.name: p.stat().st_mode & 0o777 for p in tmp_path.rglob("*")}
    assert modes == {"of": 0o700, "mine": 0o700, file_of("k"): 0o600}


def _refused(why, key):
    """Nothing of the cache is loaded, and the model is made elsewhere."""
    with pytest.warns(RuntimeWarning, match=why):
        found = obtain(key, _writer("own"), read)
    assert found.loaded == "own" and re.search(why, found.unusable)


def test_a_cache_that_others_may_write_to_is_refused(tmp_path, monkeypatch):
    monkeypatch.setenv("MYRIAD_CACHE_DIR", str(tmp_path))
    obtain("m", _writer("planted"), read)
    for mode in (0o777, 0o720, 0o702):
        tmp_path.chmod(mode)
        _refused(rf"others may write to it \(mode {mode:o}\).*chmod go-w", f"m{mode}")
    tmp_path.chmod(0o700)
    assert obtain("m", _writer("never made"), read).hit


def test_a_file_of_the_cache_that_may_be_somebody_elses_is_made_again(tmp_path, monkeypatch):
    monkeypatch.setenv("MYRIAD_CACHE_DIR", str(tmp_path / "cache"))
    file = tmp_path / "cache" / file_of("n")

    def opened_to_others():
        file.chmod(0o622)

    def linked():
        file.rename(tmp_path / "elsewhere")
        file.symlink_to(tmp_path / "elsewhere")

    def pipe():
        file.unlink()
        os.mkfifo(file)

    for plant in (opened_to_others, linked, pipe):
        obtain("n", _writer("planted"), read)
        plant()
        assert obtain("n", _writer("own"), read) == compiled_files.Obtained("own", False), plant.__name__
        assert file.is_file() and not file.is_symlink() and file.stat().st_mode & 0o777 == 0o600
        file.unlink()


@pytest.mark.skipif(os.geteuid() != 0, reason="only root makes files of others")
def test_what_belongs_to_another_user_is_refused(tmp_path, monkeypatch):
    folder = tmp_path / "cache"
    monkeypatch.setenv("MYRIAD_CACHE_DIR", str(folder))
    obtain("o", _writer("planted"), read)
    os.chown(folder / file_of("o"), 12345, -1)
    assert obtain("o", _writer("own"), read) == compiled_files.Obtained("own", False)
    os.chown(folder, 12345, -1)
    _refused("it belongs to another user, of number 12345", "o1")
    os.chown(folder, 0, -1)
    (tmp_path / "link").symlink_to(folder)
    os.chown(tmp_path / "link", 12345, -1, follow_symlinks=False)
    monkeypatch.setenv("MYRIAD_CACHE_DIR", str(tmp_path / "link"))
    _refused("it belongs to another user, of number 12345", "o2")


def test_a_killed_compilation_leaves_nothing_after_the_next_one(tmp_path, monkeypatch):
    monkeypatch.setenv("MYRIAD_CACHE_DIR", str(tmp_path))
    script = ("import os, signal; from myriad_ode.kernels import compiled_files\n"
              "compiled_files.obtain(b'p', lambda folder: os.kill(os.getpid(), signal.SIGKILL), print)")
    own = file_of("p").removesuffix(".so")
    for key in ("p", "q"):  # the same model, and another one
        subprocess.run([sys.executable, "-c", script], check=False)
        assert sorted(p.name.split(".")[1] for p in tmp_path.glob(f"{own}.*") if p.suffix != ".so") == ["lock", "work"]
        obtain(key, _writer("made"), read)
        assert {p.name for p in tmp_path.iterdir()} <= {file_of("p"), file_of("q")}
        (tmp_path / file_of("p")).unlink(missing_ok=True)


def test_a_place_of_a_living_process_stays(tmp_path, monkeypatch):
    monkeypatch.setenv("MYRIAD_CACHE_DIR", str(tmp_path))

    def make(workplace):
        obtain("inner", _writer("made"), read)
        assert os.path.isdir(workplace) and (tmp_path / file_of("outer")).with_suffix(".lock").exists()
        _writer("made")(workplace)

    assert obtain("outer", make, read) == compiled_files.Obtained("made", False)
    assert {p.name for p in tmp_path.iterdir()} == {file_of("inner"), file_of("outer")}


def test_a_file_that_was_made_from_another_text_is_not_loaded(tmp_path, monkeypatch):
    """Names are short hashes: what counts is the text itself."""
    monkeypatch.setenv("MYRIAD_CACHE_DIR", str(tmp_path))
    obtain("r", _writer("of r"), read)
    (tmp_path / file_of("r")).rename(tmp_path / file_of("s"))
    assert obtain("s", _writer("of s"), read) == compiled_files.Obtained("of s", False)


def test_ctrl_c_ends_a_compilation(tmp_path):
    """The compiler need not get the signal, as in a notebook."""
    slow = tmp_path / "g++"
    slow.write_text("#!/bin/sh\n[ $1 = -dumpversion ] && echo 12 && exit\ntouch " + str(tmp_path / "begun") +
                    "\nexec sleep 60\n")
    slow.chmod(0o700)
    with subprocess.Popen([sys.executable, "-c", SCRIPT], stderr=subprocess.PIPE, text=True, env={
            **os.environ, "MYRIAD_CXX": str(slow), "MYRIAD_CACHE_DIR": str(tmp_path / "cache")}) as process:
        while not (tmp_path / "begun").exists():
            time.sleep(0.02)
        begin = time.monotonic()
        process.send_signal(signal.SIGINT)
        assert process.communicate()[1].endswith("KeyboardInterrupt\n")
        assert time.monotonic() - begin < 20
    assert not list((tmp_path / "cache").iterdir())


def test_what_a_key_depends_on(monkeypatch):
    by = compiler.known_compiler()
    keys = [by.made_from("a"), by.made_from("b")]
    for name, value in (("MYRIAD_INSTRUCTION_SET", "sse2"), ("MYRIAD_CXX", f"{by.command[0]} -fno-plt")):
        monkeypatch.setenv(name, value)
        keys.append(compiler.known_compiler().made_from("a"))
    assert len(set(keys)) == len(keys) == 4 and by.made_from("a") == keys[2]


def test_an_instruction_set_that_the_cpu_lacks(monkeypatch):
    monkeypatch.setenv("MYRIAD_INSTRUCTION_SET", "avx1024")
    with pytest.raises(my.Error, match="MYRIAD_INSTRUCTION_SET is 'avx1024': this CPU has .*sse2.*: name one of them"):
        _ = compiler.compiler().flags


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


# ---------------------------------------------------------------------------------------------------------------------
# What is loaded is what was asked for
# ---------------------------------------------------------------------------------------------------------------------

# Two models, each solved by its kernel, and what happens between them.
TWO_MODELS = """
import os, sys
import myriad_ode as my
x, k = my.state("x"), my.parameter("k")

def grown(sign, name):
    model = my.model({x: sign * k * x}, name=name)
    run = my.solve(model, {k: [1.0]}, start={x: 1.0}, time=(0, 1), device="cpu", interpreted=False)
    return float(run["x"][0])

print(round(grown(-1, "decay"), 4))
BETWEEN
print(round(grown(1, "growth"), 4))
"""


def _run_two_models(tmp_path, between, before="", wrap=(), **environment):
    script = before + TWO_MODELS.replace("BETWEEN", between)
    told = subprocess.run([*wrap, sys.executable, "-c", script], capture_output=True, text=True, check=False,
                          cwd=tmp_path, env={**os.environ, "MYRIAD_CACHE_DIR": str(tmp_path / "cache"), **environment})
    assert told.returncode == 0, told.stderr
    return told.stdout.split()


@pytest.mark.thorough
def test_a_second_model_is_its_own_after_a_program_has_closed_unknown_descriptors(tmp_path):
    assert _run_two_models(tmp_path, "os.closerange(3, 1024)") == ["0.3679", "2.7183"]


def _obtain_names(tmp_path, monkeypatch, count):
    monkeypatch.setenv("MYRIAD_CACHE_DIR", str(tmp_path))
    names = []
    for number in range(count):
        obtain(f"t{number % 3}", _writer("made"), lambda path: names.append(path) or read(path))
    return names


def test_no_name_of_a_loaded_file_is_used_twice_and_no_descriptor_stays_open(tmp_path, monkeypatch):
    before = len(os.listdir("/proc/self/fd"))
    names = _obtain_names(tmp_path, monkeypatch, 50)
    assert len(set(names)) == 50
    assert len(os.listdir("/proc/self/fd")) == before


def test_a_library_without_the_symbol_does_not_poison_the_process(tmp_path, monkeypatch):
    monkeypatch.setenv("MYRIAD_CACHE_DIR", str(tmp_path))
    by = compiler.compiler()
    source = compiler.source_of(OSCILLATOR, "oscillator", "myriad::tsitouras_5", "double")
    made_from = by.made_from(source)

    def make_empty(folder):
        by.compile("int nothing;\n", folder, 300)

    for _ in range(3):
        with pytest.raises(my.Error, match="another compiled model for the one that was asked for"):
            compiled_files.obtain(made_from, make_empty, lambda path: compiler._load(by, path, made_from))
    found = compiled_files.obtain(made_from, lambda folder: by.compile(source, folder, 300),
                         lambda path: compiler._load(by, path, made_from))
    assert found.loaded.instruction_set


# ---------------------------------------------------------------------------------------------------------------------
# Where little is as usual
# ---------------------------------------------------------------------------------------------------------------------

@pytest.mark.thorough
def test_a_program_that_ignores_sigchld_compiles(tmp_path):
    ignore = "import signal; signal.signal(signal.SIGCHLD, signal.SIG_IGN)\n"
    assert _run_two_models(tmp_path, "", before=ignore) == ["0.3679", "2.7183"]


def test_a_model_that_does_not_compile_is_refused_where_sigchld_is_ignored(tmp_path):
    script = ("import signal; signal.signal(signal.SIGCHLD, signal.SIG_IGN)\n"
              "from myriad_ode.kernels import compiler\n"
              "by = compiler.compiler()\n"
              f"by.compile('int nothing = nobody;', {str(tmp_path)!r}, 300)")
    told = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert told.returncode == 1 and "the model does not compile" in told.stderr


def test_a_forked_child_keeps_no_lock(tmp_path, monkeypatch):
    monkeypatch.setenv("MYRIAD_CACHE_DIR", str(tmp_path))
    child = 0

    def make(workplace):
        nonlocal child
        child = os.fork()
        if child == 0:
            time.sleep(60)
            os._exit(0)
        raise my.Error("this process fails, and its child goes on")

    try:
        with pytest.raises(my.Error, match="its child goes on"):
            obtain("u", make, read)
        begin = time.monotonic()
        assert obtain("u", _writer("made"), read).loaded == "made"
        assert time.monotonic() - begin < 30
    finally:
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)


def test_a_forked_child_keeps_no_lock_of_a_process_that_was_killed(tmp_path, monkeypatch):
    monkeypatch.setenv("MYRIAD_CACHE_DIR", str(tmp_path))
    script = ("import os, signal, time; from myriad_ode.kernels import compiled_files\n"
              "def make(folder):\n"
              "    if os.fork() == 0:\n"
              "        print(os.getpid(), flush=True)\n"
              "        os.closerange(1, 3)\n"
              "        time.sleep(60)\n"
              "        os._exit(0)\n"
              "    time.sleep(0.1)\n"
              "    os.kill(os.getpid(), signal.SIGKILL)\n"
              "compiled_files.obtain(b'v', make, print)")
    child = int(subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False).stdout)
    try:
        begin = time.monotonic()
        assert obtain("v", _writer("made"), read).loaded == "made"
        assert time.monotonic() - begin < 30
    finally:
        os.kill(child, signal.SIGKILL)


def _mounted(options, then):
    """A command that has a file system in memory with such options on the folder `small`; None if it may not."""
    mount = f"mkdir -p small && mount -t tmpfs -o {options} none small"
    command = ("unshare", "-rm", "sh", "-c", f"{mount} && {then}", "sh")
    may = subprocess.run(["unshare", "-rm", "sh", "-c", "mount -t tmpfs none /mnt"], capture_output=True, check=False)
    return command if may.returncode == 0 else None


def test_models_are_loaded_from_a_cache_on_a_disk_that_forbids_code(tmp_path):
    wrap = _mounted("noexec", '"$@"')
    if wrap is None:
        pytest.skip("nothing can be mounted here")
    assert _run_two_models(tmp_path, "", wrap=wrap, MYRIAD_CACHE_DIR=str(tmp_path / "small")) == ["0.3679", "2.7183"]


@pytest.mark.thorough
def test_models_are_compiled_elsewhere_where_the_disk_of_the_cache_is_full(tmp_path):
    for size in ("size=128k", "size=128k,nr_inodes=2"):
        wrap = _mounted(size, '"$@"')
        if wrap is None:
            pytest.skip("nothing can be mounted here")
        told = _run_two_models(tmp_path, "", wrap=wrap, MYRIAD_CACHE_DIR=str(tmp_path / "small"))
        assert told == ["0.3679", "2.7183"]


def test_without_a_home_and_a_temporary_folder_nothing_is_written_to_the_current_one(tmp_path):
    script = ("from myriad_ode.kernels import compiled_files; import pathlib\n"
              "make = lambda folder: pathlib.Path(folder, 'model.so').write_text('made')\n"
              "print(compiled_files.obtain(b'w', make, len).unusable)")
    environment = {name: value for name, value in os.environ.items()
                   if name not in ("HOME", "XDG_CACHE_HOME", "MYRIAD_CACHE_DIR")}
    told = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False, cwd=tmp_path,
                          env={**environment, "TMPDIR": str(tmp_path / "nowhere")})
    assert told.returncode == 0 and "there is no folder for compiled models" in told.stdout, told.stderr
    assert not list(tmp_path.iterdir())


def test_messages_of_compilers_may_be_in_any_encoding(tmp_path, monkeypatch):
    program = tmp_path / "g++"
    program.write_text("#!/bin/sh\n[ \"$1\" = -dumpversion ] && echo 12 && exit\n"
                       "printf 'f: error: \\344rger'\nexit 1\n")
    program.chmod(0o700)
    monkeypatch.setenv("MYRIAD_CXX", str(program))
    with pytest.raises(my.Error, match="does not compile .*: \N{REPLACEMENT CHARACTER}rger"):
        compiler.find_compiler().compile("int nothing;", str(tmp_path), 300)


def test_a_size_of_the_cache_that_is_no_number_of_bytes(tmp_path, monkeypatch):
    monkeypatch.setenv("MYRIAD_CACHE_DIR", str(tmp_path))
    monkeypatch.setenv("MYRIAD_CACHE_SIZE", "1GB")
    with pytest.raises(my.Error, match="MYRIAD_CACHE_SIZE is '1GB': give a number of bytes, such as 1073741824"):
        obtain("y", _writer("x"), read)
