// SPDX-License-Identifier: MIT
// Which crossings count and where they are: directions, starts within the tolerance, touching, roots at the ends of the
// domain, two roots within a step, jumps.
#include <random>

#include "tests/catch.hpp"
#include "tests/kernel/event/logged_motions.hpp"
#include "tests/kernel/event/time_models.hpp"
#include "tests/support/device.hpp"

using namespace logged_motions;
using myriad::direction;

namespace {

// Global error of the spring over a dozen units of time with the steps below, and so of a crossing with slope 1:
// adaptive methods accept 1e-12 per step and take some hundred steps; RK4 has h^4 / 120 * t.
constexpr double spring_step = 1e-3, spring_error = 1e-9;

template <class Method>
std::vector<double> zeros_of_sine(double t_end, direction d) {
    auto e = ensemble_of(sine, {position(), never(), never()}, 0, t_end);
    const auto report = solve<Method>(e, options_for(1e-10, spring_step, d));
    CHECK(report.count(myriad::status::success) == 1);
    return times_of(e);
}

template <class Model>
std::vector<double> logged(const myriad::ensemble<Model>& e, Eigen::Index i = 0) {
    std::vector<double> times;
    for (int k = 0; k < std::min<int>(e.integer_accessory(Model::fired)[i], Model::log_length); ++k)
        times.push_back(e.accessory(k)[i]);
    return times;
}

/// Zeros of amplitude cos t + c.
template <class Method>
std::vector<double> zeros_of_wave(double amplitude, double c, double t_begin, double t_end, const myriad::options& o) {
    myriad::ensemble<wave> e(1);
    e.state(wave::x) = 1;
    e.parameter(wave::amplitude) = amplitude;
    e.parameter(wave::c) = c;
    e.time_domain(t_begin, t_end);
    const auto report = myriad::solve<Method>(tests::test_device(1), e, o);
    CHECK(report.failed() == 0);
    return logged(e);
}

myriad::options one_event(double tolerance, double step) {
    myriad::options o;
    o.step = step;
    o.maximum_step = step;
    o.events = {{.tolerance = tolerance}};
    return o;
}

/// x' = rest - x from a distance of one, with its threshold at `rest`: a decay to zero, or an integrate-and-fire model
/// that stops at its threshold.
template <class R>
myriad::ensemble<settling, R> settling_to(R rest, R t_end) {
    myriad::ensemble<settling, R> e(1);
    e.state(settling::x) = 1 - rest;
    e.parameter(settling::rest) = rest;
    e.parameter(settling::threshold) = rest;
    e.shared_integer(settling::resets) = rest == 1 ? 1 : 0;
    e.time_domain(0, t_end);
    return e;
}

/// A gate that opens at t = c.
myriad::ensemble<gate> gate_of(int before, int at, int after, double c, double t_begin, double t_end) {
    myriad::ensemble<gate> e(1);
    e.state(gate::x) = 1;
    e.parameter(gate::c) = c;
    e.shared_integer(gate::before) = before;
    e.shared_integer(gate::at) = at;
    e.shared_integer(gate::after) = after;
    e.time_domain(t_begin, t_end);
    return e;
}

}  // namespace

TEMPLATE_TEST_CASE("rising, falling and either pick the crossings of a sine", "", ALL_METHODS) {
    CHECK(agree(zeros_of_sine<TestType>(13, direction::rising), {2 * pi, 4 * pi}, spring_error));
    CHECK(agree(zeros_of_sine<TestType>(13, direction::falling), {pi, 3 * pi}, spring_error));
    CHECK(agree(zeros_of_sine<TestType>(13, direction::either), {pi, 2 * pi, 3 * pi, 4 * pi}, spring_error));
}

TEMPLATE_TEST_CASE("backwards in time a direction is that of the integration", "", ALL_METHODS) {
    // Backwards from t = 0, sin t first falls below zero and then rises through it at -pi.
    CHECK(agree(zeros_of_sine<TestType>(-13, direction::rising), {-pi, -3 * pi}, spring_error));
    CHECK(agree(zeros_of_sine<TestType>(-13, direction::falling), {-2 * pi, -4 * pi}, spring_error));
    CHECK(agree(zeros_of_sine<TestType>(-13, direction::either), {-pi, -2 * pi, -3 * pi, -4 * pi}, spring_error));
}

