// SPDX-License-Identifier: MIT
// Chosen step-size controls: the kernels' steps against a loop written from the formulas.
#include "tests/kernel/methods/controller_policies.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "myriad/myriad.hpp"
#include "tests/catch.hpp"
#include "tests/support/device.hpp"
#include "tests/support/problems.hpp"
#include "tests/support/textbook.hpp"

namespace {

using model = problems::van_der_pol;
using state = myriad::vec<double, 2>;

constexpr double t_end = 6, first_step = 0.02, tolerance = 1e-7;
const state start{2.0, 0.0};

struct trajectory {
    std::vector<double> t;  // ends of accepted steps
    state end;
    std::int64_t rejected;
};

template <class Method>
trajectory run(double step) {
    myriad::ensemble<model> e(3);
    for (int c = 0; c < 2; ++c) e.state(c) = start[c];
    e.time_domain(0, t_end);
    myriad::options o;
    o.relative_tolerance = o.absolute_tolerance = tolerance;
    o.step = step;
    o.samples = {.states = {0}, .capacity = 2000, .every = 1};
    myriad::solve<Method>(tests::test_device(1), e, o);
    REQUIRE(e.status(1) == myriad::status::success);
    trajectory result{{}, {e.state(0)[1], e.state(1)[1]}, e.rejected_steps()[1]};
    for (int k = 1; k < e.samples().stored()[1]; ++k) result.t.push_back(e.samples().time()(1, k));
    return result;
}

double largest(double a, double b) { return std::max(a, b); }
double root_mean_square(double a, double b) { return std::sqrt((a * a + b * b) / 2); }
double larger_scale(double y) { return std::max(tolerance, tolerance * y); }
double mixed_scale(double y) { return tolerance + tolerance * y; }

/// The loop of the textbooks, for a method whose error estimate is of order four.
struct rule {
    double now, last, before;  // exponents of the errors, times five
    double (*norm)(double, double) = largest;
    double (*scale)(double) = larger_scale;

    template <class Method>
    trajectory follow() const {
        trajectory path{{}, start, 0};
        double t = 0, h = first_step, q1 = 1, q2 = 1;
        while (t < t_end) {
            const bool final = t_end - t <= 1.001 * h;
            const double length = final ? t_end - t : h;
            const textbook::step<Method, model> step(t, length, path.end);
            const auto ratio = [&](int c) {
                return std::abs(step.estimate[c]) / scale(std::max(std::abs(path.end[c]), std::abs(step.y[c])));
            };
            const double q = norm(ratio(0), ratio(1));
            const double factor = q <= 1 ? std::pow(q, -now / 5) * std::pow(q1, -last / 5) * std::pow(q2, -before / 5)
                                         : std::pow(q, -0.25);
            h = length * std::clamp(0.9 * factor, 0.1, 5.0);
            if (q > 1) {
                ++path.rejected;
                continue;
            }
            q2 = q1;
            q1 = std::max(q, 1e-4);
            t = final ? t_end : t + length;
            path.t.push_back(t);
            path.end = {step.y[0], step.y[1]};
        }
        return path;
    }
};

/// The kernels' powers are accurate to 2e-5 where three of them are multiplied, and an error in a step changes the
/// error that the next step size follows five times as much. A rejection at the limit would separate the two for good:
/// the numbers of rejections must agree, and every step within 0.2 %.
template <class Method, class Plain>
void check(const rule& r) {
    const trajectory expected = r.follow<Plain>(), found = run<Method>(first_step);
    REQUIRE(found.t.size() == expected.t.size());
    CHECK(found.rejected == expected.rejected);
    double worst = 0;
    for (std::size_t k = 0; k < found.t.size(); ++k) {
        const double before = k == 0 ? 0 : expected.t[k - 1], found_before = k == 0 ? 0 : found.t[k - 1];
        worst = std::max(worst, std::abs((found.t[k] - found_before) / (expected.t[k] - before) - 1));
    }
    CAPTURE(expected.t.size(), expected.rejected);
    CHECK(worst <= 2e-3);
}

}  // namespace

TEST_CASE("pi_control takes the steps of its formula") { check<choices::pi, myriad::cash_karp>({0.7, -0.4, 0}); }
TEST_CASE("pid_control, rms_norm and mixed_scale take the steps of their formulas") {
    check<choices::pid, myriad::cash_karp>({0.58, -0.21, 0.1, root_mean_square, mixed_scale});
}
TEST_CASE("rms_norm takes the steps of its formula") {
    check<choices::averaged, myriad::dormand_prince_5>({1, 0, 0, root_mean_square});
}

TEST_CASE("the controls differ where they should") {
    // or the tests above could not fail
    const auto elementary = rule{1, 0, 0}.follow<myriad::cash_karp>(),
               pi = rule{0.7, -0.4, 0}.follow<myriad::cash_karp>();
    CHECK(elementary.t.size() != pi.t.size());
    CHECK(rule{1, 0, 0, root_mean_square}.follow<myriad::cash_karp>().t.size() != elementary.t.size());
    CHECK(rule{1, 0, 0, largest, mixed_scale}.follow<myriad::cash_karp>().t.size() != elementary.t.size());
}

