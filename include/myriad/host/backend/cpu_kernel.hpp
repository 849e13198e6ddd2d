// SPDX-License-Identifier: MIT
// Chooses, from the instruction sets that a kernel was compiled for, the best that the CPU has. Host code, which is
// itself compiled for any CPU.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <exception>
#include <string>
#include <string_view>
#include <vector>

#include "myriad/host/backend/backend.hpp"
#include "myriad/host/backend/cost_order.hpp"
#include "myriad/host/core/error.hpp"
#include "myriad/host/core/instruction_set.hpp"
#include "myriad/host/memory/memory_need.hpp"

namespace myriad {
namespace host {

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

/// The best of the instruction sets that a kernel was compiled for and the CPU has, or the one that the environment
/// variable MYRIAD_INSTRUCTION_SET names. Throws `error` if the CPU has none of them, or not the one named.
inline openmp::instruction_set choose_instruction_set(const std::vector<openmp::instruction_set>& compiled) {
    const char* const variable = std::getenv("MYRIAD_INSTRUCTION_SET");
    const std::string_view wanted = variable == nullptr ? "" : variable;
    std::string names;
    for (const openmp::instruction_set set : compiled) {
        if (cpu_has(set) && (wanted.empty() || wanted == name_of(set))) return set;
        names += (names.empty() ? "" : ", ") + std::string(name_of(set));
    }
    require(wanted.empty(), "MYRIAD_INSTRUCTION_SET is \"", wanted, "\", but this model was compiled for ", names,
            ": name one of these that the CPU has, or unset the variable");
    throw error(
        message("this model was compiled for ", names,
                ", which this CPU lacks: build it with -DMYRIAD_ARCH=x86-64-v2, or for several instruction sets with "
                "-DMYRIAD_ARCH=\"x86-64-v2;x86-64-v3;x86-64-v4\""));
}

/// The kernel for the chosen instruction set; null if it was compiled for none.
template <class Model, class Method, class R>
cpu_kernel<Model, R> choose_cpu_kernel() {
    std::vector<openmp::instruction_set> compiled;
    for (const openmp::instruction_set set : all_instruction_sets)
        if (compiled_kernel<Model, Method, R>(set).run != nullptr) compiled.push_back(set);
    if (compiled.empty()) return {};
    return compiled_kernel<Model, Method, R>(choose_instruction_set(compiled));
}

/// The first phase counts each instance's steps; the other phases take the instances in the order of that count.
template <class Model, class R>
run_statistics run_by_cost(const cpu_kernel<Model, R>& kernel, const kernel_arguments<Model, R>& arguments,
                           const run_options& options) {
    const std::int64_t count = options.count > 0 ? options.count : arguments.size;
    memory_need need;
    need.add("costs", static_cast<double>(arguments.size + count) * sizeof(std::uint32_t));
    need.check(message("sorting ", count, " instances by cost"),
               "take another schedule, or integrate the ensemble in smaller parts");
    std::vector<std::uint32_t> cost(static_cast<std::size_t>(arguments.size));
    kernel_arguments<Model, R> now = arguments;
    now.cost = cost.data();
    now.phases = 1;
    run_options silent = options;  // no instance is done after its first phase
    silent.progress = nullptr;
    const run_statistics first = kernel.run(now, silent);
    if (first.failed || first.least_stack < first.stack) return first;
    const std::vector<std::uint32_t> order = order_by_cost(cost.data(), count);
    now = arguments;
    now.first_phase = 1;
    now.order = order.data();
    run_statistics used = kernel.run(now, options);
    used.lane_turns += first.lane_turns;
    return used;
}

/// Integrates on the CPU. Throws `error` if there is no kernel, or too little stack for it, and rethrows exceptions of
/// the model's functions.
template <class Model, class R>
run_statistics run_kernel(const cpu_kernel<Model, R>& kernel, const kernel_arguments<Model, R>& arguments,
                          const run_options& options) {
    require(kernel.run != nullptr, "this model was not instantiated for this method and real type");
    const bool sorted = options.schedule == schedule::by_cost && arguments.phases > 1 && arguments.size <= most_sorted;
    std::exception_ptr failure;
    run_options watched = options;
    watched.failure = &failure;
    watched.caught = [](void* kept) { *static_cast<std::exception_ptr*>(kept) = std::current_exception(); };
    run_statistics used = sorted ? run_by_cost(kernel, arguments, watched) : kernel.run(arguments, watched);
    require(used.computed_as_written, "the model's file ", not_as_written);
    require(used.least_stack >= used.stack, "a thread has ", used.least_stack,
            " bytes of stack, and the kernel of this model and "
            "method takes about ",
            used.stack,
            ": set OMP_STACKSIZE to more, such as 8M, or unset it; a thread of your own that "
            "solves needs as much");
    if (failure) std::rethrow_exception(failure);
    used.instruction_set = name_of(kernel.set);
    return used;
}

}  // namespace host

namespace openmp {

/// Integrates on the CPU with the kernel that fits it. Throws `error` if there is none.
template <class Model, class Method, class R>
run_statistics run(const kernel_arguments<Model, R>& arguments, const run_options& options) {
    return host::run_kernel(host::choose_cpu_kernel<Model, Method, R>(), arguments, options);
}

}  // namespace openmp
}  // namespace myriad