TEMPLATE_TEST_CASE("every event has its own direction and tolerance at run time", "", ALL_METHODS) {
    auto e = ensemble_of(sine, {position(), position(), position(0.5)}, 0, 13);
    auto o = options_for(1e-10, spring_step);
    o.events = {{.direction = direction::rising, .tolerance = 1e-10},
                {.direction = direction::falling, .tolerance = 1e-3},
                {.direction = direction::rising, .tolerance = 1e-10}};
    solve<TestType>(e, o);
    CHECK(agree(times_of(e, 0), {2 * pi, 4 * pi}, spring_error));
    CHECK(agree(times_of(e, 1), {pi, 3 * pi}, 1e-3 + spring_error));
    CHECK(agree(times_of(e, 2), {pi / 6, 2 * pi + pi / 6}, spring_error));
}

TEMPLATE_TEST_CASE("an event function of time alone works forwards and backwards", "", ALL_METHODS) {
    for (const double sign : {1.0, -1.0}) {
        auto e =
            ensemble_of(motion{.x = 1, .v = 1, .a = 2}, {time(sign * 0.7), time(sign * 2.5), time(-sign)}, 0, sign * 3);
        solve<TestType>(e, options_for(1e-13, 0.04));
        const auto log = log_of(e);
        REQUIRE(log.size() == 2);
        CHECK((log[0].event == 0 && log[1].event == 1));
        CHECK(std::abs(log[0].t - sign * 0.7) <= 1e-13);
        CHECK(std::abs(log[1].t - sign * 2.5) <= 1e-13);
    }
}

TEMPLATE_TEST_CASE("a flight that starts within the tolerance is caught when it returns within the first step", "",
                   ALL_METHODS) {
    constexpr double tolerance = 1e-6;
    // x0 + v0 t - t^2 / 2, upwards and mirrored; the first step, 10 long, ends far on the other side
    for (const double x0 : {0.0, 0.3 * tolerance, tolerance}) {
        for (const double v0 : {1.0, 1e-2}) {
            for (const double mirror : {1.0, -1.0}) {
                for (const direction d : {direction::either, direction::falling, direction::rising}) {
                    CAPTURE(x0, v0, mirror, static_cast<int>(d));
                    auto e = ensemble_of(motion{.x = mirror * x0, .v = mirror * v0, .a = -mirror},
                                         {position(), never(), never()}, 0, 10);
                    solve<TestType>(e, options_for(tolerance, 10, d));
                    const bool wanted = static_cast<double>(static_cast<int>(d)) * mirror <= 0;
                    const auto times = times_of(e);
                    REQUIRE(times.size() == (wanted ? 1 : 0));
                    // The root of x, and its distance from points with |x| within the tolerance, at a slope of v0.
                    if (wanted) CHECK(std::abs(times[0] - (v0 + std::sqrt(v0 * v0 + 2 * x0))) <= 1.1 * tolerance / v0);
                }
            }
        }
    }
}

TEMPLATE_TEST_CASE("a flight that never leaves the tolerance and then falls far is caught once", "", ALL_METHODS) {
    constexpr double tolerance = 1e-6;
    // v0^2 / 2 high and 2 v0 long: at t = 1e6 the last is below the resolution of t
    for (const double v0 : {1e-3, 1e-5, 1e-8, 1e-11}) {
        for (const double t_begin : {0.0, 1e6}) {
            for (const double mirror : {1.0, -1.0}) {
                CAPTURE(v0, t_begin, mirror);
                auto e = ensemble_of(motion{.v = mirror * v0, .a = -mirror}, {position(), never(), never()}, t_begin,
                                     t_begin + 10);
                const auto report = solve<TestType>(e, options_for(tolerance, 10));
                CHECK(report.count(myriad::status::success) == 1);
                const auto times = times_of(e);
                REQUIRE(times.size() == 1);
                const double t = times[0] - t_begin;
                CHECK(std::abs(v0 * t - t * t / 2) <= tolerance);
            }
        }
    }
}

