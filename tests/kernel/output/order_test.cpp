// SPDX-License-Identifier: MIT
// The order of the samples between the steps, measured against an exact solution.
#include "tests/kernel/output/sampling.hpp"

using namespace output;

namespace {

/// Root mean square error of samples, each at a different fraction of its step.
template <class Method>
double sample_error(double h, double span) {
    auto e = curves(span, 16);
    for (std::int64_t i = 0; i < e.size(); ++i) e.t_end()[i] = e.t_begin()[i] + span;
    options o = compare::fixed_step(h);
    o.samples.states = {curve::u, curve::w};
    o.samples.evenly = o.samples.capacity = 998;  // 997 is prime, so that no fraction occurs twice
    const auto report = solve<dense<Method>>(tests::test_device(1), e, o);
    REQUIRE(report.accepted_steps == e.size() * std::lround(std::abs(span) / h));  // steps of length h only
    REQUIRE((e.samples().stored() == 998).all());
    double squares = 0;
    for (std::int64_t i = 0; i < e.size(); ++i) {
        for (int k = 0; k < 998; ++k) {
            const auto exact = curve::exact(e.samples().time()(i, k));
            for (int c = 0; c < curve::n_state; ++c) squares += std::pow(e.samples().state(c)(i, k) - exact[c], 2);
        }
    }
    return std::sqrt(squares / (998.0 * static_cast<double>(e.size())));
}

/// Halving the step divides the error by 2^order (1 + O(h)).
template <class Method>
void check_order(double order, double first_h = 1.0 / 16, double window = 0.15) {
    for (const double span : {1.0, -1.0}) {
        double h = first_h, coarse = sample_error<Method>(h, span);
        std::vector<double> slopes;
        for (int i = 0; i < 3; ++i) {
            h /= 2;
            const double fine = sample_error<Method>(h, span);
            slopes.push_back(std::log2(coarse / fine));
            coarse = fine;
        }
        CAPTURE(span, slopes, coarse);
        REQUIRE(coarse > 10 * std::sqrt(1 / h) * eps_of<double>);  // clear of the roundings of all steps
        CHECK(std::abs(slopes[2] - order) < window);
    }
}

}  // namespace

// The cubic Hermite polynomial has the error h^4 y''''/384; the steps of order four and five add no lower power of h.
TEST_CASE("samples of runge_kutta_4 have an error of order four", "[output]") { check_order<runge_kutta_4>(4); }
TEST_CASE("samples of cash_karp have an error of order four, that of the Hermite polynomial", "[output]") {
    check_order<cash_karp>(4);
}
// An interpolant of order four is wrong by O(h^5), as is the solution at the steps.
TEST_CASE("samples of tsitouras_5 have an error of order five", "[output]") { check_order<tsitouras_5>(5); }
#if defined(MYRIAD_NIGHTLY)
TEST_CASE("samples of dormand_prince_5 have an error of order five", "[output]") { check_order<dormand_prince_5>(5); }
// The error coefficients of order seven are so small that rounding dominates first.
TEST_CASE("samples of verner_7 have an error of order seven at least", "[output]") {
    for (const double h : {0.25, 0.125, 0.0625})
        CHECK(std::log2(sample_error<verner_7>(h, 1) / sample_error<verner_7>(h / 2, 1)) > 6.7);
}
#endif
TEST_CASE("samples of dormand_prince_8 have an error of order eight", "[output]") {
    check_order<dormand_prince_8>(8, 0.5, 0.3);
}

TEST_CASE("samples at the ends of steps are the steps' own and no interpolant's", "[output]") {
    each_dense_method([]<class Dense, class Method> {
        options o = compare::fixed_step(1.0 / 64);
        o.samples.states = {curve::u, curve::w};
        o.samples.capacity = 65;
        auto by_steps = curves(), by_time = curves();
        by_steps.t_end() = by_steps.t_begin() + 1;
        by_time.t_end() = by_time.t_begin() + 1;
        o.samples.every = 1;
        solve<Dense>(tests::test_device(1), by_steps, o);
        o.samples.every = 0;
        o.samples.evenly = 65;  // multiples of 1/64 from a multiple of 1/16: exact
        solve<Dense>(tests::test_device(1), by_time, o);
        REQUIRE((by_steps.samples().stored() == 65).all());
        CHECK(same_samples(by_steps, by_time));
    });
}
