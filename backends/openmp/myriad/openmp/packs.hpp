// SPDX-License-Identifier: MIT
// The loop of the CPU: every thread of a team runs it on a pack of SIMD lanes, refilled from a common supply of
// instances. It knows nothing of how threads are made.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include <sched.h>
#include <time.h>

#include "myriad/host/backend/cpu_backend.hpp"
#include "myriad/host/threads/parallel.hpp"
#if !defined(MYRIAD_WITHOUT_XSIMD)
#include "myriad/kernel/scalar/pack.hpp"
#endif
// after the packs, whose functions the loop calls
#include "myriad/kernel/integrator/integrate.hpp"
#include "myriad/openmp/instances.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// SIMD batches per pack: enough independent work to hide a batch's latency, few enough that the stages of a large
/// state stay in the first-level cache, and one if events make lanes diverge at every step. Measured on a Zen 4, CPU
/// time per step and instance in ns with 1, 2, 3, 4 batches: with AVX-512, whose 32 registers hold two batches, Lorenz
/// with RK4 -, 1.35, 1.46, 1.40 and Duffing with Cash-Karp -, 11.6, 12.2, -; with AVX2, whose 16 hold none, -, 2.38,
/// 2.10, 2.07 and -, 16.6, 15.7, 15.9, but the bubble of cpu_peers, with its 13 parameters, -, 54, 56, -; with events
/// every 5 steps 46, 48, 76, - and 63, 71, 78, -; with hundreds of steps between events (the valve of cpu_peers) -,
/// 12.4, 13.0, - and -, 19.4, 17.3, 18.7. That is g++'s code; clang++'s with AVX-512 on an Intel Xeon takes -, 1.25,
/// 0.98, -, Duffing -, 9.6, 9.3, -, the valve -, 11.3, 12.1, -. A model may choose by `static constexpr bool
/// rare_events = true;` or `static constexpr int pack_batches = 2;`.
template <class Model, class Method>
constexpr int default_batches() {
#if defined(MYRIAD_WITHOUT_XSIMD)  // MYRIAD_SIMD
    return 0;
#else
#if defined(MYRIAD_SCALAR_LANES)  // with sanitizers, which take minutes to compile a pack's kernel
    constexpr bool one_by_one = true;
#else
    constexpr bool one_by_one = scalar_only<Model>;
#endif
#if defined(MYRIAD_ONE_BATCH)  // tests of lanes beside each other: in three quarters of the time
    constexpr bool one_batch = true;
#else
    constexpr auto states = n_state<Model>;
    constexpr bool one_batch = states > 16 || (has_events<Model> && !rare_events<Model>);
#endif
    if constexpr (one_by_one) {
        return 0;
    } else if constexpr (requires { Model::pack_batches; }) {
        return Model::pack_batches;
    } else if constexpr (one_batch) {
        return 1;
    } else {
#if defined(__clang__)
        constexpr bool two_fit = pack<double, 1>::lanes == 8 && has_events<Model>;
#else
        constexpr bool two_fit = pack<double, 1>::lanes == 8;  // AVX-512
#endif
        constexpr bool small = n_state<Model> <= 4 &&
                               MYRIAD_CAPACITY(n_state<Model>) + MYRIAD_CAPACITY(n_parameter<Model>) <= 8 &&
                               Method::stages <= 7;
        return two_fit || !small ? 2 : 3;
    }
#endif
}

/// The scalar kind with `batches` batches; 0: one instance at a time.
template <class R, int batches>
struct lane_kind;
#if !defined(MYRIAD_WITHOUT_XSIMD)
template <class R, int batches>
requires(batches > 0) struct lane_kind<R, batches> {
    using type = pack<R, batches>;
};
#endif
template <class R>
struct lane_kind<R, 0> {
    using type = R;
};

/// Estimate of a kernel's stack per thread in bytes: twice the data it holds, as the compiler makes separate copies of
/// parts of it, and some states for a step's intermediate values. g++ was seen to use half to nine tenths of that.
template <class Model, class Method, class S>
constexpr std::size_t stack_of_kernel() {
    constexpr std::size_t state = sizeof(vec<S, n_state<Model>>), few = 4096;
    constexpr std::size_t matrix =
        solves_linear_systems<Method> ? sizeof(vec<vec<S, n_state<Model>>, n_state<Model>>) : 0;
    return 2 * (sizeof(integrator<Model, Method, S>) + sizeof(trial_step<Method, S, n_state<Model>>)) + matrix +
           16 * state + few;
}