TEMPLATE_TEST_CASE("starting on the surface and leaving it is no crossing, but starting right before it is", "",
                   ALL_METHODS) {
    constexpr double tolerance = 1e-6;
    for (const double x0 : {0.0, 0.3 * tolerance, -0.3 * tolerance})
        for (const double v0 : {1.0, -1.0, 1e-3, -1e-3})
            for (const double step : {1e-7, 0.1, 10.0}) {
                CAPTURE(x0, v0, step);
                auto e = ensemble_of(motion{.x = x0, .v = v0, .a = v0}, {position(), never(), never()}, 0, 1);
                solve<TestType>(
                    e, options_for(tolerance,
                                   std::is_same_v<TestType, myriad::runge_kutta_4> ? std::max(step, 1e-4) : step));
                CHECK(count_of(e) == (x0 * v0 < 0 ? 1 : 0));
            }
}

TEMPLATE_TEST_CASE("starting at rest on the surface is no crossing, and the next true one is found", "", ALL_METHODS) {
    // x = cos t against 1: on the surface at rest, and touching it ever after; against 0: crossings
    auto e = ensemble_of(cosine, {position(1), position(), never()}, 0, 8);
    solve<TestType>(e, options_for(1e-10, spring_step));
    CHECK(times_of(e, 0).empty());
    CHECK(agree(times_of(e, 1), {pi / 2, 3 * pi / 2, 5 * pi / 2}, spring_error));
}

TEMPLATE_TEST_CASE("a time event at t_begin does not fire, one right after it does", "", ALL_METHODS) {
    auto e = ensemble_of(motion{}, {time(2), time(2 + 1e-12), never()}, 2, 3);
    solve<TestType>(e, options_for(1e-10, 0.1));
    CHECK(count_of(e) == 1);
    CHECK(agree(times_of(e, 1), {2 + 1e-12}, 1e-10));
}

TEMPLATE_TEST_CASE("touching zero without crossing is no event", "", ALL_METHODS) {
    for (const double step : {0.01, 0.1, 0.37}) {
        CAPTURE(step);
        CHECK(zeros_of_wave<TestType>(-1, 1, 0, 20, one_event(1e-6, step)).empty());   // 1 - cos t
        CHECK(zeros_of_wave<TestType>(-1, 1, -1, 20, one_event(1e-6, step)).empty());  // not when it starts on the
                                                                                       // surface either
        CHECK(zeros_of_wave<TestType>(1, -1, 1, 20, one_event(1e-12, step)).empty());
    }
}

TEMPLATE_TEST_CASE("touching zero is no event when the interpolant is looked at inside the step", "", ALL_METHODS) {
    auto o = one_event(1e-6, 0.1);
    o.sub_samples = 16;
    CHECK(zeros_of_wave<TestType>(-1, 1, -1, 20, o).empty());
}

TEMPLATE_TEST_CASE("a solution that dips below zero by less than the tolerance crosses twice, too", "", ALL_METHODS) {
    constexpr double tolerance = 1e-6, depth = 0.5 * tolerance;
    auto e = ensemble_of(cosine, {position(-1 + depth), position(1 - depth), never()}, 0, 8);
    auto o = options_for(tolerance, 1e-4);  // the dips are 2e-3 long
    o.maximum_step = 1e-4;
    solve<TestType>(e, o);
    // the slope is 1e-3, and a tolerance counts as 1/64 of the function's change in a step at most
    const double half = std::acos(1 - depth);
    CHECK(agree(times_of(e, 0), {pi - half, pi + half}, 1e-4 / 64));
    CHECK(agree(times_of(e, 1), {half, 2 * pi - half, 2 * pi + half}, 1e-4 / 64));
}

TEMPLATE_TEST_CASE("a solution that dips below zero by more than the tolerance crosses twice", "", ALL_METHODS) {
    constexpr double tolerance = 1e-4;
    auto e = ensemble_of(cosine, {position(-1 + 3 * tolerance), never(), never()}, 0, 6);
    auto o = options_for(tolerance, 1e-3);  // the dip is 0.05 long
    o.maximum_step = 1e-3;
    solve<TestType>(e, o);
    // at a slope of sqrt(6 tol) the tolerance spans sqrt(tol / 6)
    const double half = std::acos(1 - 3 * tolerance);
    CHECK(agree(times_of(e), {pi - half, pi + half}, std::sqrt(tolerance / 6)));
}

