// SPDX-License-Identifier: MIT
// How heavy right-hand sides are, and that a step has the same bits whether it calls or contains them.
#include "myriad/kernel/model/rhs_weight.hpp"

#include "myriad/kernel/scalar/pack.hpp"
#include "myriad/kernel/stepper/explicit_rk.hpp"
#include "myriad/methods.hpp"
#include "myriad/tangent.hpp"
#include "problems/duffing.hpp"
#include "problems/hodgkin_huxley.hpp"
#include "problems/kuramoto.hpp"
#include "problems/lorenz.hpp"
#include "problems/van_der_pol_ring.hpp"
#include "tests/catch.hpp"

namespace {

using myriad::vec;
using myriad::detail::calls_rhs;
using myriad::detail::rhs_weight;
using problems::hodgkin_huxley;

struct counted {
    enum state { a, b, n_state };
    enum parameter { k, n_parameter };
    template <class R>
    MYRIAD_FUNCTION static vec<R, n_state> rhs(auto t, const vec<R, n_state>& y, const auto& p) {
        const R fixed = p[k] * p[k] + myriad::exp(p[k]);             // of inputs alone: none
        return {fixed * y[a] + myriad::sin(y[b]),                    // 1 + 15 + 1
                -y[a] / y[b] - myriad::pow(t, R(2)) + R(3) * R(2)};  // 1 + 8 + 40 + 1 + 1
    }
};
struct branching {
    enum state { a, n_state };
    static constexpr bool scalar_only = true;
    template <class R>
    MYRIAD_FUNCTION static vec<R, n_state> rhs(auto, const vec<R, n_state>& y, const auto&) {
        if (y[a] > R(1)) return {R(0)};
        return {myriad::exp(y[a])};
    }
};
struct declared : branching {
    static constexpr int rhs_weight = 1000;
};
struct contained : hodgkin_huxley {
    static constexpr bool large_rhs = false;
};

TEST_CASE("the weight of a right-hand side is what is computed from the state and the time") {
    CHECK(rhs_weight<counted> == 68);
    CHECK(rhs_weight<problems::kuramoto<8>> > 8 * 30);
    CHECK(rhs_weight<branching> == 0);  // what looks at values cannot be counted
    CHECK(rhs_weight<declared> == 1000);
    CHECK(rhs_weight<myriad::with_tangents<counted, 2>> == 3 * 68);
}

TEST_CASE("a heavy right-hand side is called, a light one stands in every stage") {
    CHECK(calls_rhs<hodgkin_huxley, double>);
    CHECK(calls_rhs<declared, double>);
    CHECK_FALSE(calls_rhs<contained, double>);
    CHECK_FALSE(calls_rhs<branching, double>);
    CHECK_FALSE(calls_rhs<problems::lorenz, double>);
    CHECK_FALSE(calls_rhs<problems::van_der_pol_ring<8>, double>);
}

template <class Model, class S>
vec<S, 4> state_after_a_step() {
    using R = myriad::real_of<S>;
    const S t(R(0)), h(R(0.05));
    myriad::inputs<Model, S> p{};
    p.parameter[0] = S(R(7.5));
    const vec<S, 4> start{S(R(-60)), S(R(0.06)), S(R(0.55)), S(R(0.33))};
    myriad::detail::trial_step<myriad::dormand_prince_5, S, 4> trial;
    trial.k[0] = myriad::detail::evaluate_rhs<Model>(t, start, p);
    myriad::detail::explicit_rk_step<myriad::dormand_prince_5, Model>(t, h, t + h, start, p, trial);
    return trial.y;
}

#if defined(MYRIAD_STRICT)  // else the compiler may contract the copies differently
TEMPLATE_TEST_CASE("a step that calls a heavy right-hand side has the bits of one that contains it", "", double, float,
                   (myriad::pack<double, 1>), (myriad::pack<double, 2>), (myriad::pack<float, 1>)) {
    const auto called = state_after_a_step<hodgkin_huxley, TestType>();
    const auto copied = state_after_a_step<contained, TestType>();
    for (int c = 0; c < hodgkin_huxley::n_state; ++c)
        for (int i = 0; i < myriad::lanes_of<TestType>; ++i)
            CHECK(myriad::detail::get_lane(called[c], i) == myriad::detail::get_lane(copied[c], i));
}
#endif

}  // namespace
