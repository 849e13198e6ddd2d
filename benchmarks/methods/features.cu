// SPDX-License-Identifier: MIT
// A kernel of the Duffing oscillator with more and more features, whose registers, stack and spills
// scripts/method_registers.py tabulates. Compiled with METHOD, REAL and EVENTS (0, 1, 2 or 4) defined, and with the
// name of a feature for each one that the model has.
#include <myriad/cuda/kernel.cuh>
#include <myriad/methods.hpp>
#include <myriad/model.hpp>

struct oscillator {
    static constexpr bool accessories_are_outputs = true;
    enum state { x, v, n_state };
    enum parameter { k, n_parameter };
    enum shared { B, n_shared };
#if defined(ACCESSORIES) || defined(SUMMARIES)
    enum accessory { largest, last, n_accessory };
#endif

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        return {y[v], y[x] - y[x] * y[x] * y[x] - p[k] * y[v] + p.shared[B] * myriad::cos(t)};
    }

#if EVENTS > 0
    enum event { local_maximum, zero, right, left, n_event = EVENTS };
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto&) {
        const R all[4] = {y[v], y[x], y[x] - R(1), y[x] + R(1)};
        myriad::vec<R, n_event> g;
        MYRIAD_UNROLL
        for (int j = 0; j < n_event; ++j) g[j] = all[j];
        return g;
    }
#endif
#ifdef SUMMARIES
    enum observed { displacement, n_observed };
    static constexpr myriad::summary summaries[] = {{displacement, myriad::over_phase::maximum, largest}};
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_observed> observe(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_observed>{y[x]};
    }
#endif
#ifdef PHASE_ENDS
    MYRIAD_FUNCTION static void initialise(auto& lane) { lane.accessory[largest] = lane.y[x]; }
    MYRIAD_FUNCTION static void finalise(auto& lane) { lane.accessory[last] = lane.y[v]; }
#endif
#ifdef AFTER_STEP
    template <class R>
    MYRIAD_FUNCTION static void after_step(auto& lane) {
        lane.accessory[largest] = myriad::max(lane.accessory[largest], lane.y[x]);
    }
#endif
#ifdef OBSERVING_ACTION  // the state stays as it is
    MYRIAD_FUNCTION static void after_event(int, auto& lane) { lane.accessory[last] = lane.y[v]; }
#endif
#ifdef IMPACT
    MYRIAD_FUNCTION static void after_event(int, auto& lane) { lane.y[v] = -lane.y[v]; }
#endif
};

constexpr auto constant = myriad::shared_placement::constant_bank;
template __global__ void myriad::detail::integrate_ensemble<oscillator, myriad::METHOD, REAL, constant>(
    const __grid_constant__ myriad::detail::launch_arguments<oscillator, REAL, constant>);