TEST_CASE("automatic_first_step takes the step of its formula where none is given, and the given one else") {
    // Hairer, Norsett, Wanner, Solving ODE I, II.4, with the largest component for the norm
    const auto rhs = [](const state& y) { return model::rhs<double>(0.0, y, 0); };
    const auto size = [](const state& x) {
        double d = 0;
        for (int c = 0; c < 2; ++c) d = std::max(d, std::abs(x[c]) / (tolerance + tolerance * std::abs(start[c])));
        return d;
    };
    const state f0 = rhs(start);
    const double h0 = 0.01 * size(start) / size(f0);
    const state f1 = rhs({start[0] + h0 * f0[0], start[1] + h0 * f0[1]});
    const double d2 = size({f1[0] - f0[0], f1[1] - f0[1]}) / h0;
    const double expected = std::min(100 * h0, std::pow(0.01 / std::max(size(f0), d2), 1.0 / 5));
    const trajectory automatic = run<choices::automatic>(std::nan(""));
    CHECK(std::abs(automatic.t[0] / expected - 1) <= 3e-5);
    CHECK(run<choices::automatic>(1e-3).t[0] == 1e-3);
}

TEST_CASE("automatic_first_step integrates from a state of rest, backwards, and within the limits of steps") {
    myriad::ensemble<model> e(1);
    myriad::options o;
    for (const double span : {1.0, -1.0}) {
        for (const double x : {0.0, 2.0}) {  // both derivatives are zero at rest
            e = myriad::ensemble<model>(1);
            e.state(0) = x;
            e.state(1) = 0.0;
            e.time_domain(0, span);
            myriad::solve<choices::automatic>(tests::test_device(1), e, o);
            CHECK(e.status(0) == myriad::status::success);
            CHECK(e.t()[0] == span);
        }
    }
    o.maximum_step = 1e-3;
    e = myriad::ensemble<model>(1);
    e.state(0) = 2.0;
    e.state(1) = 0.0;
    e.time_domain(0, 1);
    myriad::solve<choices::automatic>(tests::test_device(1), e, o);
    CHECK(e.accepted_steps()[0] >= 1000);
}

TEST_CASE("dormand_prince_8 with pi_control and automatic_first_step ends at the reference value") {
    // van der Pol, mu = 1, t = 20: in quadruple precision
    myriad::ensemble<model> e(1);
    e.state(0) = 2.0;
    e.state(1) = 0.0;
    e.time_domain(0, 20);
    myriad::options o;
    o.relative_tolerance = o.absolute_tolerance = 1e-11;
    myriad::solve<choices::high_order>(tests::test_device(1), e, o);
    // some 300 steps, each with an error below the tolerance; errors along the limit cycle grow by the ratio of its
    // speeds
    CHECK(std::abs(e.state(0)[0] - 2.0081497621749485920) <= 300 * 1e-11);
    CHECK(std::abs(e.state(1)[0] + 0.042508875273202146986) <= 300 * 1e-11);
}

TEST_CASE("with tolerance_per_instance each instance is integrated as by a call with its own tolerances") {
    using choices::plain;
    const auto prepare = [] {
        myriad::ensemble<model> e(5);
        for (int c = 0; c < 2; ++c) e.state(c) = start[c];
        e.time_domain(0, t_end);
        return e;
    };
    myriad::options o;
    o.relative_tolerance = o.absolute_tolerance = 0x1p-30;
    auto own = prepare();
    for (std::int64_t i = 0; i < own.size(); ++i)
        own.tolerance_scale()[i] = std::ldexp(1.0, static_cast<int>(4 * i) - 8);
    const auto report = myriad::solve<choices::scaled>(tests::test_device(1), own, o);
    REQUIRE(report.count(myriad::status::success) == own.size());
    for (std::int64_t i = 0; i < own.size(); ++i) {
        CAPTURE(i);
        auto one = prepare();
        myriad::options scaled = o;
        scaled.relative_tolerance = scaled.absolute_tolerance = std::ldexp(0x1p-30, static_cast<int>(4 * i) - 8);
        myriad::solve<plain>(tests::test_device(1), one, scaled);
        // powers of two: the ratios to the tolerances are the same, except for the limits of single precision
        CHECK(one.accepted_steps()[i] == own.accepted_steps()[i]);
        CHECK(one.rejected_steps()[i] == own.rejected_steps()[i]);
        for (int c = 0; c < 2; ++c) CHECK(std::abs(one.state(c)[i] - own.state(c)[i]) <= 1e-5 * 0x1p-30);
    }
    CHECK(own.accepted_steps()[0] > own.accepted_steps()[4]);
    auto refused = prepare();
    refused.tolerance_scale()[3] = 0;
    CHECK_THROWS_WITH(myriad::solve<choices::scaled>(tests::test_device(1), refused, o),
                      Catch::Matchers::Contains("tolerance_scale is 0 in instance 3"));
    o.invalid_instances = myriad::invalid_instances::mark;
    const auto marked = myriad::solve<choices::scaled>(tests::test_device(1), refused, o);
    CHECK(marked.count(myriad::status::invalid_input) == 1);
    CHECK(marked.count(myriad::status::success) == refused.size() - 1);
    CHECK_THROWS_WITH(myriad::solve<plain>(tests::test_device(1), own, o),
                      Catch::Matchers::Contains("tolerance_per_instance"));
}
