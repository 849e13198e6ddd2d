// SPDX-License-Identifier: MIT
// The notes of reports: stiffness that limited an explicit method, and tolerances below the precision.
#include <cmath>
#include <cstdint>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "myriad/myriad.hpp"
#include "tests/catch.hpp"
#include "tests/support/device.hpp"
#include "tests/support/stiff.hpp"

namespace {

using stiff::prothero_robinson;

/// y' = rate (sin t - y) + cos t from its solution, sin t, over 40 instances.
template <class Method>
auto follow(double rate, double t_end, const myriad::options& o) {
    myriad::ensemble<prothero_robinson> e(40);
    e.state(prothero_robinson::y0) = 0.0;
    e.parameter(prothero_robinson::rate) = rate;
    e.time_domain(0, t_end);
    return myriad::solve<Method>(tests::test_device(1), e, o);
}

/// Twenty starts near the attractor of Roessler's equations, each a separate run over 50 units of time: the number of
/// runs reported as stiff, and the steps of all.
template <class Method>
std::pair<int, std::int64_t> stiff_runs_of_roessler(double tolerance) {
    int told = 0;
    std::int64_t steps = 0;
    for (int k = 0; k < 20; ++k) {
        myriad::ensemble<stiff::roessler> e(1);
        e.state(stiff::roessler::x) = 0.3 * k - 3;
        e.state(stiff::roessler::y) = 2 * std::sin(7.0 * k);
        e.state(stiff::roessler::z) = 0.1 * k;
        e.time_domain(0, 50);
        const auto report =
            solve<Method>(tests::test_device(1), e, {.relative_tolerance = tolerance, .absolute_tolerance = tolerance});
        told += report.notes.empty() ? 0 : 1;
        steps += report.accepted_steps + report.rejected_steps;
    }
    return {told, steps};
}

bool mentions(const std::vector<myriad::statement>& notes, const char* what) {
    for (const std::string note : notes)
        if (note.find(what) != std::string::npos) return true;
    return false;
}

}  // namespace

TEST_CASE("the report remarks that stability limits an explicit method and says what to try") {
    // Accuracy alone would allow steps of a tenth; stability requires steps below 3 / 1e4.
    const myriad::options o{.relative_tolerance = 1e-6, .absolute_tolerance = 1e-6};
    const auto tsitouras = follow<myriad::tsitouras_5>(1e4, 1, o);
    CHECK(tsitouras.accepted_steps > 40 * 2000);
    CHECK(mentions(tsitouras.notes, "40 of 40 instances"));
    CHECK(mentions(tsitouras.notes, "rodas_5p"));
    CHECK(mentions(follow<myriad::dormand_prince_8>(1e4, 1, o).notes, "rodas_5p"));
    std::ostringstream printed;
    printed << tsitouras;
    CHECK(printed.str().find("note: stability, not accuracy, limits the step") != std::string::npos);
}

TEST_CASE("the report does not remark stiffness where accuracy limits the step, or the user, or there were few steps") {
    const myriad::options o{.relative_tolerance = 1e-6, .absolute_tolerance = 1e-6};
    CHECK(follow<myriad::rodas_5p>(1e4, 1, o).notes.empty());        // the method that the note recommends
    CHECK(follow<myriad::tsitouras_5>(1e4, 0.01, o).notes.empty());  // a hundred steps
    myriad::options fine = o;
    fine.relative_tolerance = fine.absolute_tolerance = 1e-13;
    const auto accurate = follow<myriad::tsitouras_5>(1, 30, fine);
    CHECK(accurate.accepted_steps > 40 * 200);
    CHECK(accurate.notes.empty());
    myriad::options silent = o;
    silent.advice = myriad::advice::off;
    CHECK(follow<myriad::tsitouras_5>(1e4, 1, silent).notes.empty());
    myriad::options bounded = o;
    bounded.maximum_step = 1e-4;
    CHECK(follow<myriad::tsitouras_5>(1e4, 1, bounded).notes.empty());
    // growth needs small steps by its nature: no method would need fewer
    CHECK(follow<myriad::tsitouras_5>(-1, 30, fine).notes.empty());
}

