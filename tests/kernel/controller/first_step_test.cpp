// SPDX-License-Identifier: MIT
// The first step of a phase where none is given, and where time does not resolve the given one.
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <myriad/myriad.hpp>

#include "tests/catch.hpp"
#include "tests/host/ensemble/refusal.hpp"
#include "tests/kernel/controller/first_step_models.hpp"
#include "tests/support/device.hpp"

using namespace first_steps;
using myriad::cash_karp;
using myriad::options;
using myriad::status;
using myriad::tsitouras_5;
using tests::test_device;

namespace {

template <class R>
myriad::ensemble<line, R> lines(R begin, R end, R slope = 1, R start = 0) {
    myriad::ensemble<line, R> e(5);
    e.state(line::y) = start;
    e.parameter(line::slope) = slope;
    e.time_domain(begin, end);
    return e;
}
template <class R>
myriad::ensemble<swing, R> swings(R rate, R begin, R end) {
    myriad::ensemble<swing, R> e(7);
    e.state(swing::x) = R(1);
    e.state(swing::v) = R(0);
    e.parameter(swing::rate) = rate;
    e.time_domain(begin, end);
    return e;
}
/// The length of the first step that is tried.
template <class Method = cash_karp, class R>
double first_step(myriad::ensemble<line, R> e, options o = {}) {
    o.growth_limit = 1;
    o.max_steps = 1;
    myriad::solve<Method>(test_device(), e, o);
    return static_cast<double>(e.t()[0]) - static_cast<double>(e.t_begin_of(0));
}
bool has_note(const std::vector<myriad::statement>& notes, const std::string& text) {
    for (const std::string note : notes)
        if (note.find(text) != std::string::npos) return true;
    return false;
}

}  // namespace

TEST_CASE("the default first step is resolved by a time far from zero: float from 1e6, double from 1e15, backwards") {
    auto f = lines<float>(1e6F, 1e6F + 1000);
    CHECK(myriad::solve<cash_karp>(test_device(), f).count(status::success) == 5);
    CHECK(f.state(line::y)[0] == 1000);
    auto before = lines<float>(-1e6F, -1e6F + 1000);
    CHECK(myriad::solve<cash_karp>(test_device(), before).count(status::success) == 5);
    auto back = lines<double>(1e15, 1e15 - 1000);
    CHECK(myriad::solve<cash_karp>(test_device(), back).count(status::success) == 5);
    CHECK(back.state(line::y)[0] == Approx(-1000));
    auto slow = swings<double>(1e-3, 1e15, 1e15 + 1000);
    CHECK(myriad::solve<tsitouras_5>(test_device(), slow).count(status::success) == 7);
    CHECK(std::abs(slow.state(swing::x)[0] - std::cos(1.0)) < 1e-6);
}

TEST_CASE("a domain of one rounding of t is one step, and an empty one none") {
    auto e = lines<double>(1e15, 1e15 + 0.125);
    CHECK(myriad::solve<cash_karp>(test_device(), e).count(status::success) == 5);
    CHECK(e.state(line::y)[0] == Approx(0.125));
    CHECK(e.accepted_steps()[0] == 1);
    auto none = lines<double>(1e15, 1e15);
    CHECK(myriad::solve<cash_karp>(test_device(), none).count(status::success) == 5);
    CHECK(none.accepted_steps()[0] == 0);
}

TEST_CASE("a given first step that time does not resolve is lengthened, and any other is the one taken") {
    auto e = lines<double>(1e15, 1e15 + 1000);
    CHECK(myriad::solve<cash_karp>(test_device(), e, {.step = 1e-2}).count(status::success) == 5);
    CHECK(first_step(lines<double>(0, 10), {.step = 1e-2}) == 1e-2);
    CHECK(first_step(lines<double>(0, 10, 1e9), {.step = 0.5}) == 0.5);
    CHECK(first_step(lines<double>(0, 10), {.step = 100}) == 10);
}

TEST_CASE("the default first step follows from slope, tolerance and domain") {
    // y = 0, whose size is atol / rtol = 1, is to change by 2 rtol^(1/5).
    const double usual = 2 * std::pow(1e-8, 0.2);
    CHECK(first_step(lines<double>(0, 10)) == Approx(usual));
    CHECK(first_step(lines<double>(0, 10, -4)) == Approx(usual / 4));
    CHECK(first_step(lines<double>(0, 10, 4, 20)) == Approx(5 * usual));
    CHECK(first_step(lines<double>(0, 10), {.relative_tolerance = 1e-13, .absolute_tolerance = 1e-13}) ==
          Approx(2 * std::pow(1e-13, 0.2)));
    CHECK(first_step(lines<double>(0, 10, 1e-3)) == Approx(0.954915));  // nearly a tenth of the domain
    CHECK(first_step(lines<double>(0, 10, 1e300)) < 1e-300);
    for (const double rest : {0.0, 1e-300, 1e-9}) CHECK(first_step(lines<double>(0, 10, rest)) == Approx(1e-8));
    CHECK(first_step(lines<double>(0, 1e-6)) == Approx(0.954915e-7));
    CHECK(first_step(lines<double>(0, 1e-9)) == Approx(1e-18).margin(0));  // which changes nothing
    CHECK(first_step(lines<double>(0, 10), {.maximum_step = 1e-3}) == Approx(1e-3));
    CHECK(first_step(lines<double>(0, 10, 1e9), {.minimum_step = 0.25}) == Approx(0.25));
    CHECK(first_step<myriad::rosenbrock_23>(lines<double>(0, 10)) > 0);
}