TEMPLATE_TEST_CASE("a root exactly at t_end fires once, and not again in the next phase", "", ALL_METHODS) {
    for (const int kind : {0, 1}) {
        CAPTURE(kind);
        auto e = ensemble_of(motion{.v = 1}, {kind == 0 ? time(1) : position(1), never(), never()}, 0, 1);
        auto o = options_for(1e-9, 0.1);
        o.phase_time = myriad::phase_time::carry_on;
        solve<TestType>(e, o);
        CHECK(e.status(0) == myriad::status::success);
        CHECK(agree(times_of(e), {1}, 1e-9));
        e.t_end() = 2;
        solve<TestType>(e, o);
        CHECK(e.status(0) == myriad::status::success);
        CHECK(agree(times_of(e), {1}, 1e-9));
        CHECK(e.t()[0] == 2);
    }
}

TEMPLATE_TEST_CASE("a root at t_end that rounding leaves short of zero fires in every phase that ends there", "",
                   ALL_METHODS) {
    auto o = one_event(1e-9, 0.1);
    o.phases = 3;  // cos(pi / 2) is 6e-17 and not 0 in double precision; each phase starts at t = 0 again
    CHECK(agree(zeros_of_wave<TestType>(1, 0, 0, pi / 2, o), {pi / 2, pi / 2, pi / 2}, 1e-9));
    CHECK(agree(zeros_of_wave<TestType>(1, 0, 0, -pi / 2, o), {-pi / 2, -pi / 2, -pi / 2}, 1e-9));
}

TEMPLATE_TEST_CASE("a decay that comes within the tolerance of zero at t_end, but not to zero, does not fire", "",
                   ALL_METHODS) {
    for (const double t_end : {5.0, 14.0, 20.0, 37.0, 100.0, 1e4}) {
        for (const double rest : {0.0, 1.0}) {
            CAPTURE(t_end, rest);
            auto e = settling_to(rest, t_end);
            auto o = one_event(1e-6, 0.01);
            o.maximum_step = 2;  // RK4 takes 0.01
            o.events[0].stop_after = 1;
            myriad::solve<TestType>(tests::test_device(1), e, o);
            CHECK(e.status(0) == myriad::status::success);
            CHECK(e.integer_accessory(settling::fired)[0] == 0);
            CHECK(e.t()[0] == t_end);
            CHECK(std::abs(e.state(settling::x)[0] - rest) <= std::max(2 * std::exp(-t_end), 1e-7));
        }
    }
}

TEST_CASE("a decay of a float model that comes within the tolerance of zero at t_end does not fire") {
    for (const float t_end : {14.0f, 37.0f, 1000.0f, 1e5f}) {
        for (const float rest : {0.0f, 1.0f}) {
            CAPTURE(t_end, rest);
            auto e = settling_to(rest, t_end);
            auto o = one_event(1e-5, t_end > 1000 ? 1 : 0.01);
            o.relative_tolerance = o.absolute_tolerance = 1e-6;
            myriad::solve<myriad::cash_karp>(tests::test_device(1), e, o);
            CHECK(e.status(0) == myriad::status::success);
            CHECK(e.integer_accessory(settling::fired)[0] == 0);
        }
    }
}

TEMPLATE_TEST_CASE("a root at t_end is found however many steps lead there", "", ALL_METHODS) {
    // x = 1 - t, where the steps' rounding accumulates
    for (const int steps : {1, 3, 7, 10, 49, 99, 321, 1000}) {
        for (const double t_begin : {0.0, -1.0, 100.0}) {
            CAPTURE(steps, t_begin);
            auto e = ensemble_of(motion{.x = 1, .v = -1}, {position(), never(), never()}, t_begin, t_begin + 1);
            auto o = options_for(1e-9, 1.0 / steps, direction::falling);
            o.maximum_step = 1.0 / steps;
            solve<TestType>(e, o);
            // past the sum of these it is a crossing like others
            const double rounding = std::numeric_limits<double>::epsilon() * steps * (1 + std::abs(t_begin));
            CHECK(agree(times_of(e), {t_begin + 1}, rounding));
            CHECK(e.t()[0] == t_begin + 1);
        }
    }
}

