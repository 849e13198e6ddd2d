#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Tests of check_resources.py on a recorded ptxas report, so that they need no nvcc."""
import struct
import unittest

import check_resources as checker

REPORT = """
ptxas info    : 0 bytes gmem
ptxas info    : Compiling entry function '_Z5scaleIfEviT_PS0_' for 'sm_90'
ptxas info    : Function properties for _Z5scaleIfEviT_PS0_
    0 bytes stack frame, 0 bytes spill stores, 0 bytes spill loads
ptxas info    : Used 10 registers, used 0 barriers
ptxas info    : Compile time = 3.125 ms
ptxas info    : Compiling entry function '_Z6lorenzPd' for 'sm_90'
ptxas info    : Function properties for _Z6lorenzPd
    16 bytes stack frame, 8 bytes spill stores, 4 bytes spill loads
ptxas info    : Used 44 registers, used 0 barriers, 16 bytes cumulative stack size
ptxas info    : Function properties for __internal_trig_reduction_slowpathd
    40 bytes stack frame, 0 bytes spill stores, 0 bytes spill loads
ptxas info    : Compiling entry function '_Z14lorenz_by_handPd' for 'sm_90'
ptxas info    : Function properties for _Z14lorenz_by_handPd
    0 bytes stack frame, 0 bytes spill stores, 0 bytes spill loads
ptxas info    : Used 40 registers, used 0 barriers
"""
NAMES = {
    "_Z5scaleIfEviT_PS0_": "void scale<float>(int, float, float*)",
    "_Z6lorenzPd": "lorenz(double*)",
    "_Z14lorenz_by_handPd": "lorenz_by_hand(double*)",
}


def complaints(limits):
    return checker.check(checker.read_report(REPORT, NAMES), checker.read_limits(limits))


class CheckResources(unittest.TestCase):
    def test_report_is_read_kernel_by_kernel(self):
        kernels = checker.read_report(REPORT, NAMES)
        self.assertEqual(list(kernels), ["scale<float>", "lorenz", "lorenz_by_hand"])
        self.assertEqual(kernels["scale<float>"], checker.Resources(0, 0, 10))
        self.assertEqual(kernels["lorenz_by_hand"], checker.Resources(0, 0, 40))

    def test_function_that_was_not_inlined_counts_for_its_kernel(self):
        self.assertEqual(checker.read_report(REPORT, NAMES)["lorenz"], checker.Resources(56, 12, 44))

    def test_kernel_within_its_limits_passes(self):
        self.assertEqual(complaints("// limit: scale stack 0 spill 0 registers 10"), [])
        self.assertEqual(complaints("// limit: lorenz registers_within 1.10 of lorenz_by_hand"), [])

    def test_stack_spill_and_registers_are_each_reported(self):
        self.assertEqual(len(complaints("// limit: lorenz stack 0 spill 0 registers 43")), 3)

    def test_more_registers_than_the_other_kernel_are_reported(self):
        (complaint,) = complaints("// limit: lorenz registers_within 1.05 of lorenz_by_hand")
        self.assertIn("44", complaint)
        self.assertIn("40", complaint)

    def test_instructions_are_those_of_the_section_of_the_kernel(self):
        names = b"\0.text._Z6lorenzPd\0.shstrtab\0"
        header = b"\0" * 0x28 + struct.pack("<Q", 64) + b"\0" * 10 + struct.pack("<3H", 64, 3, 2)
        sections = b"".join(struct.pack("<IIQQQQ", *one).ljust(64, b"\0") for one in (
            (0, 0, 0, 0, 0, 0), (1, 1, 0, 0, 0, 4096), (names.index(b".shstrtab"), 3, 0, 0, 256, len(names))))
        code = checker.read_code(header + sections + names, NAMES)
        self.assertEqual(code, {"lorenz": 4096})
        kernels = {"lorenz": checker.Resources(code=4096)}
        self.assertEqual(checker.check(kernels, checker.read_limits("// limit: lorenz code 4096")), [])
        self.assertEqual(len(checker.check(kernels, checker.read_limits("// limit: lorenz code 4095"))), 1)

    def test_limit_for_a_kernel_that_is_not_there_is_reported(self):
        self.assertIn("no such kernel", complaints("// limit: lorentz stack 0")[0])
        self.assertIn("0 kernels", complaints("// limit: lorenz registers_within 1.1 of nothing")[0])

    def test_instance_of_a_template_is_chosen_by_its_arguments(self):
        self.assertEqual(complaints("// limit: scale<float> registers 10"), [])
        self.assertIn("no such kernel", complaints("// limit: scale<double> registers 10")[0])

    def test_namespaces_of_template_arguments_may_be_left_out(self):
        kernels = ["run<lorenz, myriad::rk4, double>", "run<duffing, myriad::rk4, double>"]
        self.assertEqual(checker.matching(kernels, "run<lorenz, rk4, double>"), kernels[:1])
        self.assertEqual(checker.matching(kernels, "run<lorenz,myriad::rk4,double>"), kernels[:1])

    def test_last_template_arguments_may_be_left_out(self):
        kernels = ["run<lorenz, myriad::rk4, (place)1>", "run<lorenz_2, myriad::rk4, (place)1>"]
        self.assertEqual(checker.matching(kernels, "run<lorenz, rk4>"), kernels[:1])
        self.assertEqual(checker.matching(kernels, "run<lorenz>"), kernels[:1])

    def test_forbidden_type_is_found_in_its_kernel_only(self):
        ptx = """.visible .entry _Z5scaleIfEviT_PS0_(
            .reg .f64 %fd<3>;
            add.f32 %f1, %f2, %f3;
        .visible .entry _Z6lorenzPd(
            fma.rn.f64 %fd1, %fd2, %fd3, %fd4;"""
        self.assertEqual(checker.check_ptx(ptx, [("f64", "scale")], NAMES), [])
        (complaint,) = checker.check_ptx(ptx, [("f64", "lorenz")], NAMES)
        self.assertIn("fma.rn.f64", complaint)
        self.assertIn("no such kernel", checker.check_ptx(ptx, [("f64", "lorentz")], NAMES)[0])

    def test_wrong_limit_line_is_refused(self):
        for line in ("// limit: lorenz stak 0", "// limit: lorenz", "// limit: lorenz registers many",
                     "// limit: lorenz registers_within 1.1 lorenz_by_hand"):
            with self.subTest(line), self.assertRaises(checker.WrongLimit):
                checker.read_limits(line)

    def test_short_name_drops_return_type_namespaces_and_parameters(self):
        for demangled, name in (
                ("lorenz(double*)", "lorenz"),
                ("void myriad::cuda::run<ns::lorenz, myriad::rk4<double> >(myriad::view<double>)",
                 "run<ns::lorenz, myriad::rk4<double> >"),
                ("(anonymous namespace)::run(int)", "run"),
                ("_Z3notd", "_Z3notd")):
            self.assertEqual(checker.short_name(demangled), name)


if __name__ == "__main__":
    unittest.main()
