#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Configures a user's project in all supported ways, and checks the options with which its model files are compiled, or
why they are not.

    check.py --source SOURCE --build BUILD --work WORK --compiler COMPILER [--nvcc NVCC] [-D...]

Models must be optimised in every configuration; otherwise kernels take 50 to 250 times as long, without a message.
BUILD is a build of Myriad that can be installed. Exit status: 0 all is well, 1 something is wrong.
"""
import argparse
import json
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path


class Project:
    def __init__(self, arguments, further):
        self.source, self.work, self.compiler = arguments.source, arguments.work, arguments.compiler
        self.further, self.failures, self.count = further, 0, 0

    def configure(self, *definitions, by="add_subdirectory", generator="Ninja"):
        """The folder, and CMake's message if it refused."""
        self.count += 1
        folder = self.work / str(self.count)
        command = ["cmake", "-S", str(Path(__file__).resolve().parent), "-B", str(folder), "-G", generator,
                   f"-DCMAKE_CXX_COMPILER={self.compiler}", f"-DMYRIAD_BY={by}", f"-DMYRIAD_SOURCE_DIR={self.source}",
                   f"-DCMAKE_PREFIX_PATH={self.work / 'prefix'}", *self.further, *definitions]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        said = " ".join((done.stdout + done.stderr).split())
        return folder, (said if done.returncode else "")

    def judge(self, title, right, what):
        print(f"{'ok     ' if right else 'FAILED '}{title}: {what}")
        self.failures += not right

    def compiles(self, title, expected, *definitions, file=r"decay\.cpp", **how):
        """The last level of optimisation of each compilation of the model, in the order of compile_commands.json."""
        folder, refusal = self.configure(*definitions, **how)
        if refusal:
            self.judge(title, False, refusal)
            return
        entries = json.loads((folder / "compile_commands.json").read_text(encoding="utf-8"))
        levels = []
        for entry in entries:
            if not re.search(rf"/{file}$", entry["file"]):
                continue
            found = re.findall(r"^(?:-Xcompiler=)?(-O\S*)$", "\n".join(shlex.split(entry["command"])), re.MULTILINE)
            levels.append(found[-1] if found else "no -O")
        self.judge(title, sorted(levels) == sorted(expected), f"{' '.join(levels)} (expected {' '.join(expected)})")

    def release_without_packages(self):
        """The release preset's options on a machine that has Eigen and nothing else."""
        folder = self.work / "release"
        done = subprocess.run(["cmake", "-S", str(self.source), "-B", str(folder), "-G", "Ninja",
                               f"-DCMAKE_CXX_COMPILER={self.compiler}", "-DMYRIAD_SKIP_MISSING=ON",
                               "-DMYRIAD_SIMD=AUTO",
                               "-DCMAKE_SYSTEM_IGNORE_PATH=/usr/include;/usr/local/include",
                               *(f"-DCMAKE_DISABLE_FIND_PACKAGE_{name}=ON"
                                 for name in ("Catch2", "CLI11", "Boost", "nlohmann_json"))],
                              capture_output=True, text=True, check=False)
        said = " ".join((done.stdout + done.stderr).split())
        left_out = ("without SIMD lanes", "Left out: the tests", "Left out: the examples that read arguments",
                    "Left out: the benchmarks", "Left out: myriad::study", "The validation is off")
        missing = [what for what in left_out if what not in said]
        examples = folder / "examples"
        programs = sorted(path.parent.name for path in examples.glob("*/cmake_install.cmake"))
        right = programs == ["hooks", "moving", "own_method", "quickstart"] and not missing
        self.judge("release with nothing but Eigen", right,
                   f"examples {', '.join(programs)}; not said: {missing}" if done.returncode == 0 else said[-600:])

    def refuses(self, title, pattern, *definitions, **how):
        _, refusal = self.configure(*definitions, **how)
        self.judge(title, re.search(pattern, refusal) is not None, refusal[-400:] or "configured")


def main():
    parser = argparse.ArgumentParser()
    for name in ("source", "build", "work"):
        parser.add_argument(f"--{name}", type=Path, required=True)
    parser.add_argument("--compiler", required=True)
    parser.add_argument("--nvcc", default="")
    arguments, further = parser.parse_known_args()
    shutil.rmtree(arguments.work, ignore_errors=True)
    subprocess.run(["cmake", "--install", str(arguments.build), "--prefix", str(arguments.work / "prefix")],
                   check=True, stdout=subprocess.DEVNULL)

    p = Project(arguments, further)
    for by in ("add_subdirectory", "FetchContent", "find_package"):
        p.compiles(f"no build type, {by}", ["-O3"], by=by)
    p.compiles("two instruction sets, no build type", ["-O3", "-O3"], "-DMYRIAD_ARCH=x86-64-v2;x86-64-v3",
               file=r"decay_\w+\.cpp")
    for build_type, level in {"Release": "-O3", "RelWithDebInfo": "-O3", "MinSizeRel": "-O3", "Debug": "-O1"}.items():
        p.compiles(build_type, [level], f"-DCMAKE_BUILD_TYPE={build_type}")
    p.compiles("a build type of the user's", ["-O3"], "-DCMAKE_BUILD_TYPE=Profile", "-DCMAKE_CXX_FLAGS_PROFILE=-O0 -pg")
    p.compiles("several configurations", ["-O1", "-O3", "-O3", "-O3"],
               "-DCMAKE_CONFIGURATION_TYPES=Debug;Release;MinSizeRel;Profile", generator="Ninja Multi-Config")
    p.compiles("asked not to be optimised", ["-O0"], "-DMYRIAD_MODEL_FLAGS=-g -O0")
    p.release_without_packages()
    p.refuses("main.cpp named as a model", r"main\.cpp has the function main and no MYRIAD_INSTANTIATE",
              "-DMAIN_IS_A_MODEL=ON")
    if arguments.nvcc:
        without = ("-DMYRIAD_ENABLE_CUDA=ON", f"-DCMAKE_CUDA_COMPILER={arguments.nvcc}",
                   "-DCMAKE_CUDA_ARCHITECTURES=90")
        cuda = (*without, "-DFURTHER_LANGUAGES=CUDA")
        p.compiles("CUDA in a project without that language", ["-O3"], *without, file=r"decay_\w+\.cu")
        p.refuses("CUDA turned on by Myriad for another directory",
                  r"write project\(configurations LANGUAGES CXX CUDA\)",
                  *without, "-DIN_ANOTHER_DIRECTORY=ON")
        p.compiles("nvcc's host part, no build type", ["-O3"], *cuda, file=r"decay_\w+\.cu")
        p.refuses("nvcc's fast arithmetic", "nvcc is given -?-?use_fast_math", *cuda,
                  "-DCMAKE_CUDA_FLAGS=--use_fast_math")
    return 1 if p.failures else 0


if __name__ == "__main__":
    sys.exit(main())
