# SPDX-License-Identifier: MIT
# Spack's recipe: copy this file to packages/myriad/package.py of a repository of your own, then, in a checkout of
# Myriad, `spack dev-build myriad@0.1.0`. To fetch Myriad too, set `git` below to where it is cloned from.
from spack.package import *


class Myriad(CMakePackage, CudaPackage):
    """Very large ensembles of small ODE systems on GPUs and SIMD lanes."""

    license("MIT")

    version("0.1.0", tag="v0.1.0")

    variant("cuda", default=False, description="Compile models for NVIDIA GPUs too")

    depends_on("cxx", type="build")
    depends_on("cmake@3.25:", type="build")
    # Programs that use the library are compiled with these.
    depends_on("eigen@3.4:", type=("build", "run"))
    depends_on("xsimd@8.1:", type=("build", "run"))
    depends_on("cuda@12:", when="+cuda", type=("build", "run"))

    conflicts("%gcc@:11", msg="Myriad is written in C++20: g++ 12 or newer")
    conflicts("%clang@:13", msg="Myriad is written in C++20: clang++ 14 or newer")

    def cmake_args(self):
        args = [self.define(f"MYRIAD_BUILD_{part}", False) for part in
                ("TESTS", "EXAMPLES", "BENCHMARKS", "VALIDATION")]
        # Whatever this machine has, as the package does not depend on what they need.
        args += [self.define(f"MYRIAD_BUILD_{part}", "OFF") for part in ("STUDY", "MPI")]
        args.append(self.define_from_variant("MYRIAD_ENABLE_CUDA", "cuda"))
        if self.spec.satisfies("+cuda") and "none" not in self.spec.variants["cuda_arch"].value:
            args.append(self.define("MYRIAD_CUDA_ARCHITECTURES", self.spec.variants["cuda_arch"].value))
        return args
