#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Shows on small trees of headers that check_include_graph.py finds each violation, and nothing else."""
import tempfile
import unittest
from pathlib import Path

from check_include_graph import complaints

SOUND = {
    "myriad/myriad.hpp": ["myriad/host/solve/solve.hpp", "myriad/model.hpp"],
    "myriad/model.hpp": ["myriad/kernel/core/vec.hpp"],
    "myriad/host/solve/solve.hpp": ["vector", "myriad/host/core/error.hpp", "myriad/kernel/core/vec.hpp"],
    "myriad/host/core/error.hpp": ["string"],
    "myriad/kernel/core/vec.hpp": ["cstdint", "myriad/kernel/core/macros.hpp"],
    "myriad/kernel/core/macros.hpp": ["myriad/gpu/runtime.hpp"],
    "myriad/gpu/runtime.hpp": ["cstdint"],
    "myriad/kernel/model/lane.hpp": ["myriad/kernel/core/vec.hpp"],
    "myriad/openmp/run.hpp": ["omp.h", "myriad/host/core/error.hpp", "myriad/kernel/model/lane.hpp"],
    "myriad/cuda/run.cuh": ["myriad/kernel/model/lane.hpp"],
}
GPU_CODE = {"myriad/kernel/core/macros.hpp"}
MACROS = "#if MYRIAD_FOR_GPU\n#define MYRIAD_FUNCTION __device__\n#endif\n"