TEMPLATE_TEST_CASE("an event within the rounding of t_end does not fail the instance", "", ALL_METHODS) {
    // x passes the surface 1e-14 before t_end = 1000.5, whose resolution is 1e-13, by ten tolerances
    for (const double step : {0.01, 0.3, 1.0}) {
        CAPTURE(step);
        auto e = ensemble_of(motion{.v = 1e6}, {position(0.5e6 - 1e-8), never(), never()}, 1000, 1000.5);
        const auto report = solve<TestType>(e, options_for(1e-9, step));
        CHECK(report.count(myriad::status::success) == 1);
        CHECK(e.t()[0] == 1000.5);
        if (count_of(e) > 0) {
            CHECK(agree(times_of(e), {1000.5}, 2e-13));
        } else {  // the steps' lengths, differences of rounded times, may leave x short of the surface
            const double rounding =
                1000.5 * std::numeric_limits<double>::epsilon() * static_cast<double>(e.accepted_steps()[0]);
            CHECK(std::abs(e.state(logged_motion::x)[0] - 0.5e6) <= 1e6 * rounding);
        }
    }
}

TEST_CASE("both roots of (t - 1)^2 - 1e-6 are found within one fixed step of 0.01 with 16 sub-samples") {
    const function two_roots{.Q = 1, .c = 1e-6};
    const auto found = [&](double t_begin, std::int64_t sub_samples) {
        auto e = ensemble_of(motion{}, {two_roots, never(), never()}, t_begin, 2);
        auto o = options_for(1e-12, 0.01);
        o.sub_samples = sub_samples;
        solve<myriad::runge_kutta_4>(e, o);
        CHECK(e.status(0) == myriad::status::success);
        return times_of(e);
    };
    // the slope is 2e-3 at both roots: 1e-12 are 5e-10 in t
    for (const double t_begin : {0.005, 0.0, 0.0083, 0.0025}) {  // the positions of the roots in their step
        CAPTURE(t_begin);
        CHECK(agree(found(t_begin, 16), {0.999, 1.001}, 1e-9));
    }
    CHECK(found(0.005, 1).empty());  // only the option finds them
}

TEMPLATE_TEST_CASE("both roots within one adaptive step are found with sub-samples", "", myriad::cash_karp,
                   myriad::tsitouras_5) {
    auto e = ensemble_of(motion{}, {function{.Q = 1, .c = 1e-2}, never(), never()}, 0, 2.3);
    auto o = options_for(1e-12, 2.2);  // nothing limits the steps of this motion: the first contains both roots
    o.sub_samples = 16;
    solve<TestType>(e, o);
    CHECK(agree(times_of(e), {0.9, 1.1}, 1e-11));  // slope 0.2
    CHECK(e.accepted_steps()[0] <= 5);
}

TEMPLATE_TEST_CASE("sub-samples look for the wanted direction only", "", ALL_METHODS) {
    for (const direction d : {direction::rising, direction::falling}) {
        auto e = ensemble_of(motion{}, {function{.Q = 1, .c = 1e-2}, never(), never()}, 0, 2.3);
        auto o = options_for(1e-12, 2.2, d);
        o.sub_samples = 16;
        solve<TestType>(e, o);
        CHECK(agree(times_of(e), {d == direction::rising ? 1.1 : 0.9}, 1e-11));
    }
}

TEMPLATE_TEST_CASE("a discontinuous event function is located to the rounding of time and fires once", "",
                   ALL_METHODS) {
    // sign(t - 1/2), the same with NaN at 1/2, falling, and a jump between large values
    struct values {
        int before, at, after;
    };
    for (const values g : {values{-1, 0, 1}, values{-1, 1, 1}, values{-1, -1, 1}, values{1, 0, -1}, values{1, -1, -1},
                           values{7, -3, -3}}) {
        for (const double t_begin : {0.0, -0.3}) {
            CAPTURE(g.before, g.at, g.after, t_begin);
            auto e = gate_of(g.before, g.at, g.after, 0.5, t_begin, 1);
            const auto report = myriad::solve<TestType>(tests::test_device(1), e, one_event(1e-6, 0.07));
            CHECK(report.count(myriad::status::success) == 1);
            CHECK(agree(logged(e), {0.5}, 4 * std::numeric_limits<double>::epsilon()));
        }
    }
}

TEMPLATE_TEST_CASE("a discontinuity at t_end fires once", "", ALL_METHODS) {
    auto e = gate_of(-1, 1, 1, 0.5, 0, 0.5);
    const auto report = myriad::solve<TestType>(tests::test_device(1), e, one_event(1e-6, 0.07));
    CHECK(report.count(myriad::status::success) == 1);
    CHECK(e.t()[0] == 0.5);
    CHECK(agree(logged(e), {0.5}, 4 * std::numeric_limits<double>::epsilon()));
}

