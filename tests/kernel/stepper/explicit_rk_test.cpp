// SPDX-License-Identifier: MIT
// Single steps of given length: local order of the solutions, of the error estimates and of the interpolants, and that
// a step follows the textbook formulas. A model file: compiled like kernels, without Eigen.
#include "myriad/kernel/stepper/explicit_rk.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "myriad/kernel/stepper/dense_output.hpp"
#include "myriad/methods.hpp"
#include "tests/catch.hpp"
#include "tests/kernel/stepper/local_order.hpp"
#include "tests/support/problems.hpp"
#include "tests/support/textbook.hpp"

namespace {

struct large_circle : problems::timed_circle {
    static constexpr bool large_rhs = true;
};

using local_order::check_local_order;
using local_order::mean_error;
using myriad::cash_karp;
using myriad::dormand_prince_5;
using myriad::dormand_prince_8;
using myriad::runge_kutta_4;
using myriad::tsitouras_5;
using myriad::verner_7;
using myriad::verner_9;

template <class R>
constexpr R eps = std::numeric_limits<R>::epsilon();

/// One step of a problem from its exact solution, with all its results.
template <class Method, class Model, class R = double>
struct single_step {
    static constexpr int n = Model::n_state;
    using state = myriad::vec<R, n>;

    R t, h;
    state start;
    myriad::detail::trial_step<Method, R, n> trial;
    state slope_end;

