# SPDX-License-Identifier: MIT
# Conan's recipe: `conan create packaging/conan` from a checkout builds and tests the package.
import os

from conan import ConanFile
from conan.tools.build import check_min_cppstd
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy, load

required_conan_version = ">=2.0"


class MyriadRecipe(ConanFile):
    name = "myriad"
    license = "MIT"
    description = "Very large ensembles of small ODE systems on GPUs and SIMD lanes"
    topics = ("ode", "simd", "cuda", "parameter-studies")
    package_type = "static-library"
    settings = "os", "arch", "compiler", "build_type"
    options = {"cuda": [True, False]}
    default_options = {"cuda": False}

    def _root(self):
        return os.path.join(self.recipe_folder, os.pardir, os.pardir)

    def set_version(self):
        header = load(self, os.path.join(self._root(), "include", "myriad", "version.hpp"))
        self.version = header.split('MYRIAD_VERSION "')[1].split('"')[0]

    def export_sources(self):
        for pattern in ("CMakeLists.txt", "LICENSE", "cmake/*", "include/*", "src/*", "backends/*"):
            copy(self, pattern, self._root(), self.export_sources_folder)

    def requirements(self):
        # Programs that use the library are compiled with them.
        self.requires("eigen/[>=3.4 <6]", transitive_headers=True)
        self.requires("xsimd/[>=8.1 <14]", transitive_headers=True)

    def validate(self):
        check_min_cppstd(self, 20)

    def layout(self):
        cmake_layout(self)

    def generate(self):
        CMakeDeps(self).generate()
        toolchain = CMakeToolchain(self)
        for part in ("TESTS", "EXAMPLES", "BENCHMARKS", "VALIDATION"):
            toolchain.cache_variables[f"MYRIAD_BUILD_{part}"] = False
        for part in ("STUDY", "MPI"):  # whatever this machine has, as the package does not ask for what they need
            toolchain.cache_variables[f"MYRIAD_BUILD_{part}"] = "OFF"
        toolchain.cache_variables["MYRIAD_ENABLE_CUDA"] = bool(self.options.cuda)
        xsimd = self.dependencies["xsimd"].cpp_info.includedirs[0]
        toolchain.cache_variables["MYRIAD_XSIMD_INCLUDE_DIR"] = xsimd.replace("\\", "/")
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()

    def package_info(self):
        # The package's own CMake files: they bring myriad_add_models with the flags of model files.
        self.cpp_info.set_property("cmake_find_mode", "none")
        self.cpp_info.builddirs = [os.path.join("lib", "cmake", "myriad")]
        self.cpp_info.libs = ["myriad"]
