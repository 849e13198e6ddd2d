// SPDX-License-Identifier: MIT
// Stiff problems with end values computed in quadruple precision: errors within the bound that the tolerance implies,
// decreasing with it; Robertson's sum is conserved.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "myriad/myriad.hpp"
#include "tests/catch.hpp"
#include "tests/support/compare.hpp"
#include "tests/support/device.hpp"
#include "tests/support/stiff.hpp"

namespace {

using myriad::ensemble;
using myriad::options;
using myriad::rodas_5p;
using myriad::rosenbrock_23;
using myriad::solve;
using myriad::status;

constexpr double eps = std::numeric_limits<double>::epsilon();

struct reference {
    double t_end;
    std::vector<double> end;
    /// The factor by which an error of one step may have grown by the end, per component, in units of the tolerance:
    /// max over t of sum_j |dy_c(t_end)/dy_j(t)| s_j(t), with s = max(atol / tolerance, |y(t)|). From differences of
    /// solutions with states perturbed along the trajectory (1 % accurate), rounded up.
    std::vector<double> growth;
};

/// atol / tolerance of Robertson's components: in the end they are 2e-8, 8e-14 and 1.
const std::vector<double> robertson_scale{1e-8, 1e-14, 1};
const reference robertson_40{40, {0.71582706871940509, 9.1855347645577639e-6, 0.28416374574583035}, {1.6, 2.4e-5, 0.9}};
const reference robertson_1e5{
    1e5, {0.017865921142099465, 7.2747514684363188e-8, 0.98213400611038585}, {0.07, 1.4e-7, 2.1}};
const reference robertson_1e11{
    1e11, {2.08334014970129e-8, 8.333360770334713e-14, 0.9999999791665050}, {1.2e-7, 4.6e-13, 2.1}};
const reference van_der_pol{2, {1.76323454020344570, -0.835688681677677391}, {2.7, 2.5}};

template <class Method, class Model>
ensemble<Model> run(const reference& r, double tolerance, const std::vector<double>& start,
                    const std::vector<double>& scale) {
    ensemble<Model> e(1);
    for (std::size_t c = 0; c < start.size(); ++c) e.state(static_cast<int>(c)) = start[c];
    for (int c = 0; c < myriad::detail::n_accessory<Model>; ++c) e.accessory(c) = 0.0;
    if constexpr ((myriad::detail::n_parameter<Model>) > 0) e.parameter(0) = 1e-3;
    e.time_domain(0, r.t_end);
    options o;
    o.step = 1e-6;
    o.relative_tolerance = tolerance;
    std::vector<double> absolute = scale;
    for (double& a : absolute) a *= tolerance;
    o.absolute_tolerance = absolute;
    solve<Method>(tests::test_device(1), e, o);
    REQUIRE(e.status(0) == status::success);
    return e;
}

/// Every step adds an error below the tolerance, as the solution is more accurate than the one whose error is
/// estimated. The error decreases with the tolerance: at least tenfold for a tolerance a hundred times finer.
template <class Method, class Model>
void check(const reference& r, const std::vector<double>& tolerances, const std::vector<double>& start,
           const std::vector<double>& scale) {
    double before = std::numeric_limits<double>::infinity();
    for (const double tolerance : tolerances) {
        const auto e = run<Method, Model>(r, tolerance, start, scale);
        const double steps = static_cast<double>(e.accepted_steps()[0]);
        double worst = 0;
        for (std::size_t c = 0; c < r.end.size(); ++c) {
            const double error = std::abs(e.state(static_cast<int>(c))[0] - r.end[c]),
                         allowed = r.growth[c] * steps * tolerance;
            CAPTURE(tolerance, steps, c, error, allowed);
            CHECK(error <= allowed);
            worst = std::max(worst, error / std::abs(r.end[c]));
        }
        CAPTURE(tolerance, steps, worst, before);
        CHECK(worst <= before / 10);
        before = worst;
    }
}

template <class Method>
void check_robertson(const reference& r, const std::vector<double>& tolerances) {
    check<Method, stiff::robertson>(r, tolerances, {1, 0, 0}, robertson_scale);
}

/// The columns of J sum to zero, and so do the stages, except for rounding: that of each addition to the state, half an
/// ulp of at most one in three components, and that of the stages, magnified a hundred times by the coefficients and
/// proportional to the changes of the state, three in all.
template <class Method>
void check_sum(const reference& r, double tolerance) {
    const auto e = run<Method, stiff::robertson>(r, tolerance, {1, 0, 0}, robertson_scale);
    const double sum = e.state(0)[0] + e.state(1)[0] + e.state(2)[0];
    CHECK(std::abs(sum - 1) <= (300 + 1.5 * static_cast<double>(e.accepted_steps()[0])) * eps);
}

}  // namespace

TEST_CASE("rodas_5p ends Robertson's kinetics at their reference values") {
    for (const auto& r : {robertson_40, robertson_1e5, robertson_1e11})
        check_robertson<rodas_5p>(r, {1e-4, 1e-6, 1e-8});
}
TEST_CASE("rosenbrock_23 ends Robertson's kinetics at their reference values") {
    for (const auto& r : {robertson_40, robertson_1e5, robertson_1e11})
        check_robertson<rosenbrock_23>(r, {1e-3, 1e-5, 1e-7});
}
TEST_CASE("stiff methods keep the sum of Robertson's concentrations") {
    for (const auto& r : {robertson_40, robertson_1e5, robertson_1e11}) {
        check_sum<rosenbrock_23>(r, 1e-5);
        check_sum<rodas_5p>(r, 1e-8);
    }
}
TEST_CASE("rodas_5p ends the stiff van der Pol oscillator at its reference values") {
    check<rodas_5p, stiff::van_der_pol>(van_der_pol, {1e-4, 1e-6, 1e-8}, {2, 0}, {1, 1});
}
TEST_CASE("rosenbrock_23 ends the stiff van der Pol oscillator at its reference values") {
    check<rosenbrock_23, stiff::van_der_pol>(van_der_pol, {1e-3, 1e-5, 1e-7}, {2, 0}, {1, 1});
}
