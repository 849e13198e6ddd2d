# SPDX-License-Identifier: MIT
"""Type hints: the package has them for type checkers, for all that is public, the compiled module too."""

import pathlib
import re
import shutil
import subprocess
import sys

import pytest

import myriad_ode as my
from myriad_ode import _core
from myriad_ode.models.methods import default

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDER = pathlib.Path(my.__file__).parent


def test_the_package_says_that_it_has_types():
    assert (FOLDER / "py.typed").is_file()


def test_the_stub_of_the_compiled_module_has_all_of_it():
    stub = (FOLDER / "_core.pyi").read_text()
    for name in (n for n in dir(_core) if not n.startswith("__")):
        assert re.search(rf"^(class |def )?{name}\b", stub, re.M), name
    for name in (n for n in dir(_core.Study) if not n.startswith("__")):
        assert re.search(rf"^    def {name}\(", stub, re.M), name
    assert "-> object:" not in stub  # nothing that a type checker could not use


def test_methods_are_those_of_the_library():
    assert list(my.methods) == list(_core.methods)


def test_one_method_is_the_default_of_python_and_of_study_files_and_pages_name_it():
    text = (ROOT / "src/program/study_file.hpp").read_text("utf-8")
    assert re.findall(r'std::string method = "(\w+)";', text) == [default]
    for page, said in (
            ("docs/methods.md", f"take `{default}` where no method is named; in C++ the method is\nalways named"),
            ("docs/program.md", f"the method (`{default}`, "), ("python/README.md", f"The method is `{default}`")):
        assert said in (ROOT / page).read_text("utf-8"), page


def checked(source):
    return subprocess.run([sys.executable, ROOT / "scripts/python_reference.py", "--check", "--source", source],
                          capture_output=True, text=True)


@pytest.mark.parametrize("file, before, after, said", [
    ("solving/solve.py", r'(?s)"""Integrates a model.*?"""', '""""""', "my.solve has no description"),
    ("sweeps/sweep.py", "def values\\(self, name: str\\)", "def values(self, name)", "Sweep.values: name has no type"),
    ("results/run.py", r"def size\(self\) -> int", "def size(self)", "Run.size: what it returns has no type"),
    ("symbolic/symbols.py", r"  #: the time; in an action.*", "", "my.time has no description"),
    ("symbolic/axes.py", r'__all__ = \["linspace",', '__all__ = ["missing", "linspace",',
     "missing is public and defined"),
])
def test_what_has_no_description_or_type_is_found(tmp_path, file, before, after, said):
    assert checked(ROOT).returncode == 0
    shutil.copytree(ROOT / "python/myriad_ode", tmp_path / "python/myriad_ode", symlinks=False)
    changed = tmp_path / "python/myriad_ode" / file
    text, count = re.subn(before, after, changed.read_text(), count=1)
    assert count == 1
    changed.write_text(text)
    done = checked(tmp_path)
    assert done.returncode == 1 and said in done.stdout


@pytest.mark.long
def test_a_type_checker_finds_what_is_wrong_in_a_program(tmp_path):
    mypy = pytest.importorskip("mypy.api")
    program = tmp_path / "program.py"
    program.write_text('''import myriad_ode as my
x, v = my.states("x v")
k = my.parameter("k")
oscillator = my.model({x: v, v: -k * x})
run = my.solve(oscillator, {k: [1.0, 2.0]}, start={x: 1, v: 0}, time=(0, 1), rtol=1e-9, record=[x])
print(run["x"].mean() + 1, run.report.accepted_steps, run.size + 1)
study = my.study(oscillator, {k: my.linspace(0, 1, 5)}, start={x: 1, v: 0}, time=(0, 1), options=my.Options(phases=3))
my.solve(oscillator, {k: 1}, start={x: 1, v: 0}, time=(0, 1), rtoll=1e-9)
my.solve(oscillator, {k: 1}, start={x: 1, v: 0}, time=(0, 1), schedule="slow")
my.study(oscillator, {k: 1}, start={x: 1, v: 0}, time=(0, 1), time_limit=3)
my.Options(phases="three")
my.solve(oscillator, {k: 1}, start={x: 1, v: 0}, time=(0, 1), method="rk45")
run.sizes
''')
    said, problem, _ = mypy.run([str(program), "--cache-dir", str(tmp_path / "cache")])
    assert not problem
    lines = [int(line.split(":")[1]) for line in said.splitlines() if ": error:" in line]
    assert sorted(set(lines)) == [8, 9, 10, 11, 12, 13], said
