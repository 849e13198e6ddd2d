// SPDX-License-Identifier: MIT
// Small models for the tests of the ensemble: one with every kind of component and hook, one with an event alone, a
// bare one, and one that no source file instantiates.
#pragma once

#include <myriad/model.hpp>

namespace ensemble_models {

/// Oscillator x'' = -rate scale x + force, with everything that a model may have.
struct complete {
    enum state { x, v, n_state };
    enum parameter { rate, force, n_parameter };
    enum shared { scale, n_shared };
    enum shared_integer { sign, n_shared_integer };
    enum accessory { peak, entered, n_accessory };
    enum integer_accessory { steps, turns, finished, n_integer_accessory };
    enum event { turning_point, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return {y[v], p[force] - p[rate] * p.shared[scale] * y[x]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_event>{y[v]};
    }
    MYRIAD_FUNCTION static void initialise(auto& lane) {
        lane.accessory[peak] = lane.y[x];
        lane.accessory[entered] = lane.t;
        lane.integer_accessory[steps] = 0;
        lane.integer_accessory[turns] = 0;
    }
    MYRIAD_FUNCTION static void after_step(auto& lane) { lane.integer_accessory[steps] += 1; }
    MYRIAD_FUNCTION static myriad::action after_event(int, auto& lane) {
        lane.accessory[peak] = myriad::max(lane.accessory[peak], lane.y[x]);
        lane.integer_accessory[turns] += lane.shared_integer[sign];
        return myriad::action::proceed;
    }
    MYRIAD_FUNCTION static void finalise(auto& lane) { lane.integer_accessory[finished] += 1; }
};

/// x' = rate, with the event x = 1 and no hook: only `stop_after` can end a phase early.
struct watched {
    enum state { x, n_state };
    enum parameter { rate, n_parameter };
    enum event { arrival, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>&, const auto& p) {
        return myriad::vec<R, n_state>{p[rate]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_event>{y[x] - R(1)};
    }
};

/// x' = -rate x and w' = x: nothing but a right-hand side.
struct bare {
    enum state { x, w, n_state };
    enum parameter { rate, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return {-(p[rate] * y[x]), y[x]};
    }
};

/// x' = -x, with a hook that ends every phase at t = 1; for phases without an end of their own.
struct hooked {
    enum state { x, n_state };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_state>{-y[x]};
    }
    MYRIAD_FUNCTION static myriad::action after_step(auto& lane) {
        return lane.t >= 1 ? myriad::action::end_phase : myriad::action::proceed;
    }
};

/// Correct, but in no MYRIAD_INSTANTIATE.
struct forgotten {
    enum state { x, n_state };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_state>{-y[x]};
    }
};

}  // namespace ensemble_models