TEST_CASE("a domain of a round number of periods of a forcing is not stepped over at whole periods") {
    for (const double periods : {80.0, 400.0, 900.0, 7200.0}) {
        const auto end_of = [&]<class Method>(Method) {
            myriad::ensemble<pulses> e(5);
            e.state(pulses::y) = 0.0;
            e.parameter(pulses::drift) = 1e-6;
            e.time_domain(0, periods);
            CHECK(myriad::solve<Method>(test_device(), e).count(status::success) == 5);
            return e.state(pulses::y)[0];
        };
        CHECK(end_of(cash_karp{}) == Approx((0.5 + 1e-6) * periods).epsilon(1e-5));
        CHECK(end_of(myriad::dormand_prince_5{}) == Approx((0.5 + 1e-6) * periods).epsilon(1e-5));
    }
}

TEST_CASE("a state of zero without an absolute tolerance does not make the first step vanish") {
    CHECK(first_step(lines<double>(0, 10), {.absolute_tolerance = 0}) == Approx(1e-8));
    auto e = lines<double>(0, 10);
    const auto report = myriad::solve<cash_karp>(test_device(), e, {.absolute_tolerance = 0});
    CHECK(report.count(status::success) == 5);
    CHECK(report.accepted_steps < 5 * 20);
}

TEST_CASE("a slope that is not finite at the start ends the instance as not_finite, with its state") {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    for (const double wrong : {infinity, -infinity}) {
        auto e = lines<double>(0, 10, 1.7e308);
        e.state(line::y) = std::copysign(1.7e308, wrong);
        e.parameter(line::slope) = std::copysign(1.7e308, wrong);
        const auto report = myriad::solve<cash_karp>(test_device(), e);
        CHECK(report.count(status::not_finite) + report.count(status::step_underflow) == 5);
        CHECK(std::isfinite(e.state(line::y)[0]));
    }
}

TEST_CASE("the first step is chosen in each phase, with the same bits in one call and in several") {
    auto once = swings<double>(3, 0, 1), apart = swings<double>(3, 0, 1);
    myriad::solve<tsitouras_5>(test_device(), once, {.phases = 4});
    for (int phase = 0; phase < 4; ++phase) myriad::solve<tsitouras_5>(test_device(), apart);
    CHECK((once.state(swing::x) == apart.state(swing::x)).all());
    CHECK((once.accepted_steps() == apart.accepted_steps()).all());
    CHECK((once.rhs_evaluations() == apart.rhs_evaluations()).all());
}

TEST_CASE("steps shorter than time resolves in single precision are noted, with the remedy") {
    myriad::ensemble<relaxation, float> e(60);
    e.state(relaxation::x) = 2.0F;
    e.state(relaxation::v) = 0.0F;
    e.parameter(relaxation::mu) = Eigen::ArrayXf::LinSpaced(60, 500, 1500);
    e.time_domain(0, 2000);
    const auto report = myriad::solve<tsitouras_5>(
        test_device(), e, {.relative_tolerance = 1e-5, .absolute_tolerance = 1e-5, .max_steps = 1'000'000});
    INFO(report);
    REQUIRE(report.count(status::step_underflow) > 0);
    CHECK(has_note(report.notes, "step_underflow: time, which single precision resolves to"));
    CHECK(has_note(report.notes, "use double precision"));
    auto healthy = swings<float>(1, 0, 10);
    CHECK_FALSE(has_note(myriad::solve<tsitouras_5>(test_device(), healthy).notes, "step_underflow"));
}

TEST_CASE("a note says which option ended instances as max_steps") {
    auto e = swings<double>(1, 0, 1000);
    const auto report = myriad::solve<tsitouras_5>(test_device(), e, {.max_steps = 17});
    CHECK(report.count(status::max_steps) == 7);
    CHECK(has_note(report.notes, "max_steps: 17 trial steps did not take an instance to the end of its phase: raise"));
}

TEST_CASE("an absolute tolerance that is positive and not a normal number is refused, for a component too") {
    auto e = swings<double>(1, 0, 1);
    const auto with = [](myriad::per_component atol) {
        options o;
        o.absolute_tolerance = std::move(atol);
        return o;
    };
    refused([&] { myriad::solve<tsitouras_5>(test_device(), e, with(1e-310)); },
            {"absolute_tolerance is 1e-310", "below the smallest normal number, 2.22507", "or 0"});
    refused([&] { myriad::solve<tsitouras_5>(test_device(), e, with({1e-9, 5e-324})); }, {"below the smallest normal"});
    auto f = swings<float>(1, 0, 1);
    refused([&] { myriad::solve<tsitouras_5>(test_device(), f, with(1e-40)); },
            {"absolute_tolerance is 1e-40", "below the smallest normal number, 1.17549"});
    CHECK(myriad::solve<tsitouras_5>(test_device(), e, with({1e-9, 3e-308})).count(status::success) == 7);
    CHECK(myriad::solve<tsitouras_5>(test_device(), e, with(0)).count(status::success) == 7);
}
