# SPDX-License-Identifier: MIT
# What kernels are compiled with, wherever that is done: by CMake in myriad_add_models(), and at run time by the program
# `myriad` and the Python package (src/compile). Functions include it, since where they are called its variables are not
# known.

# -ffast-math is never among them: NaN must stay visible. With contraction left to the compiler, results were found to
# depend on the pack size; the library writes its fused multiply-adds itself.
set(myriad_kernel_flags -O3 -ffp-contract=off -fno-math-errno)
# g++ keeps large objects that are copied as a whole in memory, including dual numbers of packs. In registers, a
# Runge-Kutta 4 step of Lorenz' equations with three tangents takes 7.5 ns instead of 20 (Zen 4, AVX-512).
#
# Nearly all functions are copied into the kernel before they are optimised, and g++ then takes up to two fifths of its
# time for what later passes find as well (points-to analysis, early value numbering). Without these, kernels of nine
# models took 0.92 to 1.03 of the time, with equal bits (Lorenz by Runge-Kutta 4 once 1.10, in calls of 7 ms): a small
# one compiles in 2.0 s of processor time and not 3.2, one of dormand_prince_8 in 16 and not 26, one with seven states
# and two events in 5.8 and not 6.9 (g++ 12.2, AVX-512).
set(myriad_kernel_flags_GNU --param=sra-max-scalarization-size-Ospeed=2048 -fno-tree-pta -fno-tree-fre)
set(myriad_kernel_flags_Clang -Wno-pass-failed)

# Quotients in single precision within two ulps, and without a slow path: 7 instructions and not 116. Not with
# MYRIAD_EXACT_FLOAT (docs/numerics.md).
set(myriad_kernel_flags_NVIDIA -prec-div=false)

# -march= of the instruction sets, at run time.
set(myriad_architecture_AVX512 x86-64-v4)
set(myriad_architecture_AVX2 x86-64-v3)
set(myriad_architecture_SSE2 x86-64-v2)

set(myriad_oldest_GNU 12)
set(myriad_oldest_Clang 14)
