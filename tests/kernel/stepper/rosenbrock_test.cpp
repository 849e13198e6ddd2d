// SPDX-License-Identifier: MIT
// Rosenbrock methods: order conditions of the tableaux, and for single steps of given length the local order of the
// solutions, of the error estimates and of the interpolants. A model file: compiled like kernels, without Eigen.
#include "myriad/kernel/stepper/rosenbrock.hpp"

#include <cmath>
#include <limits>

#include "myriad/kernel/stepper/dense_output.hpp"
#include "myriad/methods.hpp"
#include "tests/catch.hpp"
#include "tests/kernel/stepper/local_order.hpp"
#include "tests/support/problems.hpp"

namespace {

using local_order::check_local_order;
using myriad::embedded_weights;
using myriad::rodas_5p;
using myriad::rosenbrock_23;
using myriad::satisfies_order_conditions;

/// One step of a problem from its exact solution, with all its results.
template <class Method, class Model>
struct single_step {
    static constexpr int n = Model::n_state;
    using state = myriad::vec<double, n>;

    double t, h;
    state start;
    myriad::detail::trial_step<Method, double, n> trial;

    single_step(double from, double length) : t(from), h(length), start(Model::exact(from)) {
        const myriad::inputs<Model, double> p{};
        trial.k[0] = myriad::detail::evaluate_rhs<Model>(t, start, p);
        myriad::detail::take_trial_step<Method, Model>(t, h, t + h, start, p, trial);
    }
    state at(double theta) const {
        const myriad::detail::step_data<Method, double, n> step{t, h, start, trial, {}, {}};
        return myriad::detail::interpolate(step, theta);
    }
    state estimate() const {
        state e;
        for (int c = 0; c < n; ++c)
            e[c] = myriad::detail::error_factor<Method>(h) * myriad::detail::error_sum<Method>(trial, c);
        return e;
    }
};

template <int n>
myriad::vec<double, n> difference(myriad::vec<double, n> a, const myriad::vec<double, n>& b) {
    for (int c = 0; c < n; ++c) a[c] -= b[c];
    return a;
}

// The circle at the speed of a clock and, so that the derivative by time counts too, at one that grows with it
// ------------

template <class Method, class Model>
void check_orders_on(double first_h) {
    using step = single_step<Method, Model>;
    {
        INFO("solution");
        check_local_order([](double t, double h) { return difference(step(t, h).trial.y, Model::exact(t + h)); },
                          Method::order + 1, first_h);
    }
    {
        INFO("error estimate");
        check_local_order([](double t, double h) { return step(t, h).estimate(); }, Method::embedded_order + 1,
                          first_h);
    }
    {
        INFO("embedded solution");  // the solution minus its error estimate; of order three for rosenbrock_23
        const int order = Method::order == 2 ? 3 : 4;
        check_local_order(
            [](double t, double h) {
                const step s(t, h);
                return difference(difference(s.trial.y, s.estimate()), Model::exact(t + h));
            },
            order + 1, first_h);
    }
    for (const double theta :
         {0.3, 0.5, 0.7}) {  // closer to the end the error of the solution dominates until h is small
        INFO("interpolant at " << theta);
        check_local_order(
            [theta](double t, double h) { return difference(step(t, h).at(theta), Model::exact(t + theta * h)); },
            Method::interpolant_order + 1, first_h);
    }
}

template <class Method>
void check_ends() {
    const single_step<Method, problems::timed_circle> step(0.7, 0.125);
    const auto begin = step.at(0.0), end = step.at(1.0);
    for (int c = 0; c < step.n; ++c) {
        CHECK(begin[c] == step.start[c]);
        // y + (y1 - y), rounded twice
        CHECK(std::abs(end[c] - step.trial.y[c]) <=
              std::numeric_limits<double>::epsilon() * std::abs(step.trial.y[c]) * 2);
    }
}

template <class Method>
void check_wrong_coefficients() {
    const auto t = Method::tableau();
    const int order = Method::order;
    for (std::size_t i = 1; i < t.c.size(); ++i) {
        auto wrong = t;
        wrong.c[i] += 1e-9;
        CHECK_FALSE(satisfies_order_conditions(wrong, t.m, order));
        wrong = t;
        wrong.d[i] += 1e-9;
        CHECK_FALSE(satisfies_order_conditions(wrong, t.m, order));
        wrong = t;
        wrong.coupling[i][0] += 1e-9;
        CHECK_FALSE(satisfies_order_conditions(wrong, t.m, order));
        wrong = t;
        wrong.a[i][0] += 1e-9;
        CHECK_FALSE(satisfies_order_conditions(wrong, t.m, order));
    }
}

}  // namespace

TEST_CASE("the tableau of rosenbrock_23 has orders two and three and no higher") {
    const auto t = rosenbrock_23::tableau();
    CHECK(satisfies_order_conditions(t, t.m, 2));
    CHECK(satisfies_order_conditions(t, embedded_weights(t), 3));
    CHECK_FALSE(satisfies_order_conditions(t, t.m, 3));
    CHECK_FALSE(satisfies_order_conditions(t, embedded_weights(t), 4));
}
TEST_CASE("the tableau of rodas_5p has orders five and four, and the embedded one no higher") {
    const auto t = rodas_5p::tableau();
    CHECK(satisfies_order_conditions(t, t.m, 5));
    CHECK(satisfies_order_conditions(t, embedded_weights(t), 4));
    CHECK_FALSE(satisfies_order_conditions(t, embedded_weights(t), 5));
}
TEST_CASE("a wrong coefficient of a Rosenbrock tableau does not pass its order conditions") {
    check_wrong_coefficients<rosenbrock_23>();
    check_wrong_coefficients<rodas_5p>();
}

TEST_CASE("a step of rosenbrock_23 has the orders of its solutions, of its estimate and of its interpolant") {
    check_orders_on<rosenbrock_23, problems::log_circle>(1.0 / 32);
    check_orders_on<rosenbrock_23, problems::timed_circle>(1.0 / 128);
}
TEST_CASE("a step of rodas_5p has the orders of its solutions, of its estimate and of its interpolant") {
    check_orders_on<rodas_5p, problems::log_circle>(1.0 / 8);
    check_orders_on<rodas_5p, problems::timed_circle>(1.0 / 32);
}

TEST_CASE("the interpolants of Rosenbrock methods pass through both ends of the step") {
    check_ends<rosenbrock_23>();
    check_ends<rodas_5p>();
}

TEST_CASE("the last stage of rosenbrock_23 is the slope at the end of the step") {
    const single_step<rosenbrock_23, problems::timed_circle> step(0.7, 0.125);
    const myriad::inputs<problems::timed_circle, double> p{};
    const auto slope = myriad::detail::evaluate_rhs<problems::timed_circle>(0.7 + 0.125, step.trial.y, p);
    for (int c = 0; c < step.n; ++c) CHECK(step.trial.slope_end()[c] == slope[c]);
}