TEST_CASE("chaotic motion in which a stiff method would take more steps is not called stiff") {
    for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
        INFO("tolerance " << tolerance);
        const auto stiff = stiff_runs_of_roessler<myriad::rodas_5p>(tolerance);
        const auto tsitouras = stiff_runs_of_roessler<myriad::tsitouras_5>(tolerance);
        const auto high = stiff_runs_of_roessler<myriad::dormand_prince_8>(tolerance);
        CHECK(tsitouras.second < stiff.second);
        CHECK(tsitouras.first == 0);  // at 1e-4, eight of twenty were reported, at 1e-6 five
        CHECK(high.second < stiff.second);
        CHECK(high.first == 0);
    }
}

TEST_CASE("stiff chemistry, relaxation and diffusion are still found stiff") {
    const auto told = [](auto e, double t_end, double tolerance) {
        e.time_domain(0, t_end);
        return mentions(solve<myriad::tsitouras_5>(tests::test_device(1), e,
                                                   {.relative_tolerance = tolerance, .absolute_tolerance = tolerance})
                            .notes,
                        "rodas_5p");
    };
    for (const double tolerance : {1e-6, 1e-9}) {
        INFO("tolerance " << tolerance);
        myriad::ensemble<stiff::robertson> reaction(1);
        reaction.state(stiff::robertson::a) = 1;
        reaction.state(stiff::robertson::b) = reaction.state(stiff::robertson::c) = 0;
        CHECK(told(std::move(reaction), 10, tolerance));
        myriad::ensemble<stiff::van_der_pol> relaxation(1);
        relaxation.state(stiff::van_der_pol::x) = 2;
        relaxation.state(stiff::van_der_pol::v) = 0;
        relaxation.parameter(stiff::van_der_pol::eps) = 1e-5;
        relaxation.accessory(stiff::van_der_pol::fastest) = 0;
        CHECK(told(std::move(relaxation), 0.3, tolerance));
        myriad::ensemble<stiff::rod<7>> heat(1);
        for (int c = 0; c < 7; ++c) heat.state(c) = 1 + c;
        heat.parameter(stiff::rod<7>::rate) = 1000;
        CHECK(told(std::move(heat), 1, tolerance));
    }
}

TEST_CASE("tangents, which stiff methods do not take, are not advised one") {
    myriad::ensemble<stiff::prothero_robinson_with_tangent> e(4);
    e.state(stiff::prothero_robinson::y0) = 0;
    e.parameter(stiff::prothero_robinson::rate) = 1e4;
    e.shared_integer(stiff::prothero_robinson_with_tangent::transient_phases) = 0;
    e.time_domain(0, 0.05);  // over which the tangent shrinks to e^-500 but does not vanish
    myriad::initial_tangents(e);
    const auto report = solve<myriad::tsitouras_5>(
        tests::test_device(1), e, {.phases = 4, .relative_tolerance = 1e-6, .absolute_tolerance = 1e-6});
    CHECK(report.accepted_steps > 4 * 200);
    CHECK_FALSE(mentions(report.notes, "rodas_5p"));
}

TEST_CASE("a tolerance below the precision is raised to it, and the report says so") {
    const auto raised = follow<myriad::tsitouras_5>(1, 1, {.relative_tolerance = 1e-18, .absolute_tolerance = 1e-300});
    CHECK(mentions(raised.notes, "relative_tolerance 1e-18 is below what the precision can reach: 8.88"));
    const auto reachable = follow<myriad::tsitouras_5>(
        1, 1, {.relative_tolerance = 4 * std::numeric_limits<double>::epsilon(), .absolute_tolerance = 1e-300});
    CHECK(reachable.notes.empty());
    CHECK(raised.accepted_steps == reachable.accepted_steps);
    CHECK(raised.by_status == reachable.by_status);
}

TEST_CASE("the stability function of a method is the exponential to its order, and its limit is the published one") {
    using myriad::host::real_stability_limit;
    using myriad::host::stability_function;
    for (const double z : {-0.01, 0.01}) {
        // the next term of the series, z^(order + 1) / (order + 1)! times at most a few
        CHECK(std::abs(stability_function<myriad::runge_kutta_4>(z) - std::exp(z)) <= 1.01e-10 / 120);
        CHECK(std::abs(stability_function<myriad::dormand_prince_5>(z) - std::exp(z)) <= 2 * 1e-12 / 720 + 4e-16);
    }
    // Hairer and Wanner, Solving ODE II, IV.2, fig. 2.1 and 2.2
    CHECK(std::abs(real_stability_limit<myriad::runge_kutta_4>() - 2.785) <= 0.02);
    CHECK(std::abs(real_stability_limit<myriad::dormand_prince_5>() - 3.307) <= 0.02);
}
