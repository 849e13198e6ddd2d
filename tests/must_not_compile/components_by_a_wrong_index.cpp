// case: state_beyond_the_last_one
// expect: there is no component of this number: components are counted from 0
// case: state_by_the_count_of_states
// expect: there is no component of this number: components are counted from 0
// case: parameter_beyond_the_last_one
// expect: there is no component of this number: components are counted from 0
// case: shared_value_beyond_the_last_one
// expect: there is no component of this number: components are counted from 0
// case: accessory_beyond_the_last_one
// expect: there is no component of this number: components are counted from 0
// case: parameter_read_by_a_state
// expect: this enumerator is not a parameter of the model
// case: shared_value_read_by_a_parameter
// expect: this enumerator is not a shared of the model
// case: shared_integer_read_by_an_unnamed_enumeration_of_states
// expect: this enumerator is not a shared_integer of the model
// case: accessory_read_by_rhs_that_declares_them_outputs
// expect: no member named.*accessory
// case: integer_accessory_read_by_rhs_that_declares_them_outputs
// expect: no member named.*integer_accessory
// case: accessory_read_by_events_that_declare_them_outputs
// expect: no member named.*accessory
// SPDX-License-Identifier: MIT
// Components that a model may not read: beyond the last one lies another number; an enumerator of another kind would
// read the wrong one; and accessories that are outputs are hidden.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct model {
#ifdef CASE_shared_integer_read_by_an_unnamed_enumeration_of_states
    enum { x, n_state };
#else
    enum state { x, n_state };
#endif
    enum parameter { k, n_parameter };
    enum shared { f, n_shared };
    enum shared_integer { mode, n_shared_integer };
    enum accessory { c, n_accessory };
    enum integer_accessory { count, n_integer_accessory };
    enum event { crossing, n_event };
    static constexpr bool accessories_are_outputs = true;

    template <class R>
    MYRIAD_FUNCTION static R rate(const myriad::vec<R, n_state>& y, const auto& p) {
#if defined CASE_state_beyond_the_last_one
        return y[7] + p[k];
#elif defined CASE_state_by_the_count_of_states
        return y[n_state] + p[k];
#elif defined CASE_parameter_beyond_the_last_one
        return y[x] + p[1];
#elif defined CASE_shared_value_beyond_the_last_one
        return y[x] + p.shared[n_shared];
#elif defined CASE_parameter_read_by_a_state
        return y[x] + p[x];
#elif defined CASE_shared_value_read_by_a_parameter
        return y[x] + p.shared[k];
#elif defined CASE_shared_integer_read_by_an_unnamed_enumeration_of_states
        return y[x] + R(myriad::real_of<R>(p.shared_integer[x]));
#elif defined CASE_accessory_read_by_rhs_that_declares_them_outputs
        return y[x] + p.accessory[c];
#elif defined CASE_integer_accessory_read_by_rhs_that_declares_them_outputs
        return myriad::select(p.integer_accessory[count] == 1, R(0), y[x]);
#else
        return y[x] + p[k];
#endif
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return myriad::vec<R, n_state>{rate(y, p)};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto& p) {
#ifdef CASE_accessory_read_by_events_that_declare_them_outputs
        return myriad::vec<R, n_event>{y[x] - p.accessory[c]};
#else
        return myriad::vec<R, n_event>{y[x] - p[k]};
#endif
    }
#ifdef CASE_accessory_beyond_the_last_one
    MYRIAD_FUNCTION static void finalise(auto& lane) { lane.accessory[3] = lane.y[x]; }
#endif
};

MYRIAD_INSTANTIATE(model, myriad::runge_kutta_4)
