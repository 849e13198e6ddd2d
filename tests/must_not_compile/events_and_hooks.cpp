// case: event_enumeration_without_events
// expect: a model with events has both `enum event
// case: events_without_an_event_enumeration
// expect: a model with events has both `enum event
// case: events_with_a_result_of_the_wrong_size
// expect: events has a wrong signature: it must be
// case: events_with_a_wrong_signature
// expect: events has a wrong signature: it must be
// case: after_event_with_a_wrong_signature
// expect: after_event has a wrong signature: it must be
// case: after_event_without_events
// expect: the model has after_event but no events: give it
// case: stop_enumeration_without_stop_time
// expect: a model with stop times has both `enum stop
// case: stop_time_without_a_stop_enumeration
// expect: a model with stop times has both `enum stop
// case: stop_time_with_a_wrong_signature
// expect: stop_time has a wrong signature: it must be
// case: after_stop_with_a_wrong_signature
// expect: after_stop has a wrong signature: it must be
// case: after_stop_without_stop_time
// expect: the model has after_stop but no stop times: give it
// case: trigger_without_after_trigger
// expect: a model with triggers has `enum trigger
// case: condition_with_a_wrong_signature
// expect: condition has a wrong signature: it must be
// case: after_trigger_without_triggers
// expect: the model has after_trigger but no triggers: give it
// case: initialise_with_a_wrong_signature
// expect: initialise has a wrong signature: it must be
// case: finalise_with_a_wrong_signature
// expect: finalise has a wrong signature: it must be
// case: private_finalise
// expect: finalise has a wrong signature: .* and public
// expect: private (within this context|member of)
// case: after_step_that_returns_a_number
// expect: after_step has a wrong signature: it must be
// case: after_step_with_a_wrong_signature
// expect: after_step has a wrong signature: it must be
// case: generic_after_step_that_returns_an_action
// expect: after_step has a wrong signature: it must be
// case: branch_on_the_state_in_a_generic_after_step
// expect: this model branches on its state: use myriad::select.*scalar_only
// case: parameter_written_without_declaring_it
// expect: read-only|returns a const value|const-qualified
// case: time_domain_written_without_declaring_it
// expect: read-only|returns a const value|const-qualified
// case: time_written_by_a_hook
// expect: read-only|returns a const value|const-qualified
// SPDX-License-Identifier: MIT
// Events and hooks that the loop cannot call, and writes that hooks may not make.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct decay {
    enum state { x, n_state };
    enum parameter { k, n_parameter };
#if !defined CASE_events_without_an_event_enumeration && !defined CASE_after_event_without_events
    enum event { zero, n_event };
#endif

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return myriad::vec<R, n_state>{-(p[k] * y[x])};
    }

#if defined CASE_events_with_a_result_of_the_wrong_size
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 2> events(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, 2>{y[x], y[x]};
    }
#elif defined CASE_events_with_a_wrong_signature  // the parameters are missing
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> events(auto, const myriad::vec<R, n_state>& y) {
        return myriad::vec<R, 1>{y[x]};
    }
#elif !defined CASE_event_enumeration_without_events && !defined CASE_after_event_without_events
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> events(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, 1>{y[x]};
    }
#endif

#ifdef CASE_after_event_with_a_wrong_signature  // it does not receive the event's number
    MYRIAD_FUNCTION static void after_event(auto&) {}
#endif
#ifdef CASE_after_event_without_events  // nothing would ever call it
    MYRIAD_FUNCTION static void after_event(int, auto&) {}
#endif
#ifdef CASE_initialise_with_a_wrong_signature  // a phase cannot end in initialise
    MYRIAD_FUNCTION static myriad::action initialise(auto&) { return myriad::action::end_phase; }
#endif
#if defined CASE_stop_enumeration_without_stop_time || defined CASE_stop_time_with_a_wrong_signature || \
    defined CASE_after_stop_with_a_wrong_signature
    enum stop { dose, n_stop };
#endif
#ifdef CASE_stop_time_with_a_wrong_signature  // the number is missing
    template <class R>
    MYRIAD_FUNCTION static R stop_time(int, const auto& p) {
        return p[k];
    }
#endif
#if defined CASE_stop_time_without_a_stop_enumeration || defined CASE_after_stop_with_a_wrong_signature
    template <class R>
    MYRIAD_FUNCTION static R stop_time(int, int, const auto& p) {
        return p[k];
    }
#endif
#ifdef CASE_after_stop_with_a_wrong_signature  // the number is missing
    MYRIAD_FUNCTION static void after_stop(int, auto&) {}
#endif
#if defined CASE_trigger_without_after_trigger || defined CASE_condition_with_a_wrong_signature
    enum trigger { warm, n_trigger };
#endif
#ifdef CASE_trigger_without_after_trigger
    MYRIAD_FUNCTION static bool condition(int, const auto& positive) { return positive[0]; }
#endif
#ifdef CASE_condition_with_a_wrong_signature  // the functions' sides are missing
    MYRIAD_FUNCTION static bool condition(int) { return true; }
    MYRIAD_FUNCTION static void after_trigger(int, auto&) {}
#endif
#ifdef CASE_after_trigger_without_triggers
    MYRIAD_FUNCTION static void after_trigger(int, auto&) {}
#endif
#ifdef CASE_after_stop_without_stop_time
    MYRIAD_FUNCTION static void after_stop(int, int, auto&) {}
#endif
#ifdef CASE_finalise_with_a_wrong_signature
    MYRIAD_FUNCTION static void finalise(double, auto&) {}
#endif
#ifdef CASE_after_step_that_returns_a_number
    MYRIAD_FUNCTION static int after_step(auto&) { return 1; }
#endif
#ifdef CASE_after_step_with_a_wrong_signature
    MYRIAD_FUNCTION static void after_step(double, auto&) {}
#endif
#ifdef CASE_generic_after_step_that_returns_an_action  // an action is for one instance; a pack's hook returns a mask
    template <class R>
    MYRIAD_FUNCTION static myriad::action after_step(auto&) {
        return myriad::action::proceed;
    }
#endif
#ifdef CASE_branch_on_the_state_in_a_generic_after_step
    template <class R>
    MYRIAD_FUNCTION static void after_step(auto& lane) {
        if (lane.y[x] > R(1)) lane.y[x] = R(1);
    }
#endif

// Members not declared as written are not stored, and the time belongs to the integrator.
#ifdef CASE_parameter_written_without_declaring_it
    MYRIAD_FUNCTION static void finalise(auto& lane) { lane.parameter[k] = 2; }
#endif
#ifdef CASE_time_domain_written_without_declaring_it
    MYRIAD_FUNCTION static void finalise(auto& lane) { lane.t_end = 2; }
#endif
#ifdef CASE_time_written_by_a_hook
    MYRIAD_FUNCTION static void after_step(auto& lane) { lane.t = 2; }
#endif

#ifdef CASE_private_finalise
private:
    MYRIAD_FUNCTION static void finalise(auto&) {}
#endif
};

MYRIAD_INSTANTIATE(decay, myriad::runge_kutta_4)
