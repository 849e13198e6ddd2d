// SPDX-License-Identifier: MIT
// Chooses, from the instruction sets that a kernel was compiled for, the best that the CPU has. Host code, which is
// itself compiled for any CPU.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <iterator>

#include "myriad/host/backend/backend.hpp"
#include "myriad/host/core/instruction_set.hpp"
#include "myriad/kernel/core/abi.hpp"

namespace myriad {
namespace host::inline MYRIAD_ABI {

/// A kernel for the CPU; without a function if it was not compiled.
template <class R>
struct cpu_kernel {
    std::function<run_statistics(const any_arguments<R>&, const run_options&)> run = {};
    openmp::instruction_set set = openmp::instruction_set::generic;
};

/// The kernel for one instruction set, or null.
template <openmp::instruction_set set, class Model, class Method, class R>
auto kernel_for() -> run_statistics (*)(const any_arguments<R>&, const run_options&) {
    using tag = openmp::for_set<set>;
    run_statistics (*const compiled)(tag, const any_arguments<R>&, const run_options&) =
        &openmp::run_on<Model, Method, R>;
    if (if_defined(compiled) == nullptr) return nullptr;
    return
        [](const any_arguments<R>& a, const run_options& o) { return openmp::run_on<Model, Method, R>(tag{}, a, o); };
}

/// The instruction sets that a kernel was compiled for, in the order of `all_instruction_sets`.
using compiled_sets = std::array<bool, std::size(all_instruction_sets)>;

/// The best of them that the CPU has, or the one that the environment variable MYRIAD_INSTRUCTION_SET names. Throws
/// `error` if the CPU has none of them, or not the one named.
openmp::instruction_set choose_instruction_set(const compiled_sets& compiled);

/// The kernel for the chosen instruction set; without a function if it was compiled for none.
template <class Model, class Method, class R>
cpu_kernel<R> choose_cpu_kernel() {
    using openmp::instruction_set;
    const std::array kernels{kernel_for<instruction_set::avx512, Model, Method, R>(),
                             kernel_for<instruction_set::avx2, Model, Method, R>(),
                             kernel_for<instruction_set::sse2, Model, Method, R>(),
                             kernel_for<instruction_set::generic, Model, Method, R>()};
    compiled_sets compiled{};
    bool any = false;
    for (std::size_t s = 0; s < compiled.size(); ++s) any |= compiled[s] = kernels[s] != nullptr;
    if (!any) return {};
    const instruction_set set = choose_instruction_set(compiled);
    return {kernels[static_cast<std::size_t>(set)], set};
}

/// Integrates on the CPU. Throws `error` if there is no kernel, or too little stack for it, and rethrows exceptions of
/// the model's functions.
template <class R>
run_statistics run_kernel(const cpu_kernel<R>& kernel, const any_arguments<R>& arguments, const run_options& options);

}  // namespace host::inline MYRIAD_ABI

namespace openmp {

/// Integrates on the CPU with the kernel that fits it. Throws `error` if there is none.
template <class Model, class Method, class R>
run_statistics run(const any_arguments<R>& arguments, const run_options& options) {
    return host::run_kernel(host::choose_cpu_kernel<Model, Method, R>(), arguments, options);
}

}  // namespace openmp
}  // namespace myriad
