// SPDX-License-Identifier: MIT
// The execution-space macros: all that depends on the compiler, but for gpu/runtime.hpp and a few functions with
// different code for GPUs. tests/scripts/check_include_graph.py lists the headers that have such.
#pragma once

#include "myriad/gpu/runtime.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/core/ieee.hpp"

/// A pragma whose text contains a macro's argument.
#define MYRIAD_PRAGMA(text) _Pragma(#text)
#if MYRIAD_FOR_GPU
/// A function of the kernel body: device code of GPUs, inlined host code elsewhere. Required for a model's functions
/// and the helpers they call, so that files compiled for different instruction sets share no copy of them.
#define MYRIAD_FUNCTION __host__ __device__ __forceinline__ constexpr
/// `MYRIAD_FUNCTION` for a lambda, placed between its parameters and its body.
#define MYRIAD_LAMBDA
/// In the place of MYRIAD_FUNCTION, for a template that is called at several places and so large that copies would cost
/// more than calls: out of line on the CPU. In device code, whose calls go through a stack, it is inlined too.
#define MYRIAD_LARGE_FUNCTION MYRIAD_FUNCTION
/// In the place of MYRIAD_FUNCTION, for what rarely happens: out of line, so that the loop stays short enough for a
/// GPU's cache of instructions. Arguments are passed by value, as references would give the loop's own data addresses.
#define MYRIAD_RARE_FUNCTION __host__ __device__ __noinline__
/// In the place of MYRIAD_FUNCTION, for a long function of which there is to be one copy, on CPUs and GPUs: called with
/// arguments MYRIAD_CALL_ARGUMENT(type), which are values in registers for a GPU's thread, and references on a CPU.
#define MYRIAD_CALLED_FUNCTION __host__ __device__ __noinline__
#define MYRIAD_CALL_ARGUMENT(...) const __VA_ARGS__
/// A constant at namespace scope that device code reads from constant memory as an operand of its instructions.
#define MYRIAD_CONSTANT_MEMORY __constant__
/// An optimisation barrier: what lies in memory that others might change is written before it and read again after it.
#define MYRIAD_MEMORY_BARRIER asm volatile("" ::: "memory")
#if MYRIAD_ON_GPU
/// Prefetches memory that is soon read into the nearest cache.
#define MYRIAD_PREFETCH(where) ::myriad::gpu::prefetch(where)
/// A point where diverged threads of a warp reconverge; all threads that have not exited reach it. The compiler's own
/// reconvergence points are not enough: threads that took instances one by one were seen never to reconverge.
#define MYRIAD_RECONVERGE ::myriad::gpu::synchronise_warp(~::myriad::gpu::lane_mask(0))
/// Unrolls the following loop; in device code only up to 64 iterations, so that larger states stay loops.
#define MYRIAD_UNROLL _Pragma("unroll 64")
/// The same with limits of its own for device code and for the CPU, which are literals, as a pragma sees only their
/// text.
#define MYRIAD_UNROLL_UP_TO(on_gpu, on_cpu) MYRIAD_PRAGMA(unroll(on_gpu))
/// In device code, unrolls the following long loop by a constant expression: over steps, in which constants are
/// reloaded in every iteration, or over values in memory, whose loads are then under way together.
#define MYRIAD_UNROLL_BY(count) MYRIAD_PRAGMA(unroll(count))
/// Keeps device code from unrolling the following loop.
#define MYRIAD_ROLLED _Pragma("unroll 1")
/// The same as MYRIAD_UNROLL in device code, which can only then keep what it indexes in registers; on the CPU the
/// following loop stays one, for code that is rarely reached and would take long to compile.
#define MYRIAD_UNROLL_ON_GPU MYRIAD_UNROLL
/// a * b rounded, where the compiler would fuse it with an addition: for results that are to be the host's.
#define MYRIAD_ROUNDED_PRODUCT(a, b) ::myriad::gpu::rounded_product(a, b)
#else
#define MYRIAD_PREFETCH(where) __builtin_prefetch(where)
#define MYRIAD_RECONVERGE static_cast<void>(0)
#define MYRIAD_UNROLL
#define MYRIAD_UNROLL_UP_TO(on_gpu, on_cpu)
#define MYRIAD_UNROLL_BY(count)
#define MYRIAD_ROLLED
#define MYRIAD_UNROLL_ON_GPU
#define MYRIAD_ROUNDED_PRODUCT(a, b) ((a) * (b))
#endif
#define MYRIAD_WHOLE_LOOP static_cast<void>(0)
#else
#if defined(MYRIAD_OUT_OF_LINE)  // tests' kernels, which need not be fast: compiled in less than half of the time
#define MYRIAD_FUNCTION inline constexpr
#define MYRIAD_LAMBDA
#else
#define MYRIAD_FUNCTION inline __attribute__((always_inline)) constexpr
#define MYRIAD_LAMBDA __attribute__((always_inline))
#endif
#if defined(__clang__)
#define MYRIAD_FLATTEN
#define MYRIAD_WHOLE_LOOP static_cast<void>(0)
#else
/// In a loop, keeps g++ from making several of it. g++ 12 at -O3 does so even where one of them writes in every turn,
/// through a reference, a local vector of dual numbers that the other one reads, which then sees the last turn's.
#define MYRIAD_WHOLE_LOOP \
    if (!__builtin_is_constant_evaluated()) asm volatile("")