    single_step(R from, R length) : t(from), h(length), start(Model::exact(from)) {
        const myriad::inputs<Model, R> p{};
        trial.k[0] = myriad::detail::evaluate_rhs<Model>(t, start, p);
        myriad::detail::explicit_rk_step<Method, Model>(t, h, t + h, start, p, trial);
        slope_end = myriad::detail::evaluate_rhs<Model>(t + h, trial.y, p);
    }
    state at(R theta) const {
        myriad::detail::step_data<Method, R, n> step{t, h, start, trial, slope_end, {}};
        myriad::detail::complete_interpolant<Model>(step, myriad::inputs<Model, R>{});
        return myriad::detail::interpolate(step, theta);
    }
    template <int row = myriad::detail::row_of<Method>::error>
    R estimate(int c) const {
        if constexpr (Method::embedded_order > 0) {
            return myriad::detail::error_factor<Method, row>(h) * myriad::detail::error_sum<Method, row>(trial, c);
        } else {
            return 0;
        }
    }
};

template <int n>
myriad::vec<double, n> difference(const myriad::vec<double, n>& a, const myriad::vec<double, n>& b) {
    myriad::vec<double, n> d;
    for (int c = 0; c < n; ++c) d[c] = a[c] - b[c];
    return d;
}

// Errors of one step from the exact solution
// ----------------------------------------------------------------------------

template <class Method, class Model>
auto solution_error(double t, double h) {
    const single_step<Method, Model> step(t, h);
    return difference(step.trial.y, Model::exact(t + h));
}
template <class Method, class Model>
auto embedded_error(double t, double h) {
    const single_step<Method, Model> step(t, h);
    auto embedded = step.trial.y;
    for (int c = 0; c < step.n; ++c) embedded[c] -= step.estimate(c);
    return difference(embedded, Model::exact(t + h));
}
template <class Method, class Model, int row = myriad::detail::row_of<Method>::error>
auto estimated_error(double t, double h) {
    const single_step<Method, Model> step(t, h);
    typename single_step<Method, Model>::state estimate;
    for (int c = 0; c < step.n; ++c) estimate[c] = step.template estimate<row>(c);
    return estimate;
}
template <class Method, class Model>
auto interpolation_error(double theta) {
    return [theta](double t, double h) {
        const single_step<Method, Model> step(t, h);
        return difference(step.at(theta), Model::exact(t + theta * h));
    };
}

/// For errors whose leading coefficient is so small that rounding dominates first: they decrease at least like h^order.
template <class Error>
void check_least_local_order(Error error, int order, double first_h, int halvings = 3) {
    mean_error coarse(error, order, first_h);
    for (int i = 1; i <= halvings; ++i) {
        const mean_error fine(error, order, first_h / (1 << i));
        CAPTURE(first_h, i, fine.whole);
        REQUIRE(fine.whole > 10 * eps<double>);
        CHECK(std::log2(coarse.whole / fine.whole) > order - 0.3);
        coarse = fine;
    }
}

template <class Method>
void check_solution_order(int order, double first_h, double window = 0.1) {
    check_local_order(solution_error<Method, problems::log_circle>, order, first_h, window);
    check_local_order(solution_error<Method, problems::timed_circle>, order, first_h / 4, window);
}
template <class Method>
void check_embedded_order(int order, double first_h = 0.25) {
    check_local_order(embedded_error<Method, problems::log_circle>, order, first_h);
    check_local_order(embedded_error<Method, problems::timed_circle>, order, first_h / 4);
}
template <class Method, int row = myriad::detail::row_of<Method>::error>
void check_estimate_order(int order, double first_h = 0.25) {
    check_local_order(estimated_error<Method, problems::log_circle, row>, order, first_h);
    check_local_order(estimated_error<Method, problems::timed_circle, row>, order, first_h / 4);
}
template <class Method>
void check_interpolant_order(int order, double first_h, double window = 0.1) {
    for (const double theta : {0.3, 0.5, 0.9}) {
        CAPTURE(theta);
        check_local_order(interpolation_error<Method, problems::log_circle>(theta), order, first_h, window);
        check_local_order(interpolation_error<Method, problems::timed_circle>(theta), order, first_h / 4, window);
    }
}

template <class Method, class Model>
void check_textbook(double t, double h) {
    const single_step<Method, Model> step(t, h);
    const textbook::step<Method, Model> book(t, h, Model::exact(t));
    for (int c = 0; c < step.n; ++c) {
        CAPTURE(c, step.trial.y[c], step.estimate(c));
        // Every stage rounds its argument, its slope and its share of the sum a few times, each by half an ulp of the
        // terms in `size`; the problems' slopes pass this on with a factor times h below one.
        const double bound = 4 * Method::stages * eps<double> * book.size[c];
        CHECK(std::abs(step.trial.y[c] - book.y[c]) <= bound);
        CHECK(std::abs(step.estimate(c) - book.estimate[c]) <= bound);
    }
}

template <class Method>
void check_ends() {
    const single_step<Method, problems::timed_circle> step(0.7, 0.125);
    const auto begin = step.at(0.0), end = step.at(1.0);
    for (int c = 0; c < step.n; ++c) {
        // The Hermite polynomial: a rounded difference is added to y. The method's own: four coefficients per stage
        // that cancel, each rounded, as is every sum of them.
        double terms = std::abs(step.trial.y[c] - step.start[c]);
        if constexpr (myriad::detail::has_own_interpolant<Method>) {
            for (int i = 0; i < myriad::detail::interpolant_stages<Method>; ++i) {
                // the slopes of further stages are of the size of the one at the end
                const double slope = i < Method::stages ? step.trial.k[i][c] : 2 * step.slope_end[c];
                for (int power = 0; power < Method::interpolant_degree; ++power)
                    terms += 4 * std::abs(Method::interpolant_weight(i, power) * step.h * slope);
            }
        }
        CAPTURE(c, terms);
        CHECK(begin[c] == step.start[c]);
        CHECK(std::abs(end[c] - step.trial.y[c]) <= eps<double> * (std::abs(step.trial.y[c]) + terms));
    }
}

/// Slopes of the interpolant at both ends, from the polynomial of degree four through five of its points (exact but for
/// rounding, which the differences magnify by 48 / h).
template <class Method>
void check_end_slopes() {
    const single_step<Method, problems::timed_circle> step(0.7, 0.125);
    const auto p0 = step.at(0.0), p1 = step.at(0.25), p2 = step.at(0.5), p3 = step.at(0.75), p4 = step.at(1.0);
    for (int c = 0; c < step.n; ++c) {
        const double begin = (-25 * p0[c] + 48 * p1[c] - 36 * p2[c] + 16 * p3[c] - 3 * p4[c]) / (3 * step.h);
        const double end = (25 * p4[c] - 48 * p3[c] + 36 * p2[c] - 16 * p1[c] + 3 * p0[c]) / (3 * step.h);
        const double bound = 128 / 3.0 * 10 * eps<double> * std::abs(p0[c]) / step.h;
        CHECK(std::abs(begin - step.trial.k[0][c]) <= bound);
        CHECK(std::abs(end - step.slope_end[c]) <= bound);
    }
}

template <class Method, int degree>
double quadrature_error() {
    const single_step<Method, problems::monomial<degree>> step(0.5, 1.0);
    return std::abs(step.trial.y[0] / problems::monomial<degree>::exact(1.5)[0] - 1);
}

template <class Method>
void check_float_step() {
    const single_step<Method, problems::log_circle, float> narrow(0.25f, 0.125f);
    const single_step<Method, problems::log_circle, double> wide(0.25, 0.125);
    for (int c = 0; c < wide.n; ++c) {
        CAPTURE(c);
        // state and slopes are of size one to three, the stages at most seven
        CHECK(std::abs(static_cast<double>(narrow.trial.y[c]) - wide.trial.y[c]) <=
              8 * static_cast<double>(eps<float>));
        // the estimate is a difference of slopes of that size, times h
        CHECK(std::abs(static_cast<double>(narrow.estimate(c)) - wide.estimate(c)) <= static_cast<double>(eps<float>));
    }
}

}  // namespace

