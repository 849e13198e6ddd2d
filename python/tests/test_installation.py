# SPDX-License-Identifier: MIT
"""What somebody reads whose machine lacks what the package is built with, and how the package is got."""

import os
import pathlib
import re
import shutil
import subprocess

import pytest

import myriad_ode as my
from myriad_ode.kernels import nvrtc

root = pathlib.Path(__file__).parents[2]
in_a_checkout = pytest.mark.skipif(not (root / "CMakeLists.txt").exists(), reason="the sources are not here")


def configured(tmp_path, *options, **environment):
    """What CMake says of the package where the only programs are its own, and those of `options`."""
    programs = tmp_path / "bin"
    programs.mkdir()
    for name in ("cmake", "ninja", "uname"):
        if shutil.which(name) is None:
            pytest.skip(f"there is no {name}")
        (programs / name).symlink_to(shutil.which(name))
    kept = {name: value for name, value in os.environ.items() if name not in ("CXX", "CMAKE_PREFIX_PATH")}
    command = [programs / "cmake", "-S", root / "python", "-B", tmp_path / "build", "-G", "Ninja", *options]
    done = subprocess.run(command, env={**kept, "PATH": str(programs), **environment}, capture_output=True, text=True,
                          check=False)
    assert done.returncode != 0
    return re.sub(r"\s+", " ", done.stderr)


def names_what_to_install(told):
    return ("Debian, Ubuntu: apt install g++ libxsimd-dev nlohmann-json3-dev" in told
            and "conda: conda install -c conda-forge cxx-compiler xsimd nlohmann_json" in told)


@in_a_checkout
@pytest.mark.parametrize("chosen, why", [({}, "There is no C++ compiler, by which"), ({"CXX": "no-such-compiler"}, (
    "There is no C++ compiler (CXX is no-such-compiler, and there is no such program)"))])
def test_without_a_compiler_the_build_says_what_to_install(tmp_path, chosen, why):
    told = configured(tmp_path, **chosen)
    assert why in told and names_what_to_install(told), told


@in_a_checkout
@pytest.mark.parametrize("found, missing", [({}, "xsimd/xsimd.hpp was not found"), (
    {"MYRIAD_XSIMD_INCLUDE_DIR": os.path.join(os.path.dirname(my.__file__), "include")}, "nlohmann/json.hpp, which")])
def test_without_headers_the_build_says_what_to_install(tmp_path, found, missing):
    compiler = shutil.which("c++")
    if compiler is None:
        pytest.skip("there is no c++")
    nowhere = ["-DCMAKE_FIND_ROOT_PATH=/nowhere", "-DCMAKE_FIND_ROOT_PATH_MODE_INCLUDE=ONLY"]
    told = configured(tmp_path, *nowhere, *(f"-D{name}={value}" for name, value in found.items()), CXX=compiler,
                      PATH=os.environ["PATH"])
    assert missing in told and names_what_to_install(told), told


@in_a_checkout
def test_no_place_tells_to_install_the_package_of_that_name_by_others():
    """PyPI's `myriad` is somebody else's, and nothing of this project is there."""
    told = re.compile(r"pip3? install (?:-\S+ )*['\"]?myriad(?:[-_]ode)?(?![\w/.-])")
    listed = subprocess.run(["git", "ls-files"], cwd=root, capture_output=True, text=True, check=False)
    if listed.returncode != 0:
        pytest.skip("this is no clone")
    found = []
    for name in listed.stdout.splitlines():
        if not name.endswith((".png", ".svg", ".gz")) and name != os.path.relpath(__file__, root):
            for line in (root / name).read_text(encoding="utf-8", errors="replace").splitlines():
                if told.search(line) and not (name == "CHANGELOG.md" and line.startswith("  | `pip")):  # as it was
                    found.append(f"{name}: {line.strip()}")
    assert not found, "\n".join(found)
    assert told.search("pip install 'myriad[cuda]'") and told.search("pip install myriad-ode")
    assert not told.search("pip install ./myriad_ode-*.whl")


def test_messages_say_once_what_to_install(monkeypatch):
    monkeypatch.setattr(nvrtc, "find", lambda: None)
    monkeypatch.delenv("MYRIAD_NVRTC", raising=False)
    with pytest.raises(my.Error) as told:
        nvrtc.library()
    assert str(told.value).count("pip install nvidia-cuda-nvrtc") == 1


@in_a_checkout
def test_the_readme_begins_with_a_line_for_each_way_in():
    begin = (root / "README.md").read_text(encoding="utf-8").partition("\n## ")[0]
    ways = re.findall(r"^\* \*\*(.*?)\*\*: .*(?:second|minute)s?\b", begin, re.M)
    assert ways == ["Python, a release's wheel", "Python, a clone", "C++, a clone", "C++, a Debian package"]
    assert re.search(r"Linux", begin) and re.search(r"GPU is not needed", begin)