/// One run of a kernel by a team of threads.
template <class Model, class Method, class S>
struct team_run {
    const kernel_arguments<Model, real_of<S>>& arguments;
    const run_options& options;
    std::int64_t count, chunk;
    common_supply supply{};
    std::atomic<std::int64_t> iterations{0};
    std::atomic<int> at_work{0};  // threads
    bool failed = false;

    /// An exception from a function of the model ends the run: no further instance is started. The host stores the
    /// exception, as functions of the standard library that are not inlined here are shared with files for other
    /// instruction sets.
    MYRIAD_FLATTEN static void work(void* context, int part) noexcept {
        auto& run = *static_cast<team_run*>(context);
        ++run.at_work;
        chunked_instances instances(run.supply, run.count, run.chunk, lanes_of<S>, run.arguments.order, run.options,
                                    part == 0);
        try {
            run.iterations += detail::integrate<Model, Method, S>(run.arguments, run.arguments.shared, instances);
        } catch (...) {
            const bool first = !__atomic_exchange_n(&run.failed, true, __ATOMIC_ACQ_REL);
            if (first && run.options.caught != nullptr) run.options.caught(run.options.failure);
            run.supply.stop(run.count);
        }
        --run.at_work;
        if (part == 0 && run.options.stop != nullptr) run.wait_for_others();
    }

    /// The calling thread asks the host whether to stop while the last instances of other threads are under way. It
    /// sleeps for small parts of the time that it has waited already.
    void wait_for_others() {
        constexpr std::int64_t soon = 500'000, shortest = 20'000, longest = 20'000'000;  // ns
        // By the clock: where other programs have the cores, each call may take milliseconds.
        for (const std::int64_t begin = nanoseconds(); at_work > 0 && nanoseconds() - begin < soon;) sched_yield();
        for (std::int64_t waited = 0; at_work > 0;) {
            supply.follow(options, count);
            const std::int64_t next = std::clamp(waited / 64, shortest, longest);
            const timespec nap{0, static_cast<long>(next)};
            nanosleep(&nap, nullptr);
            waited += next;
        }
    }
    static std::int64_t nanoseconds() {
        timespec now{};
        clock_gettime(CLOCK_MONOTONIC, &now);
        return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
    }
};

/// The arguments in the form that the model's kernel takes.
template <class Model, class R>
kernel_arguments<Model, R> arguments_of(const any_arguments<R>& from) {
    using arrays = argument_arrays<Model, R>;
    kernel_arguments<Model, R> all;
    static_cast<argument_head<R>&>(all) = from;
    if constexpr (requires(arrays a) { a.point_to(from); }) {  // the numbers of components are known only now
        all.point_to(from);
    } else {
        constexpr argument_offsets<R> at(numbers_of<Model>);
#define MYRIAD_CHECK_PLACE(type, name, count) static_assert(offsetof(arrays, name) == at.name);
        MYRIAD_ARGUMENT_ARRAYS(MYRIAD_CHECK_PLACE)
#undef MYRIAD_CHECK_PLACE
        static_assert(sizeof(arrays) == at.noise);
        std::memcpy(static_cast<arrays*>(&all), from.arrays, sizeof(arrays));
        if constexpr (has_diffusion<Model>) std::memcpy(&all.noise, from.arrays + at.noise, sizeof(all.noise));
    }
    return all;
}

/// Integrates the ensemble with packs of the given number of batches, by at most `most_threads` threads, whose team
/// `in_parts` sets to work.
template <class Model, class Method, class R, int batches, class InParts>
run_statistics run_packs(const any_arguments<R>& from, const run_options& options, std::int64_t most_threads,
                         InParts&& in_parts) {
    const auto arguments = detail::arguments_of<Model>(from);
    using S = typename lane_kind<R, batches>::type;
    constexpr int lanes = lanes_of<S>;
    const std::int64_t count = options.count > 0 ? options.count : arguments.size;
    const std::int64_t packs = (count + lanes - 1) / lanes;  // more threads would have nothing to do
    const std::int64_t threads = std::min(most_threads, packs);
    // In order: one chunk per thread.
    const std::int64_t chunk = options.schedule == schedule::in_order
                                   ? (count + threads - 1) / threads
                                   : std::clamp<std::int64_t>(count / (64 * threads), 1, 64);
    team_run<Model, Method, S> run{arguments, options, count, chunk};
    openmp::team members{&run.work, &run, static_cast<int>(threads), stack_of_kernel<Model, Method, S>()};
    in_parts(members);
    run_statistics used{run.iterations.load() * lanes, lanes, members.threads};
    used.failed = run.failed;
    used.stack = members.stack;
    used.least_stack = members.least_stack;
    const bool all_done = !run.supply.stopped && members.least_stack >= members.stack;
    if (options.progress && all_done) options.progress(options.context, count);
    return used;
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
