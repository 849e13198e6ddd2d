#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The recipes in packaging/, run with packages of these names in place of Conan's and Spack's: what they ask CMake for.
A part left to AUTO would be built with whatever the machine has, and the package would not ask for it."""

import pathlib
import re
import sys
import types
import unittest
from unittest import mock

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
PARTS = set(re.findall(r"^(?:option|set)\((MYRIAD_BUILD_\w+)", (ROOT / "CMakeLists.txt").read_text(), re.MULTILINE))


class Base:
    """What a recipe is derived from."""

    dependencies, spec = mock.MagicMock(), mock.MagicMock()

    def define(self, name, value):
        return name, value

    def define_from_variant(self, name, variant):
        return name, variant


def recipe(file, **modules):
    """The names that a recipe defines, where it finds these modules."""
    with mock.patch.dict(sys.modules, modules):
        names = {}
        exec(compile(file.read_text(), str(file), "exec"), names)
        return names


def conan_asks():
    toolchain = mock.MagicMock(cache_variables={})
    modules = {name: mock.MagicMock() for name in ("conan", "conan.tools", "conan.tools.build", "conan.tools.files")}
    modules["conan"].ConanFile = Base
    modules["conan.tools.cmake"] = mock.MagicMock(CMakeToolchain=lambda _: toolchain)
    names = recipe(ROOT / "packaging/conan/conanfile.py", **modules)
    made = names["MyriadRecipe"]()
    made.options = mock.MagicMock()
    made.generate()
    return toolchain.cache_variables


def spack_asks():
    package = types.ModuleType("spack.package")
    words = re.findall(r"^    (\w+)\(", (ROOT / "packaging/spack/package.py").read_text(), re.MULTILINE)
    for word in words:
        setattr(package, word, lambda *_, **__: None)
    package.CMakePackage, package.CudaPackage = Base, type("CudaPackage", (), {})
    names = recipe(ROOT / "packaging/spack/package.py", **{"spack": mock.MagicMock(), "spack.package": package})
    return dict(names["Myriad"]().cmake_args())


class Recipes(unittest.TestCase):
    def test_each_part_is_off(self):
        self.assertLessEqual({"MYRIAD_BUILD_STUDY", "MYRIAD_BUILD_MPI"}, PARTS)
        for asks in (conan_asks(), spack_asks()):
            for part in PARTS:
                self.assertIn(asks.get(part, "AUTO"), (False, "OFF"), part)


if __name__ == "__main__":
    unittest.main()
