// SPDX-License-Identifier: MIT
// A model whose file has functions of its own with the names of the library's internals, and the same model without
// them.
#pragma once

#include <myriad/model.hpp>

// Outside of any namespace, as in many a user's model. The names are those of functions in myriad::detail.
// clang-format off
#define OWN_NAMES(each) \
    each(all_finite) each(sign_of) each(count_where) each(set_count) each(for_each_lane) each(any_event) \
    each(first_event) each(pick) each(factorise) each(solve_factorised) each(evaluate_rhs) each(evaluate_events) \
    each(event_slopes) each(get_lane) each(set_lane) each(get_lanes) each(same_values) each(any) each(all) \
    each(bits) each(larger) each(smaller) each(limited) each(quotient) each(commit) each(take_trial_step) \
    each(explicit_rk_step) each(interpolate) each(complete_interpolant) each(ensure_slope_end) each(find_root) \
    each(interval_from) each(choose_first_step) each(scaled_error) each(error_sum) each(fast_power) \
    each(run_on_lane) each(extract_lane) each(insert_lane) each(action_of) each(combine) each(part) each(along) \
    each(derivatives) each(polynomial) each(see_stage_before) each(time_derivative) each(dual_jacobian) \
    each(static_for) each(integrate) each(solve) each(elapsed_beyond) each(cubic_root) each(crossing_fraction) \
    each(earliest_crossing) each(first_of) each(error_ratio) each(hermite_interpolation)
// clang-format on

/// One takes vectors, as the model calls it. The other takes anything, and would intercept the library's own calls.
#define DECLARE_OWN_NAME(name)                                           \
    template <class S, int n>                                            \
    MYRIAD_FUNCTION myriad::vec<S, n> name(const myriad::vec<S, n>& y) { \
        return y;                                                        \
    }                                                                    \
    template <class... Anything>                                         \
    MYRIAD_FUNCTION void name(Anything&&...) {}
OWN_NAMES(DECLARE_OWN_NAME)
#undef DECLARE_OWN_NAME

/// A ball on a spring that is pushed through zero: a right-hand side, events and all hooks.
struct plainly_named {
    enum state { x, v, n_state };
    enum parameter { stiffness, n_parameter };
    enum accessory { largest, n_accessory };
    enum event { passes, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        return {y[v], myriad::cos(t) - p[stiffness] * y[x]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_event>{y[x]};
    }
    MYRIAD_FUNCTION static void initialise(auto& lane) { lane.accessory[largest] = lane.y[x]; }
    MYRIAD_FUNCTION static void after_step(auto& lane) {
        lane.accessory[largest] = myriad::max(lane.accessory[largest], lane.y[x]);
    }
    MYRIAD_FUNCTION static void after_event(int, auto& lane) { lane.y[v] = lane.y[v] * 0.75; }
    MYRIAD_FUNCTION static void finalise(auto& lane) { lane.y[x] = lane.y[x] + 1.0; }
};

struct strangely_named : plainly_named {
#define CALL_OWN_NAME(name) y = name(constant);
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, myriad::vec<R, n_state> y, const auto& p) {
        const auto& constant = y;  // the function for vectors fits it better
        OWN_NAMES(CALL_OWN_NAME)
        return plainly_named::rhs<R>(t, y, p);
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto t, myriad::vec<R, n_state> y, const auto& p) {
        const auto& constant = y;  // the function for vectors fits it better
        OWN_NAMES(CALL_OWN_NAME)
        return plainly_named::events<R>(t, y, p);
    }
#undef CALL_OWN_NAME
#define CALL_OWN_NAME(name) lane.y = name(constant);
    MYRIAD_FUNCTION static void after_step(auto& lane) {
        const auto& constant = lane.y;
        OWN_NAMES(CALL_OWN_NAME)
        plainly_named::after_step(lane);
    }
    MYRIAD_FUNCTION static void after_event(int event, auto& lane) {
        const auto& constant = lane.y;
        OWN_NAMES(CALL_OWN_NAME)
        plainly_named::after_event(event, lane);
    }
#undef CALL_OWN_NAME
};