class CheckIncludeGraph(unittest.TestCase):
    def complaints_of(self, changed, code=None):
        """The complaints about SOUND with other includes in some headers, and further lines of code in some."""
        code = {"myriad/kernel/core/macros.hpp": MACROS, **(code or {})}
        with tempfile.TemporaryDirectory() as folder:
            for name, includes in {**SOUND, **changed}.items():
                path = Path(folder, name)
                path.parent.mkdir(parents=True, exist_ok=True)
                form = '#include "{}"\n' if "/" in name else "#include <{}>\n"
                path.write_text("#pragma once\n" + "".join(form.format(i) for i in includes) + code.get(name, ""),
                                encoding="utf-8")
            return complaints([Path(folder)], GPU_CODE)

    def assert_found(self, changed, *words, code=None):
        found = "\n".join(self.complaints_of(changed, code))
        for word in words:
            self.assertIn(word, found)

    def test_layers_that_point_down_pass(self):
        self.assertEqual(self.complaints_of({}), [])

    def test_no_headers_are_an_error(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertIn("no headers", complaints([Path(folder)])[0])

    def test_a_circle_of_two_folders(self):
        self.assert_found({"myriad/kernel/core/macros.hpp": ["myriad/kernel/model/lane.hpp"]}, "in a circle",
                          "myriad/kernel/core/macros.hpp includes myriad/kernel/model/lane.hpp")

    def test_a_circle_of_three_folders(self):
        self.assert_found({
            "myriad/host/core/error.hpp": ["myriad/host/solve/names.hpp"],
            "myriad/host/solve/names.hpp": ["myriad/host/report/report.hpp"],
            "myriad/host/report/report.hpp": ["myriad/host/core/text.hpp"],
            "myriad/host/core/text.hpp": [],
        }, "in a circle", "myriad/host/report/report.hpp includes myriad/host/core/text.hpp")

    def test_a_circle_inside_a_folder_is_none_of_folders(self):
        self.assertEqual(self.complaints_of({"myriad/kernel/core/macros.hpp": ["myriad/kernel/core/vec.hpp"]}), [])

    def test_kernel_code_that_includes_the_host_side(self):
        self.assert_found({"myriad/kernel/model/lane.hpp": ["myriad/host/core/error.hpp"]}, "layer 'kernel'")

    def test_kernel_code_that_includes_what_users_include(self):
        self.assert_found({"myriad/kernel/model/lane.hpp": ["myriad/model.hpp"]}, "layer 'kernel'")

    def test_kernel_code_that_includes_a_backend(self):
        self.assert_found({"myriad/kernel/core/vec.hpp": ["myriad/openmp/run.hpp"]}, "layer 'kernel'")

    def test_host_code_that_includes_a_backend(self):
        self.assert_found({"myriad/host/core/error.hpp": ["myriad/openmp/run.hpp"]}, "layer 'host'")

    def test_kernel_code_that_includes_eigen(self):
        self.assert_found({"myriad/kernel/core/vec.hpp": ["Eigen/Core"]}, "includes <Eigen/Core>")

    def test_kernel_code_that_includes_a_host_library(self):
        self.assert_found({"myriad/kernel/core/vec.hpp": ["vector"]}, "includes <vector>")

    def test_an_include_of_nothing(self):
        self.assert_found({"myriad/model.hpp": ["myriad/kernel/core/gone.hpp"]}, "does not exist")

    def test_kernel_code_that_asks_for_a_gpus_compiler(self):
        for asks in ("#if MYRIAD_ON_GPU", "#  if !MYRIAD_FOR_GPU", "#ifdef MYRIAD_GPU_HAS_LARGER_OR_NAN",
                     "#if defined(__FMA__) || \\\n    MYRIAD_ON_GPU"):
            self.assert_found({}, "lane.hpp asks whether it is compiled for GPUs",
                              code={"myriad/kernel/model/lane.hpp": asks + "\n#endif\n"})

    def test_host_code_that_asks_for_a_gpus_compiler(self):
        self.assert_found({}, "error.hpp asks whether it is compiled for GPUs",
                          code={"myriad/host/core/error.hpp": "#if MYRIAD_FOR_GPU\n#endif\n"})

    def test_a_backend_may_ask_for_a_gpus_compiler_and_a_comment_may_name_it(self):
        self.assertEqual(self.complaints_of({}, {
            "myriad/cuda/run.cuh": "#if MYRIAD_ON_GPU\n#endif\n",
            "myriad/kernel/model/lane.hpp": "// MYRIAD_ON_GPU is not asked for here\n",
        }), [])

    def test_what_names_cuda_in_the_kernel_body_in_a_backend_and_on_the_host(self):
        for code in ("cudaStream_t stream;", "#if defined(__CUDA_ARCH__)\n#endif", "#include <cuda_runtime.h>",
                     "dim3 blocks;", "__ballot_sync(mask, true);", "__popc(mask);", "__double2hiint(x);",
                     'asm("rcp.approx.ftz.f64 %0, %1;");'):
            for header in ("myriad/kernel/model/lane.hpp", "myriad/cuda/run.cuh", "myriad/host/core/error.hpp"):
                self.assert_found({}, f"{header} has ", "which is CUDA's", code={header: code + "\n"})

    def test_a_source_beside_the_headers_that_names_cuda(self):
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "a.hpp").write_text("", encoding="utf-8")
            source = Path(folder, "src", "device.cpp")
            source.parent.mkdir()
            source.write_text("cudaFree(memory);\n", encoding="utf-8")
            self.assertIn("device.cpp has cudaFree", complaints([Path(folder)], frozenset(), [source.parent])[0])

    def test_the_folder_gpu_comments_and_what_hip_has_too_may_name_cuda(self):
        self.assertEqual(self.complaints_of({}, {
            "myriad/gpu/runtime.hpp": "#if defined(__CUDACC__)\n__popc(mask);\n#endif\n",
            "myriad/kernel/model/lane.hpp": "// not cudaMalloc\nauto name = \"cudaErrorNoDevice\";\n",
            "myriad/cuda/run.cuh": "__global__ void f() { __syncthreads(); }\nasm volatile(\"\");\n",
        }), [])

    def test_a_header_that_may_ask_for_a_gpus_compiler_and_does_not(self):
        self.assert_found({}, "GPU_CODE names myriad/kernel/core/macros.hpp",
                          code={"myriad/kernel/core/macros.hpp": ""})

    def test_kernel_code_with_members_that_share_addresses(self):
        self.assert_found({}, "lane.hpp has a member with [[no_unique_address]]",
                          code={"myriad/kernel/model/lane.hpp": "    [[no_unique_address]] vec<S, 0> accessory;\n"})
        self.assertEqual(self.complaints_of({}, {
            "myriad/kernel/model/lane.hpp": "// no [[no_unique_address]] here\n",
            "myriad/host/core/file.hpp": "    [[no_unique_address]] nothing empty;\n",
        }), [])


if __name__ == "__main__":
    unittest.main()