TEST_CASE("a step of runge_kutta_4 has a local error of order five") { check_solution_order<runge_kutta_4>(5, 0.125); }
TEST_CASE("a step of cash_karp has a local error of order six") { check_solution_order<cash_karp>(6, 0.25); }
TEST_CASE("a step of tsitouras_5 has a local error of order six") { check_solution_order<tsitouras_5>(6, 0.25); }

TEST_CASE("a step of dormand_prince_5 has a local error of order six") {
    check_solution_order<dormand_prince_5>(6, 0.25);
}
// Its error coefficients of order eight are below 1e-5: the next term, of order nine, dominates until rounding does.
TEST_CASE("a step of verner_7 has a local error of order eight at least") {
    check_least_local_order(solution_error<verner_7, problems::log_circle>, 8, 1);
    check_least_local_order(solution_error<verner_7, problems::timed_circle>, 8, 0.125);
}
TEST_CASE("a step of dormand_prince_8 has a local error of order nine") {
    check_solution_order<dormand_prince_8>(9, 1, 0.15);
}
TEST_CASE("a step of verner_9 has a local error of order ten at least") {
    check_least_local_order(solution_error<verner_9, problems::log_circle>, 10, 1, 2);
    check_least_local_order(solution_error<verner_9, problems::timed_circle>, 10, 0.25, 2);
}

TEST_CASE("the embedded solution of cash_karp has a local error of order five") { check_embedded_order<cash_karp>(5); }
TEST_CASE("the embedded solution of tsitouras_5 has a local error of order five") {
    check_embedded_order<tsitouras_5>(5);
}
TEST_CASE("the embedded solution of dormand_prince_5 has a local error of order five") {
    check_embedded_order<dormand_prince_5>(5);
}
TEST_CASE("the embedded solution of verner_7 has a local error of order seven") {
    check_embedded_order<verner_7>(7, 0.5);
}
TEST_CASE("the embedded solution of dormand_prince_8 has a local error of order six") {
    check_embedded_order<dormand_prince_8>(6);
}
TEST_CASE("the embedded solution of verner_9 has a local error of order nine") { check_embedded_order<verner_9>(9, 1); }