TEMPLATE_TEST_CASE("an event function too steep for its tolerance is located to rounding and fires once", "",
                   ALL_METHODS) {
    for (const double steepness : {1e6, 1e9, 1e12, -1e9}) {
        for (const int kind : {0, 1}) {
            CAPTURE(steepness, kind);
            const function f{.X = kind == 0 ? steepness : 0, .T = kind == 0 ? 0 : steepness, .c = 0.3 * steepness};
            auto e = ensemble_of(motion{.v = 1}, {f, never(), never()}, 0, 1);
            solve_unchecked<TestType>(e, options_for(1e-12, 0.07));
            CHECK(e.status(0) == myriad::status::success);
            // x is the sum of some dozen steps of rounding 1e-16
            CHECK(agree(times_of(e), {0.3}, 20 * std::numeric_limits<double>::epsilon()));
        }
    }
}

TEST_CASE("roots of one direction are no accumulation though the middle between them is a root too") {
    // cos t falls through zero 159 times in [0, 1000]; x = 0 lets the steps grow over many of its periods
    for (const double tolerance : {1e-6, 0.0}) {
        for (const std::int32_t points : {500, 2000, 4000}) {
            CAPTURE(tolerance, points);
            myriad::ensemble<wave> e(1);
            e.state(wave::x) = 0;
            e.parameter(wave::amplitude) = 1;
            e.parameter(wave::c) = 0;
            e.integer_accessory(wave::fired) = 0;
            e.time_domain(0, 1000);
            auto o = one_event(tolerance, 0.01);
            o.maximum_step = std::numeric_limits<double>::infinity();
            o.events[0].direction = myriad::direction::falling;
            o.sub_samples = points;
            myriad::solve<myriad::cash_karp>(tests::test_device(1), e, o);
            CHECK(e.status(0) == myriad::status::success);
            CHECK(e.integer_accessory(wave::fired)[0] == 159);
        }
    }
}

TEST_CASE("with sub_samples a function that turns far from zero ends no step") {
    const auto steps = [](double c, std::int32_t points) {
        auto e = ensemble_of(motion{.x = 1, .k = 1}, {position(c), never(), never()}, 0, 20);
        auto o = options_for(1e-6, 1e-3);
        o.sub_samples = points;
        return myriad::solve<myriad::cash_karp>(tests::test_device(1), e, o).accepted_steps;
    };
    CHECK(steps(-2, 16) == steps(-2, 1));
    // One that all but touches zero does.
    CHECK(steps(-1 - 1e-6, 16) > steps(-1 - 1e-6, 1));
}

TEMPLATE_TEST_CASE("a crossing that redone steps overshoot is not put at the start of the step", "", ALL_METHODS) {
    // x = sin(t + a), with a tolerance that x meets near its zeros only by chance
    for (const double tolerance : {1e-17, 1e-18}) {
        for (int n = 0; n < 40; ++n) {
            const double a = 0.1 + 0.03 * n;
            CAPTURE(tolerance, a);
            auto e =
                ensemble_of(motion{.x = std::sin(a), .v = std::cos(a), .k = 1}, {position(), never(), never()}, 0, 12);
            auto o = options_for(1e-6, 1e-3);
            o.events[0].tolerance = tolerance;
            solve<TestType>(e, o);
            CHECK(e.status(0) == myriad::status::success);
            std::vector<double> roots;
            for (int k = 1; k * pi - a < 12; ++k) roots.push_back(k * pi - a);
            CHECK(agree(times_of(e), roots, 1e-9));
        }
    }
}

TEMPLATE_TEST_CASE("a wall steeper than its tolerance still throws the ball back every time", "", ALL_METHODS) {
    // positions of 1e6 have a resolution of 1e-10, a hundred times the tolerance
    auto e =
        ensemble_of(motion{.x = 1e6 + 1.7, .v = -1.3},
                    {position(1e6, logged_motion::bounce), position(1e6 + 2, logged_motion::bounce), never()}, 0, 10);
    CHECK_THROWS_AS(solve<TestType>(e, options_for(1e-12, 0.07)), myriad::error);
    solve_unchecked<TestType>(e, options_for(1e-12, 0.07));
    CHECK(e.status(0) == myriad::status::success);
    CHECK(agree(times_of(e, 0), {1.7 / 1.3, 5.7 / 1.3, 9.7 / 1.3}, 1e-8));
    CHECK(agree(times_of(e, 1), {3.7 / 1.3, 7.7 / 1.3, 11.7 / 1.3}, 1e-8));
    CHECK(e.accessory(logged_motion::smallest_x)[0] >= 1e6 - 1e-9);
}

