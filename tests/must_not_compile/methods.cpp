// case: method_without_a_tableau
// expect: a method is a struct with `static constexpr` members
// case: method_with_another_number_of_stages
// expect: the tableau has not as many stages as the method says
// case: method_with_an_implicit_stage
// expect: matrix a must be lower triangular
// case: method_with_a_stage_without_weights
// expect: tableau has a stage without weights
// case: method_without_weights
// expect: tableau has no weights b
// case: adaptive_method_without_error_weights
// expect: the method has an embedded_order, but no error weights e
// case: method_without_error_weights
// expect: its error weights e are all zero
// case: stiff_method_without_error_weights
// expect: tableau has no error weights e
// case: method_of_lower_order_than_it_claims
// expect: do not satisfy the conditions of the order that it claims
// case: method_of_order_five_that_claims_six
// expect: do not satisfy the conditions of the order that it claims
// case: error_estimate_of_lower_order_than_claimed
// expect: has not the order that embedded_order claims
// case: method_that_wrongly_claims_first_same_as_last
// expect: claims first_same_as_last, but its last stage is not the slope at the new state
// case: stiff_method_that_wrongly_claims_first_same_as_last
// expect: claims first_same_as_last, but its last stage is not the slope at the new state
// case: interpolant_of_lower_order_than_it_claims
// expect: has not the order that interpolant_order claims
// case: interpolant_that_misses_the_new_state
// expect: the interpolant does not end at the step.s new state
// case: method_in_an_anonymous_namespace
// expect: the method is in an anonymous namespace.*move it out
// SPDX-License-Identifier: MIT
// Methods whose tableau contradicts their claims.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct decay {
    enum state { x, n_state };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_state>{-y[x]};
    }
};

#if defined CASE_method_without_a_tableau
struct wrong {
    static constexpr int stages = 1, order = 1;
};
#elif defined CASE_method_with_another_number_of_stages        // the last stage would never be computed
struct wrong : myriad::cash_karp {
    static constexpr int stages = 5;
};
#elif defined CASE_method_without_error_weights                // a method that chooses its steps needs an estimate
struct wrong : myriad::runge_kutta_4 {
    static constexpr int embedded_order = 3;
};
#elif defined CASE_stiff_method_without_error_weights          // it would accept every step
struct wrong : myriad::rosenbrock_23 {
    static constexpr auto tableau() {
        auto t = myriad::rosenbrock_23::tableau();
        t.e = {};
        return t;
    }
};
#elif defined CASE_method_of_lower_order_than_it_claims        // a digit of a coefficient is wrong: 41 for 40
struct wrong : myriad::cash_karp {
    static constexpr auto tableau() {
        auto t = myriad::cash_karp::tableau();
        t.a[2] = {3.0 / 40, 9.0 / 41};
        return t;
    }
};
#elif defined CASE_method_of_order_five_that_claims_six        // orders above five are checked too
struct wrong : myriad::tsitouras_5 {
    static constexpr int order = 6;
};
#elif defined CASE_error_estimate_of_lower_order_than_claimed  // steps would be chosen by a wrong power of the error
struct wrong : myriad::cash_karp {
    static constexpr int embedded_order = 5;
};
#elif defined CASE_method_that_wrongly_claims_first_same_as_last
// The new state would be the argument of the last stage, at seven eighths of the step: an error of 0.057 instead of
// 3e-8.
struct wrong : myriad::cash_karp {
    static constexpr bool first_same_as_last = true;
};
#elif defined CASE_stiff_method_that_wrongly_claims_first_same_as_last
struct wrong : myriad::rodas_5p {
    static constexpr bool first_same_as_last = true;
};
#elif defined CASE_interpolant_of_lower_order_than_it_claims  // its extra stage is computed at a wrong time
struct wrong : myriad::dormand_prince_8 {
    static constexpr double extra_node(int i) {
        return myriad::dormand_prince_8::extra_node(i) + (i == 1 ? 0.01 : 0.0);
    }
};
#elif defined \
    CASE_interpolant_that_misses_the_new_state       // samples and events would see a jump at the end of every step
struct wrong : myriad::dormand_prince_5 {
    static constexpr double interpolant_weight(int stage, int power) {
        return myriad::dormand_prince_5::interpolant_weight(stage, power) + (stage == 3 && power == 2 ? 0.001 : 0.0);
    }
};
#elif defined CASE_method_in_an_anonymous_namespace  // each file would have a method of its own with that name
namespace {
struct wrong : myriad::runge_kutta_4 {};
}  // namespace
#else
struct wrong {
    static constexpr int stages = 2, order = 2, embedded_order = 1;
    static constexpr bool first_same_as_last = false;
    static constexpr myriad::explicit_tableau<stages> tableau() {
        myriad::explicit_tableau<stages> t{};
        t.c = {0, 1};
#if defined CASE_method_with_an_implicit_stage           // a weight of a later stage would be left out
        t.a[1] = {0.5, 0.5};
#elif !defined CASE_method_with_a_stage_without_weights  // a stage would repeat the first one
        t.a[1] = {1};
#endif
#ifndef CASE_method_without_weights  // the solution would stay where it is
        t.b = {0.5, 0.5};
#endif
#ifndef CASE_adaptive_method_without_error_weights  // it would accept every step
        t.e = {-0.5, 0.5};
#endif
        return t;
    }
};
#endif

MYRIAD_INSTANTIATE(decay, wrong)