TEST_CASE("the error estimate of cash_karp has order five") { check_estimate_order<cash_karp>(5); }
TEST_CASE("the error estimate of tsitouras_5 has order five") { check_estimate_order<tsitouras_5>(5); }
TEST_CASE("the error estimate of dormand_prince_5 has order five") { check_estimate_order<dormand_prince_5>(5); }
TEST_CASE("the error estimate of verner_7 has order seven") { check_estimate_order<verner_7>(7, 0.5); }
TEST_CASE("the error estimate of verner_9 has order nine") { check_estimate_order<verner_9>(9, 1); }
TEST_CASE("the error estimates of dormand_prince_8 have orders six and four") {
    check_estimate_order<dormand_prince_8>(6);
    check_estimate_order<dormand_prince_8, myriad::detail::row_of<dormand_prince_8>::coarse_error>(4);
}

TEST_CASE("the interpolant of runge_kutta_4 has a local error of order four") {
    check_interpolant_order<runge_kutta_4>(4, 0.125);
}
TEST_CASE("the interpolant of cash_karp has a local error of order four") {
    check_interpolant_order<cash_karp>(4, 0.125);
}
TEST_CASE("the interpolant of tsitouras_5 has a local error of order five") {
    check_interpolant_order<tsitouras_5>(5, 0.0625);
}
TEST_CASE("the interpolant of dormand_prince_5 has a local error of order five") {
    check_interpolant_order<dormand_prince_5>(5, 0.0625);
}
TEST_CASE("the interpolant of verner_7 has a local error of order seven at least") {
    for (const double theta : {0.3, 0.5, 0.9}) {
        check_least_local_order(interpolation_error<verner_7, problems::log_circle>(theta), 7, 1);
        check_least_local_order(interpolation_error<verner_7, problems::timed_circle>(theta), 7, 0.125);
    }
}
TEST_CASE("the interpolant of dormand_prince_8 has a local error of order eight") {
    check_interpolant_order<dormand_prince_8>(8, 1, 0.15);
}
TEST_CASE("the interpolant of verner_9 has a local error of order ten at least") {
    for (const double theta : {0.3, 0.5, 0.9}) {
        check_least_local_order(interpolation_error<verner_9, problems::log_circle>(theta), 10, 1, 2);
        check_least_local_order(interpolation_error<verner_9, problems::timed_circle>(theta), 10, 0.25, 2);
    }
}

TEST_CASE("the interpolant of runge_kutta_4 hits both ends of the step") { check_ends<runge_kutta_4>(); }
TEST_CASE("the interpolant of cash_karp hits both ends of the step") { check_ends<cash_karp>(); }
TEST_CASE("the interpolant of tsitouras_5 hits both ends of the step") { check_ends<tsitouras_5>(); }
TEST_CASE("the interpolant of dormand_prince_5 hits both ends of the step") { check_ends<dormand_prince_5>(); }
TEST_CASE("the interpolant of verner_7 hits both ends of the step") { check_ends<verner_7>(); }
TEST_CASE("the interpolant of dormand_prince_8 hits both ends of the step") { check_ends<dormand_prince_8>(); }
TEST_CASE("the interpolant of verner_9 hits both ends of the step") { check_ends<verner_9>(); }

TEST_CASE("the interpolant of runge_kutta_4 has the slopes of both ends of the step") {
    check_end_slopes<runge_kutta_4>();
}
TEST_CASE("the interpolant of cash_karp has the slopes of both ends of the step") { check_end_slopes<cash_karp>(); }
TEST_CASE("the interpolant of tsitouras_5 has the slopes of both ends of the step") { check_end_slopes<tsitouras_5>(); }