TEMPLATE_TEST_CASE("no located state lies beyond its event, for a thousand random springs", "", ALL_METHODS) {
    std::mt19937_64 random(20240611);
    const auto uniform = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    std::vector<motion> starts;
    for (int i = 0; i < 1000; ++i) {
        // x = a / k + (1 - a / k) cos(w t): starts at rest at 1, first crossing where cos(w t) = -(a/k) / (1 - a/k)
        const double w = uniform(0.3, 10), centre = uniform(-1, 0.3);
        starts.push_back({.x = 1, .v = 0, .a = centre * w * w, .k = w * w});
    }
    for (const double tolerance : {1e-4, 1e-9, 1e-12}) {
        for (const double step : {0.003, 0.02}) {
            CAPTURE(tolerance, step);
            auto e = ensemble_of(starts, {position(), never(), never()}, 0, 4);
            solve<TestType>(e, options_for(tolerance, step));
            std::int64_t wrong_number = 0, beyond = 0, short_of = 0;
            for (Eigen::Index i = 0; i < e.size(); ++i) {
                const motion& m = starts[static_cast<std::size_t>(i)];
                const double w = std::sqrt(m.k), centre = m.a / m.k;
                const double angle = std::acos(-centre / (1 - centre)), turns = 4 * w;
                int expected = 0;
                for (int n = 0; n < 10; ++n)
                    for (const double zero : {2 * pi * n + angle, 2 * pi * (n + 1) - angle})
                        if (zero < turns) ++expected;
                // a zero this close to the end may be on either side of it: RK4's error is t (w h)^5 / 120 / h
                const double slack = std::abs(std::remainder(turns - angle, 2 * pi)),
                             other = std::abs(std::remainder(turns + angle, 2 * pi));
                if (std::min(slack, other) < 0.05) continue;
                wrong_number += count_of(e, i) != expected;
                if (expected == 0) continue;
                beyond += !(e.accessory(logged_motion::beyond)[i] <= tolerance);
                short_of += !(e.accessory(logged_motion::gap)[i] <= tolerance);
            }
            CHECK(wrong_number == 0);
            CHECK(beyond == 0);
            CHECK(short_of == 0);
        }
    }
}

TEST_CASE("events of a float model are located to the resolution of float") {
    auto e = ensemble_of<float>(sine, {position(), never(), never()}, 0, 13);
    auto o = options_for(1e-5, 0.01);
    o.relative_tolerance = o.absolute_tolerance = 1e-6;
    const auto report = solve<myriad::cash_karp>(e, o);
    CHECK(report.count(myriad::status::success) == 1);
    // 1e-6 accepted per step, some hundred steps
    CHECK(agree(times_of(e), {pi, 2 * pi, 3 * pi, 4 * pi}, 2e-4));
}

TEST_CASE("a float ball that accumulates never passes the floor") {
    for (const double kept : {0.9, 0.5, 0.1}) {
        for (const double t_begin : {0.0, 1000.0}) {
            CAPTURE(kept, t_begin);
            auto e =
                ensemble_of<float>(motion{.x = 1, .a = -9.81}, {position(0, logged_motion::bounce), never(), never()},
                                   t_begin, t_begin + 20, kept);
            auto o = options_for(1e-5, 0.01, direction::falling);
            o.relative_tolerance = o.absolute_tolerance = 1e-5;
            solve<myriad::cash_karp>(e, o);
            CHECK(e.status(0) == myriad::status::event_accumulation);
            CHECK(e.accessory(logged_motion::smallest_x)[0] >= -1e-5f);
        }
    }
}

TEST_CASE("an event of direction none is switched off") {
    auto e = ensemble_of(sine, {position(), never(), never()}, 0, 13);
    const auto report = solve<myriad::cash_karp>(e, options_for(1e-10, spring_step, direction::none));
    CHECK(report.count(myriad::status::success) == 1);
    CHECK(times_of(e).empty());
    CHECK((e.located_steps() == 0).all());
}
