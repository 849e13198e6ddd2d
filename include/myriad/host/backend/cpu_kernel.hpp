// SPDX-License-Identifier: MIT
// Chooses, from the instruction sets that a kernel was compiled for, the best that the CPU has. Host code, which is
// itself compiled for any CPU.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>

#include "myriad/host/backend/backend.hpp"
#include "myriad/host/core/instruction_set.hpp"
#include "myriad/kernel/core/abi.hpp"

namespace myriad {
namespace host::inline MYRIAD_ABI {

/// A kernel for the CPU; null if it was not compiled.
template <class Model, class R>
struct cpu_kernel {
    run_statistics (*run)(const kernel_arguments<Model, R>&, const run_options&) = nullptr;
    openmp::instruction_set set = openmp::instruction_set::generic;
};

template <openmp::instruction_set set, class Model, class Method, class R>
cpu_kernel<Model, R> kernel_for() {
    using tag = openmp::for_set<set>;
    using arguments = kernel_arguments<Model, R>;
    run_statistics (*const compiled)(tag, const arguments&, const run_options&) = &openmp::run_on<Model, Method, R>;
    if (if_defined(compiled) == nullptr) return {};
    return {[](const arguments& a, const run_options& o) { return openmp::run_on<Model, Method, R>(tag{}, a, o); },
            set};
}
template <class Model, class Method, class R>
cpu_kernel<Model, R> compiled_kernel(openmp::instruction_set set) {
    using openmp::instruction_set;
    switch (set) {
        case instruction_set::avx512:
            return kernel_for<instruction_set::avx512, Model, Method, R>();
        case instruction_set::avx2:
            return kernel_for<instruction_set::avx2, Model, Method, R>();
        case instruction_set::sse2:
            return kernel_for<instruction_set::sse2, Model, Method, R>();
        case instruction_set::generic:
            return kernel_for<instruction_set::generic, Model, Method, R>();
    }
    return {};
}

/// The instruction sets that a kernel was compiled for, in the order of `all_instruction_sets`.
using compiled_sets = std::array<bool, std::size(all_instruction_sets)>;

/// The best of them that the CPU has, or the one that the environment variable MYRIAD_INSTRUCTION_SET names. Throws
/// `error` if the CPU has none of them, or not the one named.
openmp::instruction_set choose_instruction_set(const compiled_sets& compiled);

/// The kernel for the chosen instruction set; null if it was compiled for none.
template <class Model, class Method, class R>
cpu_kernel<Model, R> choose_cpu_kernel() {
    compiled_sets compiled{};
    bool any = false;
    for (std::size_t s = 0; s < compiled.size(); ++s)
        any |= compiled[s] = compiled_kernel<Model, Method, R>(all_instruction_sets[s]).run != nullptr;
    if (!any) return {};
    return compiled_kernel<Model, Method, R>(choose_instruction_set(compiled));
}

/// The part of a run that a schedule by cost divides it into.
struct part_of_run {
    bool is_first;               ///< the first phase alone; otherwise all others
    std::uint32_t* cost;         ///< trial steps of each instance, written by the first
    const std::uint32_t* order;  ///< of the instances in the other phases
};

/// A kernel and its arguments, without the model's type.
struct any_run {
    const void* kernel;
    const void* arguments;
    run_statistics (*run)(const any_run&, const run_options&, const part_of_run*);  ///< null: no kernel
    std::int64_t size, phases;
    openmp::instruction_set set;
};

/// Integrates on the CPU. Throws `error` if there is no kernel, or too little stack for it, and rethrows exceptions of
/// the model's functions.
run_statistics run_kernel(const any_run& all, const run_options& options);

template <class Model, class R>
any_run forget_model(const cpu_kernel<Model, R>& kernel, const kernel_arguments<Model, R>& arguments) {
    any_run all{&kernel, &arguments, nullptr, arguments.size, arguments.phases, kernel.set};
    if (kernel.run != nullptr) {
        all.run = [](const any_run& a, const run_options& o, const part_of_run* part) {
            const auto run = static_cast<const cpu_kernel<Model, R>*>(a.kernel)->run;
            const auto& whole = *static_cast<const kernel_arguments<Model, R>*>(a.arguments);
            if (part == nullptr) return run(whole, o);
            kernel_arguments<Model, R> now = whole;
            if (part->is_first) {
                now.cost = part->cost;
                now.phases = 1;
            } else {
                now.first_phase = 1;
                now.order = part->order;
            }
            return run(now, o);
        };
    }
    return all;
}
template <class Model, class R>
run_statistics run_kernel(const cpu_kernel<Model, R>& kernel, const kernel_arguments<Model, R>& arguments,
                          const run_options& options) {
    return run_kernel(forget_model(kernel, arguments), options);
}

}  // namespace host::inline MYRIAD_ABI

namespace openmp {

/// Integrates on the CPU with the kernel that fits it. Throws `error` if there is none.
template <class Model, class Method, class R>
run_statistics run(const kernel_arguments<Model, R>& arguments, const run_options& options) {
    return host::run_kernel(host::choose_cpu_kernel<Model, Method, R>(), arguments, options);
}

}  // namespace openmp
}  // namespace myriad
