// SPDX-License-Identifier: MIT
// The instruction sets that CPU code is compiled for, possibly several in one program, and which of them this CPU has.
#pragma once

#include <type_traits>

#include "myriad/kernel/core/abi.hpp"

namespace myriad {
namespace openmp {

/// What CPU code was compiled for, the best first.
enum class instruction_set { avx512, avx2, sse2, generic };

/// Distinguishes functions compiled for different sets. A function argument, not a template argument: a file that
/// defines a function for its own set may name those for others without compiling them.
template <instruction_set set>
using for_set = std::integral_constant<instruction_set, set>;

}  // namespace openmp

namespace host::inline MYRIAD_ABI {

inline constexpr openmp::instruction_set all_instruction_sets[] = {
    openmp::instruction_set::avx512, openmp::instruction_set::avx2, openmp::instruction_set::sse2,
    openmp::instruction_set::generic};

inline const char* name_of(openmp::instruction_set set) {
    switch (set) {
        case openmp::instruction_set::avx512:
            return "avx512";
        case openmp::instruction_set::avx2:
            return "avx2";
        case openmp::instruction_set::sse2:
            return "sse2";
        case openmp::instruction_set::generic:
            return "generic";
    }
    return "unknown";
}

/// Whether this CPU has the instructions that compilers use with -march=x86-64-v4, -v3 or for any x86-64.
inline bool cpu_has(openmp::instruction_set set) {
#if defined(__x86_64__)
    switch (set) {
        case openmp::instruction_set::avx512:
            return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                   __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                   __builtin_cpu_supports("avx512vl");
        case openmp::instruction_set::avx2:
            return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
        default:
            return true;
    }
#else
    return set == openmp::instruction_set::generic;
#endif
}

}  // namespace host::inline MYRIAD_ABI
}  // namespace myriad
