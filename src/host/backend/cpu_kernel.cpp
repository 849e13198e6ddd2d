// SPDX-License-Identifier: MIT
// Chooses the instruction set of a CPU's kernels, and runs them.
#include "myriad/host/backend/cpu_kernel.hpp"

#include <cstdlib>
#include <exception>
#include <string>
#include <string_view>
#include <vector>

#include "myriad/host/backend/cost_order.hpp"
#include "myriad/host/core/error.hpp"
#include "myriad/host/memory/memory_need.hpp"

namespace myriad::host::inline MYRIAD_ABI {

openmp::instruction_set choose_instruction_set(const compiled_sets& compiled) {
    const char* const variable = std::getenv("MYRIAD_INSTRUCTION_SET");
    const std::string_view wanted = variable == nullptr ? "" : variable;
    std::string names;
    for (std::size_t s = 0; s < compiled.size(); ++s) {
        if (!compiled[s]) continue;
        const openmp::instruction_set set = all_instruction_sets[s];
        if (cpu_has(set) && (wanted.empty() || wanted == name_of(set))) return set;
        names += (names.empty() ? "" : ", ") + std::string(name_of(set));
    }
    require(wanted.empty(), "MYRIAD_INSTRUCTION_SET is \"", wanted, "\", but this model was compiled for ", names, cure,
            "name one of these that the CPU has, or unset the variable");
    throw error(statement_of("this model was compiled for ", names, ", which this CPU lacks", cure,
                             "build it with -DMYRIAD_ARCH=x86-64-v2, or for several instruction sets with "
                             "-DMYRIAD_ARCH=\"x86-64-v2;x86-64-v3;x86-64-v4\""));
}

namespace {

/// The first phase counts each instance's steps; the other phases take the instances in the order of that count.
template <class R>
run_statistics run_by_cost(const cpu_kernel<R>& kernel, any_arguments<R> all, const run_options& options) {
    const std::int64_t count = options.count > 0 ? options.count : all.size;
    memory_need need;
    need.add("costs", static_cast<double>(all.size + count) * sizeof(std::uint32_t));
    need.check(message("sorting ", count, " instances by cost"),
               statement_of("take another schedule, or ", cures::smaller_parts));
    std::vector<std::uint32_t> cost(static_cast<std::size_t>(all.size));
    run_options silent = options;  // no instance is done after its first phase
    silent.progress = nullptr;
    any_arguments<R> first_phase = all;
    first_phase.cost = cost.data();
    first_phase.phases = 1;
    const run_statistics first = kernel.run(first_phase, silent);
    if (first.failed || first.least_stack < first.stack) return first;
    const stop_request asked = options.stop != nullptr ? options.stop(options.context) : stop_request::none;
    if (asked == stop_request::begin_no_more || asked == stop_request::end_now) return first;
    const std::vector<std::uint32_t> order = order_by_cost(cost.data(), count);
    all.first_phase = 1;
    all.order = order.data();
    run_statistics used = kernel.run(all, options);
    used.lane_turns += first.lane_turns;
    return used;
}

}  // namespace

template <class R>
run_statistics run_kernel(const cpu_kernel<R>& kernel, const any_arguments<R>& all, const run_options& options) {
    require(kernel.run != nullptr, "this model was not instantiated for this method and real type");
    const bool sorted = options.schedule == schedule::by_cost && all.phases > 1 && all.size <= most_sorted;
    std::exception_ptr failure;
    run_options watched = options;
    watched.failure = &failure;
    watched.caught = [](void* kept) { *static_cast<std::exception_ptr*>(kept) = std::current_exception(); };
    run_statistics used = sorted ? run_by_cost(kernel, all, watched) : kernel.run(all, watched);
    require(used.computed_as_written, "the model's file ", not_as_written);
    require(used.least_stack >= used.stack, "a thread has ", used.least_stack,
            " bytes of stack, and the kernel of this model and method takes about ", used.stack, cure,
            "set OMP_STACKSIZE to more, such as 8M, or unset it; a thread of your own that solves needs as much");
    if (failure) std::rethrow_exception(failure);
    used.instruction_set = name_of(kernel.set);
    return used;
}
template run_statistics run_kernel(const cpu_kernel<double>&, const any_arguments<double>&, const run_options&);
template run_statistics run_kernel(const cpu_kernel<float>&, const any_arguments<float>&, const run_options&);

}  // namespace myriad::host::inline MYRIAD_ABI