TEST_CASE("a step of runge_kutta_4 is the textbook's") {
    check_textbook<runge_kutta_4, problems::log_circle>(0.3, 0.25);
    check_textbook<runge_kutta_4, problems::timed_circle>(0.7, -0.125);
}
TEST_CASE("a step of cash_karp is the textbook's") {
    check_textbook<cash_karp, problems::log_circle>(0.3, 0.25);
    check_textbook<cash_karp, problems::timed_circle>(0.7, -0.125);
}
TEST_CASE("a step of tsitouras_5 is the textbook's") {
    check_textbook<tsitouras_5, problems::log_circle>(0.3, 0.25);
    check_textbook<tsitouras_5, problems::timed_circle>(0.7, -0.125);
}

TEST_CASE("a step of dormand_prince_5 is the textbook's") {
    check_textbook<dormand_prince_5, problems::log_circle>(0.3, 0.25);
    check_textbook<dormand_prince_5, problems::timed_circle>(0.7, -0.125);
}
TEST_CASE("a step of verner_7 is the textbook's") {
    check_textbook<verner_7, problems::log_circle>(0.3, 0.25);
    check_textbook<verner_7, problems::timed_circle>(0.7, -0.125);
}
TEST_CASE("a step of dormand_prince_8 is the textbook's") {
    check_textbook<dormand_prince_8, problems::log_circle>(0.3, 0.25);
    check_textbook<dormand_prince_8, problems::timed_circle>(0.7, -0.125);
}
TEST_CASE("a step of verner_9 is the textbook's") {
    check_textbook<verner_9, problems::log_circle>(0.3, 0.25);
    check_textbook<verner_9, problems::timed_circle>(0.7, -0.125);
}

TEST_CASE("the last slope of a tsitouras_5 step is the right-hand side at its end, bit for bit") {
    const single_step<tsitouras_5, problems::timed_circle> step(0.75, 0.125);  // times without rounding
    for (int c = 0; c < step.n; ++c) CHECK(step.trial.k[6][c] == step.slope_end[c]);
}

#if defined(MYRIAD_STRICT)  // else the compiler may contract the copies differently
TEST_CASE("a step that calls a large right-hand side has the bits of one that contains it") {
    const single_step<dormand_prince_8, problems::timed_circle> contains(0.75, 0.1);
    const single_step<dormand_prince_8, large_circle> calls(0.75, 0.1);
    for (int c = 0; c < calls.n; ++c) {
        CHECK(calls.trial.y[c] == contains.trial.y[c]);
        CHECK(calls.slope_end[c] == contains.slope_end[c]);
    }
}
#endif

TEST_CASE("runge_kutta_4 integrates cubic slopes exactly and quartic ones not") {
    CHECK(quadrature_error<runge_kutta_4, 4>() <= 4 * eps<double>);  // four stages, half an ulp each, and the result
    CHECK(quadrature_error<runge_kutta_4, 5>() > 1e-4);
}
TEST_CASE("cash_karp integrates quartic slopes exactly and quintic ones not") {
    CHECK(quadrature_error<cash_karp, 5>() <= 6 * eps<double>);
    CHECK(quadrature_error<cash_karp, 6>() > 1e-4);
}
TEST_CASE("tsitouras_5 integrates quartic slopes exactly and quintic ones not") {
    // weights of up to 3.3 that cancel: the rounding of the coefficients dominates
    CHECK(quadrature_error<tsitouras_5, 5>() <= 10 * eps<double>);
    CHECK(quadrature_error<tsitouras_5, 6>() > 1e-5);
}

TEST_CASE("a step of runge_kutta_4 in single precision is the step in double precision, rounded") {
    check_float_step<runge_kutta_4>();
}
TEST_CASE("a step of cash_karp in single precision is the step in double precision, rounded") {
    check_float_step<cash_karp>();
}
TEST_CASE("a step of tsitouras_5 in single precision is the step in double precision, rounded") {
    check_float_step<tsitouras_5>();
}