/// Inlines all calls within a function that contains much of the kernel body. Functions that are not always inlined, as
/// xsimd's, g++ inlines one by one, and reads the whole function after each, which took 32 of 52 s for four
/// coupled oscillators. With this attribute it inlines them all before it reads.
#if defined(MYRIAD_OUT_OF_LINE)
#define MYRIAD_FLATTEN
#else
#define MYRIAD_FLATTEN __attribute__((flatten))
#endif
#endif
#define MYRIAD_LARGE_FUNCTION MYRIAD_FLATTEN __attribute__((noinline))
#define MYRIAD_RARE_FUNCTION __attribute__((noinline))
#define MYRIAD_CALLED_FUNCTION MYRIAD_LARGE_FUNCTION
#define MYRIAD_CALL_ARGUMENT(...) const __VA_ARGS__&
#define MYRIAD_CONSTANT_MEMORY inline constexpr
#define MYRIAD_OPTIMISATION_BARRIER(value) static_cast<void>(value)
#define MYRIAD_MEMORY_BARRIER static_cast<void>(0)
#define MYRIAD_PREFETCH(where) __builtin_prefetch(where)
#define MYRIAD_RECONVERGE static_cast<void>(0)
#define MYRIAD_UNROLL_BY(count)
#define MYRIAD_ROLLED
#define MYRIAD_ROUNDED_PRODUCT(a, b) ((a) * (b))
#if defined(__clang__)
#define MYRIAD_UNROLL _Pragma("clang loop unroll(full)")
#define MYRIAD_UNROLL_UP_TO(on_gpu, on_cpu) MYRIAD_PRAGMA(clang loop unroll_count(on_cpu))
#define MYRIAD_UNROLL_ON_GPU _Pragma("clang loop unroll(disable)")
#else
#define MYRIAD_UNROLL _Pragma("GCC unroll 128")
#define MYRIAD_UNROLL_UP_TO(on_gpu, on_cpu) MYRIAD_PRAGMA(GCC unroll on_cpu)
#define MYRIAD_UNROLL_ON_GPU _Pragma("GCC unroll 1")
#endif
#define MYRIAD_BACKEND_HEADER "myriad/openmp/run.hpp"
#define MYRIAD_ADJOINT_HEADER "myriad/openmp/adjoint.hpp"
#if defined(__AVX512F__)
#define MYRIAD_TARGET openmp_avx512
#define MYRIAD_INSTRUCTION_SET avx512
#elif defined(__AVX2__)
#define MYRIAD_TARGET openmp_avx2
#define MYRIAD_INSTRUCTION_SET avx2
#elif defined(__x86_64__)
#define MYRIAD_TARGET openmp_sse2
#define MYRIAD_INSTRUCTION_SET sse2
#else
#define MYRIAD_TARGET openmp_generic
#define MYRIAD_INSTRUCTION_SET generic
#endif
#endif

// Whether the target has a fused multiply-add, which fma then uses for every kind of number.
#if defined(__FMA__) || defined(__AVX512F__) || defined(__ARM_FEATURE_FMA) || MYRIAD_ON_GPU
#define MYRIAD_FUSED 1
#else
#define MYRIAD_FUSED 0
#endif

// Code of the kernel body is in `namespace myriad::inline MYRIAD_TARGET`, internal code in `namespace
// myriad::detail::inline MYRIAD_TARGET`, so that every mangled name contains the backend and the instruction set. Types
// exchanged between host and backends are not in these inline namespaces. Classes that models handle have no base, and
// no template argument, in `detail`: else argument-dependent look-up would bring its functions into a model's own
// calls.
namespace myriad {
inline namespace MYRIAD_TARGET {}
namespace detail {
inline namespace MYRIAD_TARGET {}
}  // namespace detail
// The host side and the backends may use internal names. Argument-dependent look-up ignores using-directives.
namespace host::inline MYRIAD_ABI {
using namespace detail;
}
namespace openmp {
using namespace detail;
}
namespace cuda {
using namespace detail;
}
}  // namespace myriad

// A number of components is an `extent`. Loops over them end at MYRIAD_LENGTH(n), arrays of them that are no `vec` have
// MYRIAD_CAPACITY(n). All three are plain numbers, but for models whose numbers of components are known only when they
// run. Who compiles such models, as the Python package its interpreter, defines the three before: extents are then
// names that become numbers by these macros alone, and are compared only with constants. What forgets one does not
// compile.
#if !defined(MYRIAD_LENGTH)
namespace myriad::detail {
using extent = int;
}
#define MYRIAD_LENGTH(n) (n)
#define MYRIAD_CAPACITY(n) (n)
#endif
/// More iterations than this of large bodies stay loops, which otherwise take minutes to compile.
#define MYRIAD_MOST_COPIES 32

#if defined(__GNUC__)
#define MYRIAD_UNLIKELY(condition) __builtin_expect(static_cast<bool>(condition), 0)
#else
#define MYRIAD_UNLIKELY(condition) (condition)
#endif
