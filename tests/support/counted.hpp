// SPDX-License-Identifier: MIT
// Models that count their own evaluations. One instance at a time, so that every call of rhs is one evaluation.
#pragma once

#include <cstdint>

#include <myriad/model.hpp>

#include "tests/support/kernel_memory.hpp"

namespace counted {

/// Evaluations in the kernels of one file.
struct kernel_count {
    unsigned long long evaluations;
};
#if MYRIAD_FOR_GPU
MYRIAD_TEST_KERNEL_VARIABLE(kernel_count, in_kernels)
#endif

/// One more evaluation on the CPU; in a file of its own, compiled without the instruction-set flags.
void add();
/// One more evaluation. A template, as it calls what is not constexpr.
template <int = 0>
MYRIAD_FUNCTION void count() {
#if MYRIAD_ON_GPU
    atomicAdd(&in_kernels.evaluations, 1ull);
#else
    add();
#endif
}
/// Evaluations since the last call.
std::int64_t take();

struct oscillator {
    static constexpr bool scalar_only = true;
    enum state { x, v, n_state };
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 2> rhs(auto, const myriad::vec<R, 2>& y, const auto&) {
        count();
        return {y[v], -y[x]};
    }
};

/// The same with events.
struct with_events : oscillator {
    enum event { turning_point, zero, n_event };
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 2> events(auto, const myriad::vec<R, 2>& y, const auto&) {
        return {y[v], y[x]};
    }
};

/// With events that change the state: the speed is reversed where x falls through zero, so that x stays positive.
struct bouncing : oscillator {
    enum event { impact, n_event };
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> events(auto, const myriad::vec<R, 2>& y, const auto&) {
        return myriad::vec<R, 1>{y[x]};
    }
    MYRIAD_FUNCTION static void after_event(int, auto& lane) { lane.y[v] = -lane.y[v]; }
};

/// With an after_step that changes nothing, and one that changes an accessory in every step.
struct idle_hook : oscillator {
    enum accessory { unset, n_accessory };
    MYRIAD_FUNCTION static void after_step(auto&) {}
};
struct busy_hook : oscillator {
    enum accessory { steps, n_accessory };
    MYRIAD_FUNCTION static void after_step(auto& lane) { lane.accessory[steps] = lane.accessory[steps] + 1; }
};

}  // namespace counted
