# SPDX-License-Identifier: MIT
"""Runs the package on simulated GPUs: everything is as on real ones, but for the driver, which computes on the CPU, and
NVRTC, in whose place g++ compiles the same source for it."""

import os
import pathlib
import subprocess
import sys

_here = pathlib.Path(__file__).parent


def _command(*more):
    from myriad_ode.kernels import nvrtc
    return ["g++", "-std=c++20", "-O1", "-DNDEBUG", "-DMYRIAD_OUT_OF_LINE", "-fPIC", "-ffp-contract=off", "-w",
            f"-I{nvrtc._include}", *map(str, more)]


def build_driver(folder):
    """Makes in a folder the driver, and a precompiled header of what every program includes."""
    subprocess.run(["g++", "-std=c++20", "-O1", "-shared", "-fPIC", "-Wl,-soname,libcuda.so.1", "-o",
                    str(folder / "libcuda.so.1"), str(_here / "driver.cpp"), "-ldl"], check=True)
    header = folder / "programs.hpp"
    header.write_text(f'#include "{_here}/device.hpp"\n#include <myriad/python/device_program.cuh>\n')
    subprocess.run(_command("-x", "c++-header", header, "-o", f"{header}.gch"), check=True)


# The kernels that a program has if it includes a header.
_kernels = {
    "device_program.cuh": ("myriad_integrate", "myriad_tell_facts", "myriad_sum", "myriad_find_not_finite",
                           "count_all_costs", "sum_costs", "place_by_cost"),
    "device_generate.cuh": ("myriad_generate",),
    "device_adjoint.cuh": ("myriad_adjoint",),
    "study_program.cuh": ("fill_components", "gather_values", "reduce_values"),
}


class Compiler:
    """In the place of `myriad_ode.kernels.nvrtc.library()`."""

    version = "simulated"

    def compile(self, source, capability, options=()):
        """A program of the simulated driver, and what the compiler says."""
        from myriad_ode.kernels import cache
        kernels = [name for header, names in _kernels.items() if header in source for name in names]
        source = "\n".join([source, "SIMULATED_PROGRAM",
                            *(f"SIMULATED_KERNEL({name})" for name in kernels), ""])
        made = cache.directory() / f"simulated-{os.getpid()}.so"
        made.parent.mkdir(parents=True, exist_ok=True)
        header = pathlib.Path(os.environ["LD_LIBRARY_PATH"]) / "programs.hpp"
        done = subprocess.run(_command("-shared", "-include", header, "-x", "c++", "-", "-o", made), input=source,
                              text=True, capture_output=True)
        if done.returncode != 0:
            raise RuntimeError(done.stderr)
        return made.read_bytes(), done.stderr


def run(folder, script, **variables):
    """The output of a script in a process that has the driver of that folder."""
    text = f"import sys; sys.path.insert(0, {str(_here.parent)!r})\nimport simulated_gpu\nsimulated_gpu.install()\n"
    environment = {**os.environ, "LD_LIBRARY_PATH": str(folder), **{k: str(v) for k, v in variables.items()}}
    done = subprocess.run([sys.executable, "-c", text + script], capture_output=True, text=True, env=environment)
    assert done.returncode == 0, done.stderr
    return done.stdout


def install():
    """Has the package take the simulated compiler."""
    from myriad_ode.kernels import nvrtc
    nvrtc.library = Compiler
    nvrtc.find = lambda: pathlib.Path(__file__)


