// case: model_without_rhs
// expect: the model has no right-hand side: give it
// case: model_without_state
// expect: the model has no state: give it `enum state
// case: final_model
// expect: the model is declared final: its hooks cannot be found by name; remove
// case: private_rhs
// expect: rhs has a wrong signature: .* and public
// expect: private (within this context|member of)
// case: rhs_that_is_not_generic
// expect: rhs has a wrong signature: it must be
// case: rhs_that_is_not_static
// expect: rhs has a wrong signature: it must be
// case: rhs_without_time
// expect: rhs has a wrong signature: it must be
// case: rhs_with_a_result_of_the_wrong_size
// expect: rhs has a wrong signature: it must be
// case: rhs_with_the_inputs_before_the_states
// expect: the arguments of rhs are exchanged: they are the time, the states and the inputs, in this order
// case: rhs_with_a_single_state_before_the_time
// expect: the arguments of rhs are exchanged: they are the time, the states and the inputs, in this order
// case: rhs_with_a_single_state_first_and_the_time_last
// expect: the arguments of rhs are exchanged: they are the time, the states and the inputs, in this order
// case: rhs_with_the_inputs_before_the_states_of_any_type
// expect: a state is looked for among the inputs: the arguments of rhs, events and observe are the time, the states
// case: sine_of_the_standard_library
// expect: this model calls std::sin, .*: call myriad::sin
// case: power_of_the_standard_library
// expect: this model calls std::pow, .*: call myriad::pow
// case: maximum_of_the_standard_library
// expect: this model branches on its state: .*for std::min and std::max myriad::min and myriad::max
// case: branch_on_the_state
// expect: this model branches on its state: use myriad::select.*scalar_only
// case: conditional_expression_on_the_state
// expect: this model branches on its state: use myriad::select.*scalar_only
// SPDX-License-Identifier: MIT
// Right-hand sides that the loop cannot call, or not for a pack of instances, which has no single truth value.
// The first header is precompiled.
// clang-format off
#include <myriad/instantiate.hpp>
#include <algorithm>
#include <cmath>
#include "myriad/model.hpp"
// clang-format on

#ifdef CASE_final_model
#define FINAL final
#else
#define FINAL
#endif

struct decay FINAL {
#ifndef CASE_model_without_state
    enum state { x, n_state };
#endif
    enum parameter { k, n_parameter };

#ifdef CASE_private_rhs
private:
#endif
#if defined CASE_rhs_that_is_not_generic
    MYRIAD_FUNCTION static myriad::vec<double, 1> rhs(double, const myriad::vec<double, 1>& y, const auto& p) {
        return myriad::vec<double, 1>{-(p[k] * y[0])};
    }
#elif defined CASE_rhs_that_is_not_static
    template <class R>
    MYRIAD_FUNCTION myriad::vec<R, 1> rhs(auto, const myriad::vec<R, 1>& y, const auto& p) {
        return myriad::vec<R, 1>{-(p[k] * y[0])};
    }
#elif defined CASE_rhs_without_time
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> rhs(const myriad::vec<R, 1>& y, const auto& p) {
        return myriad::vec<R, 1>{-(p[k] * y[0])};
    }
#elif defined CASE_rhs_with_a_result_of_the_wrong_size
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 2> rhs(auto, const myriad::vec<R, 1>& y, const auto& p) {
        return myriad::vec<R, 2>{-(p[k] * y[0]), y[0]};
    }
#elif defined CASE_rhs_with_the_inputs_before_the_states
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> rhs(auto, const auto& p, const myriad::vec<R, 1>& y) {
        return myriad::vec<R, 1>{-(p[k] * y[x])};
    }
#elif defined CASE_rhs_with_a_single_state_before_the_time
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> rhs(const myriad::vec<R, 1>& y, auto, const auto& p) {
        return myriad::vec<R, 1>{-(p[k] * y[x])};
    }
#elif defined CASE_rhs_with_a_single_state_first_and_the_time_last
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> rhs(myriad::vec<R, 1> y, const auto& p, auto) {
        return myriad::vec<R, 1>{-(p[k] * y[x])};
    }
#elif defined CASE_rhs_with_the_inputs_before_the_states_of_any_type
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> rhs(auto, const auto& p, const auto& y) {
        return myriad::vec<R, 1>{-(p[k] * y[x])};
    }
#elif !defined CASE_model_without_rhs
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> rhs(auto, const myriad::vec<R, 1>& y, const auto& p) {
#ifdef CASE_branch_on_the_state
        if (y[0] < R(0)) return myriad::vec<R, 1>{R(0)};
#endif
#ifdef CASE_conditional_expression_on_the_state
        return myriad::vec<R, 1>{y[0] > R(0) ? -(p[k] * y[0]) : R(0)};
#endif
#ifdef CASE_sine_of_the_standard_library
        return myriad::vec<R, 1>{std::sin(y[0])};
#endif
#ifdef CASE_power_of_the_standard_library
        return myriad::vec<R, 1>{std::pow(y[0], 2)};
#endif
#ifdef CASE_maximum_of_the_standard_library
        return myriad::vec<R, 1>{std::max(y[0], R(1))};
#endif
        return myriad::vec<R, 1>{-(p[k] * y[0])};
    }
#endif
};

MYRIAD_INSTANTIATE(decay, myriad::runge_kutta_4)
