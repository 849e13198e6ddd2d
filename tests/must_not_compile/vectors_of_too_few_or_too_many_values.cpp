// case: rhs_with_fewer_values_than_states
// expect: a vec is given as many values as it has components
// case: rhs_with_more_values_than_states
// expect: a vec is given as many values as it has components
// case: rhs_with_one_value_for_three_states
// expect: a vec is given as many values as it has components
// case: events_with_fewer_values_than_events
// expect: a vec is given as many values as it has components
// case: jacobian_row_with_fewer_values_than_states
// expect: a vec is given as many values as it has components
// case: jacobian_of_the_wrong_shape
// expect: jacobian has a wrong signature: it must be
// SPDX-License-Identifier: MIT
// A missing value would be zero, and an extra one has no component.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct model {
    enum state { x, v, w, n_state };
    enum event { first, second, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
#if defined CASE_rhs_with_fewer_values_than_states
        return {y[v], -y[x]};
#elif defined CASE_rhs_with_more_values_than_states
        return {y[v], -y[x], y[w], y[x]};
#elif defined CASE_rhs_with_one_value_for_three_states
        return {y[v]};
#else
        return {y[v], -y[x], y[w]};
#endif
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto&) {
#ifdef CASE_events_with_fewer_values_than_events
        return {y[x]};
#else
        return {y[x], y[v]};
#endif
    }
#ifdef CASE_jacobian_of_the_wrong_shape
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<myriad::vec<R, n_state>, 4> jacobian(auto, const myriad::vec<R, n_state>&,
                                                                            const auto&) {
        return {};
    }
#else
    template <class R>
    MYRIAD_FUNCTION static myriad::matrix<R, n_state> jacobian(auto, const myriad::vec<R, n_state>&, const auto&) {
#ifdef CASE_jacobian_row_with_fewer_values_than_states
        return {{R(0), R(1), R(0)}, {R(-1), R(0)}, {R(0), R(0), R(1)}};
#else
        return {{R(0), R(1), R(0)}, {R(-1), R(0), R(0)}, {R(0), R(0), R(1)}};
#endif
    }
#endif
};

MYRIAD_INSTANTIATE(model, myriad::rodas_5p)
