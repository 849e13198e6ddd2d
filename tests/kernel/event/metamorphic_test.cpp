// SPDX-License-Identifier: MIT
// Events depend on the sign of their functions alone: motions whose events have closed forms have the same events,
// counts, statuses and times with other functions of the same sign, in other units, orders, parts, steps and
// neighbours, in packs, lanes by themselves, single precision, and on the device under test.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <iostream>
#include <numbers>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <myriad/myriad.hpp>

#include "tests/catch.hpp"
#include "tests/kernel/event/metamorphic_models.hpp"
#include "tests/support/device.hpp"

namespace {

using m = metamorphic;
constexpr double pi = std::numbers::pi;

struct body {
    double x = 0, v = 0, rate = 0, decay = 0, weight = 0, spring = 0;
};

/// An event function of source - level, and the times at which it fires.
struct crossing {
    int source = 0;
    double level = 0;
    int act = m::nothing;
    double value = 0, kept = 0;
    int only_in = -1;
    std::vector<double> times = {};
};

/// In single precision what happens within less than about 1e-3 is left out.
enum class precision { any, double_alone };

struct motion {
    std::string name;
    std::vector<body> bodies;
    std::vector<crossing> crossings;
    double end = 1;
    /// How much later times move if one moves. Polynomials in t are integrated exactly, but for rounding.
    double amplified = 1;
    bool exact = true;
    precision needs = precision::any;
    double other_rate = 0, ramp = 0;  // of the first body
    myriad::status status = myriad::status::success;
    bool open_end = false;  // more events than the given times may follow
    double final_time = 0;  // where it is not the end
    bool splits = true;     // nothing happens at its ends, so that it may be cut and go on
    bool jumps = true;      // seen in the sign alone, without a slope
};

std::vector<double> every(double period, double end, double first) {
    std::vector<double> times;
    for (int k = 0; first + k * period < end; ++k) times.push_back(first + k * period);
    return times;
}
std::vector<double> every(double period, double end) { return every(period, end, period); }

constexpr double gravity = 9.81;

/// Impacts before the end, at most `most`, of a ball that falls from x with acceleration `weight`.
std::vector<double> impacts(double x, double weight, double kept, double end, std::size_t most = 1000) {
    const double first = std::sqrt(2 * x / weight);
    std::vector<double> times;
    double flight = 2 * kept * first;
    for (double t = first; t < end && times.size() < most; t += flight, flight *= kept) times.push_back(t);
    return times;
}
crossing impact(int of_body, double kept, std::vector<double> times) {
    return {.source = 2 * of_body, .act = m::bounce, .kept = kept, .times = std::move(times)};
}
crossing wall(int of_body, double at, std::vector<double> times) {
    return {.source = 2 * of_body, .level = at, .act = m::turn, .kept = 1, .times = std::move(times)};
}

std::vector<motion> all_motions() {
    std::vector<motion> all;
    const auto resets = [](int of_body, double level, std::vector<double> times) {
        return crossing{.source = 2 * of_body, .level = level, .act = m::set, .times = std::move(times)};
    };
    all.push_back({.name = "saw", .bodies = {{.rate = 1}}, .crossings = {resets(0, 1, every(1, 20.5))}, .end = 20.5});
    all.push_back({.name = "long saw",
                   .bodies = {{.rate = 1}},
                   .crossings = {resets(0, 1, every(1, 300.5))},
                   .end = 300.5,
                   .needs = precision::double_alone});
    all.push_back({.name = "saw that keeps the remainder",
                   .bodies = {{.rate = 0.7}},
                   .crossings = {{.level = 1, .act = m::subtract, .value = 1, .times = every(1 / 0.7, 20.1)}},
                   .end = 20.1});
    all.push_back({.name = "wrap",
                   .bodies = {{.rate = 2.5}},
                   .crossings = {{.level = 2 * pi, .act = m::subtract, .value = 2 * pi, .times = every(0.8 * pi, 20)}},
                   .end = 20,
                   .amplified = 2});
    all.push_back({.name = "two wraps at one instant",
                   .bodies = {{.rate = 2.5}, {.rate = -2.5}},
                   .crossings = {resets(0, 2 * pi, every(0.8 * pi, 20)), resets(1, -2 * pi, every(0.8 * pi, 20))},
                   .end = 20,
                   .amplified = 2});
    const double interval = std::log(3.0);
    all.push_back({.name = "neuron",
                   .bodies = {{.rate = 1.5, .decay = 1}},
                   .crossings = {resets(0, 1, every(interval, 10))},
                   .end = 10,
                   .exact = false});
    all.push_back({.name = "two neurons at one instant",
                   .bodies = {{.rate = 1.5, .decay = 1}, {.rate = 4.5, .decay = 1}},
                   .crossings = {resets(0, 1, every(interval, 10)), resets(1, 3, every(interval, 10))},
                   .end = 10,
                   .exact = false});
    // x is 1 at 1 and 2 and pushes y by 0.2, which is 1 at 0.5, 1.3 and 2.1
    all.push_back({.name = "one that pushes another",
                   .bodies = {{.rate = 1}, {.x = 0.5, .rate = 1}},
                   .crossings = {{.level = 1, .act = m::set_and_push, .value = 0.2, .times = {1, 2}},
                                 resets(1, 1, {0.5, 1.3, 2.1})},
                   .end = 2.9,
                   .amplified = 2});
    const auto landing = [](double end, double kept) { return impacts(1, gravity, kept, end); };
    all.push_back({.name = "ball",
                   .bodies = {{.x = 1, .weight = -gravity}},
                   .crossings = {impact(0, 0.8, landing(3.5, 0.8))},
                   .end = 3.5,
                   .amplified = 20});
    motion left = all.back();
    left.name = "ball whose height is left as it was located";
    left.crossings[0].act = m::turn;
    left.amplified = 40;
    all.push_back(left);
    all.push_back({.name = "two balls that land together",
                   .bodies = {{.x = 1, .weight = -gravity}, {.x = 1.0 / 3, .weight = -gravity / 3}},
                   .crossings = {impact(0, 0.8, landing(3.5, 0.8)), impact(1, 0.8, landing(3.5, 0.8))},
                   .end = 3.5,
                   .amplified = 20});
    motion four = all.back();
    four.name = "four balls that land together";
    four.bodies.push_back({.x = 2, .weight = -gravity * 2});
    four.bodies.push_back({.x = 0.7, .weight = -gravity * 0.7});
    for (int b = 2; b < 4; ++b) four.crossings.push_back(impact(b, 0.8, landing(3.5, 0.8)));
    all.push_back(four);
    all.push_back({.name = "two balls that land together once",
                   .bodies = {{.x = 1, .weight = -gravity}, {.x = 1.0 / 3, .weight = -gravity / 3}},
                   .crossings = {impact(0, 0.8, landing(1.3, 0.8)), impact(1, 0.5, landing(1.3, 0.5))},
                   .end = 1.3,
                   .amplified = 20});
    all.push_back({.name = "ball that comes to rest",
                   .bodies = {{.x = 1, .weight = -gravity}},
                   .crossings = {impact(0, 0.5, impacts(1, gravity, 0.5, 3, 8))},
                   .end = 3,
                   .amplified = 20,
                   .status = myriad::status::event_accumulation,
                   .open_end = true,
                   .final_time = 3 * std::sqrt(2 / gravity),
                   .splits = false});
    const double up = std::asin(0.3), down = pi - up;
    std::vector<double> both = every(2 * pi, 20, up);
    for (const double t : every(2 * pi, 20, down)) both.push_back(t);
    std::sort(both.begin(), both.end());
    all.push_back({.name = "levels of a sine",
                   .bodies = {{.v = 1, .spring = 1}},
                   .crossings = {{.level = 0.3, .times = both}, {.source = 1, .times = every(pi, 20, pi / 2)}},
                   .end = 20,
                   .exact = false});
    all.push_back({.name = "section through the start",
                   .bodies = {{.x = 1, .spring = 1}},
                   .crossings = {{.source = 1, .times = every(pi, 20)}},
                   .end = 20,
                   .exact = false});
    const double warm_up = std::log(2 / 0.8), half_period = std::log(1.5);
    all.push_back(
        {.name = "thermostat",
         .bodies = {{.rate = 2, .decay = 1}},
         .crossings = {{.level = 1.2, .act = m::other_mode, .only_in = 0, .times = every(2 * half_period, 5, warm_up)},
                       {.level = 0.8,
                        .act = m::other_mode,
                        .only_in = 1,
                        .times = every(2 * half_period, 5, warm_up + half_period)}},
         .end = 5,
         .exact = false});
    // v' = t - 2 from 1.5 is zero at 1; what holds it gives way at 3
    all.push_back({.name = "block that sticks and slips",
                   .bodies = {{.x = 1.5, .rate = -2}},
                   .crossings = {{.act = m::stick, .only_in = 0, .times = {1}},
                                 {.source = m::n_state, .level = 3, .act = m::other_mode, .only_in = 1, .times = {3}}},
                   .end = 5,
                   .amplified = 4,
                   .ramp = 1});
    all.push_back({.name = "ball between two walls",
                   .bodies = {{.x = 0.25, .v = 1}},
                   .crossings = {wall(0, 0, every(2, 20, 1.75)), wall(0, 1, every(2, 20, 0.75))},
                   .end = 20,
                   .amplified = 4});
    all.push_back({.name = "corners",
                   .bodies = {{.x = 0.25, .v = 1}, {.x = 0.75, .v = 3}},
                   .crossings = {wall(0, 0, every(2, 20, 1.75)), wall(0, 1, every(2, 20, 0.75)),
                                 wall(1, 0, every(2, 20, 1.75)), wall(1, 3, every(2, 20, 0.75))},
                   .end = 20,
                   .amplified = 8});
    motion valve{.name = "valve that starts on its seat",
                 .bodies = {{.v = 2, .weight = -1, .spring = 1}},
                 .crossings = {impact(0, 0.8, {})},
                 .end = 8.5,
                 .amplified = 2,
                 .exact = false};
    for (double t = 2 * std::atan(2.0), speed = 1.6; t < valve.end; t += 2 * std::atan(speed), speed *= 0.8)
        valve.crossings[0].times.push_back(t);
    all.push_back(valve);
    all.push_back({.name = "turned round at the surface",
                   .bodies = {{.x = -1, .rate = 1}},
                   .crossings = {{.act = m::other_mode, .times = {1}}},
                   .end = 3,
                   .other_rate = -1});
    all.push_back(
        {.name = "passed", .bodies = {{.x = -1, .rate = 1}}, .crossings = {{.level = 0, .times = {1}}}, .end = 3});
    all.push_back({.name = "several levels",
                   .bodies = {{.rate = 1}},
                   .crossings = {{.level = 0.5, .times = {0.5}},
                                 {.level = 0.7, .times = {0.7}},
                                 {.level = 0.5, .times = {0.5}},
                                 {.level = 0.7 + 1e-9, .times = {0.7 + 1e-9}}},
                   .end = 2,
                   .needs = precision::double_alone});
    all.push_back({.name = "moved past a level by an action",
                   .bodies = {{.rate = 1}, {.x = 1.2, .rate = -1}},
                   .crossings = {{.level = 1, .act = m::push, .value = 1.25, .times = {1}},
                                 {.source = 2, .level = 0.5, .times = {0.7, 1.95}}},
                   .end = 3,
                   .amplified = 2});
    all.push_back({.name = "zero at the start",
                   .bodies = {{.rate = 1}, {.rate = -1}},
                   .crossings = {{}, {.source = 2}, {.source = m::n_state}},
                   .end = 2});
    all.push_back({.name = "time at the end",
                   .bodies = {{.rate = 1}},
                   .crossings = {{.source = m::n_state, .level = 1, .times = {1}}},
                   .end = 1,
                   .splits = false});
    all.push_back({.name = "state at the end",
                   .bodies = {{.rate = 1}},
                   .crossings = {{.level = 1, .times = {1}}},
                   .end = 1,
                   .splits = false,
                   .jumps = false});
    return all;
}

/// Crossings of which a step sees two or none, unless it looks where functions turn back.
std::vector<motion> touches() {
    std::vector<motion> all;
    const double half = pi / 2 - std::asin(1 - 1e-8);
    all.push_back({.name = "touch of a sine",
                   .bodies = {{.v = 1, .spring = 1}},
                   .crossings = {{.level = 1 - 1e-8, .times = {pi / 2 - half, pi / 2 + half}}},
                   .end = 3,
                   .amplified = 100,
                   .exact = false,
                   .needs = precision::double_alone,
                   .jumps = false});
    all.push_back({.name = "touches of a parabola",
                   .bodies = {{.v = 2, .weight = -2}},
                   .crossings = {{.level = 1 - 1e-4, .times = {1 - 1e-2, 1 + 1e-2}},
                                 {.level = 1 - 1e-6, .times = {1 - 1e-3, 1 + 1e-3}},
                                 {.level = 1 + 1e-6}},
                   .end = 2.5,
                   .amplified = 1000,
                   .needs = precision::double_alone,
                   .jumps = false});
    return all;
}

/// A motion as an instance: which crossing each slot has, a second time only to count, and the factor of its functions.
struct instance {
    const motion* of = nullptr;
    std::vector<int> slots;  // the crossing; n + the crossing for its double; -1: none
    double factor = 1;
};

std::vector<int> as_written(const motion& one) {
    std::vector<int> slots;
    for (int j = 0; j < m::slots; ++j) slots.push_back(j < static_cast<int>(one.crossings.size()) ? j : -1);
    return slots;
}

/// What of a call differs from the motion as it is written.
struct change {
    int form = m::plain;
    double state_unit = 1, time_unit = 1;
    double first_step = 0, largest_step = 0.5;
    double tolerance = 0;  // of events, as a value of source - level
    int calls = 1;         // of random lengths, which go on from each other
    double cut = 0;        // where the first of two calls ends, if it is given
    int sub_samples = 1;
};

template <class R>
constexpr double epsilon = static_cast<double>(std::numeric_limits<R>::epsilon());

template <class Model, class R>
myriad::ensemble<Model, R> ensemble_of(const std::vector<instance>& instances, const change& with) {
    myriad::ensemble<Model, R> e(static_cast<std::int64_t>(instances.size()));
    e.shared(m::state_unit) = static_cast<R>(with.state_unit);
    e.shared(m::per_state_unit) = static_cast<R>(1 / with.state_unit);
    e.shared(m::time_unit) = static_cast<R>(with.time_unit);
    e.shared(m::per_time_unit) = static_cast<R>(1 / with.time_unit);
    e.shared_integer(m::form) = with.form;
    for (std::size_t n = 0; n < instances.size(); ++n) {
        const auto i = static_cast<Eigen::Index>(n);
        const motion& of = *instances[n].of;
        for (int c = 0; c < m::n_parameter; ++c) e.parameter(c)[i] = R(0);
        for (int c = 0; c < m::n_state; ++c) e.state(c)[i] = R(0);
        for (int c = 0; c < m::n_integer_accessory; ++c) e.integer_accessory(c)[i] = 0;
        for (int c = 0; c < m::n_accessory; ++c) e.accessory(c)[i] = R(0);
        for (int b = 0; b < static_cast<int>(of.bodies.size()); ++b) {
            const body& one = of.bodies[static_cast<std::size_t>(b)];
            e.state(2 * b)[i] = static_cast<R>(one.x * with.state_unit);
            e.state(2 * b + 1)[i] = static_cast<R>(one.v * with.state_unit);
            e.parameter(m::rate + b)[i] = static_cast<R>(one.rate);
            e.parameter(m::other_rate + b)[i] = static_cast<R>(b == 0 ? of.other_rate : one.rate);
            e.parameter(m::decay + b)[i] = static_cast<R>(one.decay);
            e.parameter(m::weight + b)[i] = static_cast<R>(one.weight);
            e.parameter(m::spring + b)[i] = static_cast<R>(one.spring);
        }
        e.parameter(m::ramp)[i] = static_cast<R>(of.ramp);
        e.parameter(m::factor)[i] = static_cast<R>(instances[n].factor);
        const int crossings = static_cast<int>(of.crossings.size());
        for (int j = 0; j < m::slots; ++j) {
            const int which = instances[n].slots[static_cast<std::size_t>(j)];
            const bool doubled = which >= crossings;
            const crossing c =
                which < 0 ? crossing{.source = -1} : of.crossings[static_cast<std::size_t>(which % crossings)];
            e.integer_accessory(m::source + j)[i] = c.source;
            e.integer_accessory(m::only_in + j)[i] = c.only_in;
            e.integer_accessory(m::act + j)[i] = doubled ? m::nothing : c.act;
            e.parameter(m::level + j)[i] = static_cast<R>(c.level);
            e.parameter(m::value + j)[i] = static_cast<R>(c.value);
            e.parameter(m::kept + j)[i] = static_cast<R>(c.kept);
        }
        e.t_begin()[i] = R(0);
        e.t_end()[i] = static_cast<R>(of.end * with.time_unit);
    }
    return e;
}

template <class R>
myriad::options options_of(const std::vector<instance>& instances, const change& with) {
    const double unit = std::abs(with.time_unit), error = std::is_same_v<R, double> ? 1e-12 : 1e-6;
    myriad::options o;
    o.relative_tolerance = error;
    o.absolute_tolerance = error * with.state_unit;
    o.maximum_step = with.largest_step * unit;
    o.sub_samples = with.sub_samples;
    if (with.first_step != 0) o.step = with.first_step * unit;
    if (with.tolerance != 0)
        o.events.assign(m::n_event, myriad::event_options{.tolerance = with.tolerance * instances[0].factor});
    return o;
}

template <class Model, class Method, class R>
myriad::ensemble<Model, R> solved(const std::vector<instance>& instances, const change& with) {
    auto e = ensemble_of<Model, R>(instances, with);
    myriad::options o = options_of<R>(instances, with);
    o.advice = myriad::advice::off;
    std::mt19937_64 engine(42);
    std::uniform_real_distribution<double> part(0, 1);
    std::vector<std::vector<double>> ends(instances.size());
    for (std::size_t n = 0; n < instances.size(); ++n) {
        for (int call = 1; call < with.calls; ++call)
            ends[n].push_back(with.cut != 0 ? with.cut : part(engine) * instances[n].of->end);
        std::sort(ends[n].begin(), ends[n].end());
        ends[n].push_back(instances[n].of->end);
    }
    if (with.calls > 1) o.phase_time = myriad::phase_time::carry_on;
    for (int call = 0; call < with.calls; ++call) {
        for (std::size_t n = 0; n < instances.size(); ++n)
            e.t_end()[static_cast<Eigen::Index>(n)] =
                static_cast<R>(ends[n][static_cast<std::size_t>(call)] * with.time_unit);
        myriad::solve<Method>(tests::test_device(1), e, o);
    }
    return e;
}

/// What is wrong with an instance, or nothing.
template <class Model, class R>
std::string fault(const myriad::ensemble<Model, R>& e, const instance& one, std::int64_t i, const change& with) {
    const motion& of = *one.of;
    std::ostringstream text;
    text.precision(std::is_same_v<R, double> ? 17 : 9);
    if (e.status(i) != of.status) text << " status " << static_cast<int>(e.status(i));
    const double t = static_cast<double>(e.t()[i]) / with.time_unit;
    const double rest = std::is_same_v<R, double> ? 1e-6 : 1e-2;  // of the flights that are left
    if (!(std::abs(t - (of.final_time != 0 ? of.final_time : of.end)) <=
          (of.final_time != 0 ? rest : epsilon<R> * of.end)))
        text << " ends at " << t;
    const int crossings = static_cast<int>(of.crossings.size());
    for (int j = 0; j < m::slots; ++j) {
        const int which = one.slots[static_cast<std::size_t>(j)];
        const int count = e.integer_accessory(m::count + j)[i];
        static const std::vector<double> none;
        const auto& times = which < 0 ? none : of.crossings[static_cast<std::size_t>(which % crossings)].times;
        const int right = static_cast<int>(times.size());
        if (of.open_end ? count < right : count != right)
            text << " event " << j << " fires " << count << " times, right " << right;
        for (int k = 0; k < std::min({count, right, int(m::log_length)}); ++k) {
            const double found = static_cast<double>(e.accessory(m::at + j * m::log_length + k)[i]) / with.time_unit;
            const double expected = times[static_cast<std::size_t>(k)];
            // Polynomials are integrated to rounding: 64 roundings of the largest number there is, for each event
            // before; others to the error of the method, 1e-10 at the tolerance 1e-12 and 1e-4 at 1e-6. A function is
            // within its tolerance for at most a thousand times as long.
            const double located = 1e3 * with.tolerance;
            const double bound = ((of.exact                    ? 64 * epsilon<R> * std::max(expected, 2 * pi)
                                   : std::is_same_v<R, double> ? 1e-10
                                                               : 1e-4) +
                                  located) *
                                 of.amplified * (k + 1);
            if (!(std::abs(found - expected) <= bound))
                text << " event " << j << " no. " << k + 1 << " at " << found << ", right " << expected << " within "
                     << bound;
        }
        for (int before = 0; before < j && which >= 0; ++before) {
            const int other = one.slots[static_cast<std::size_t>(before)];
            if (other < 0 || other % crossings != which % crossings) continue;
            for (int k = 0; k < std::min(right, int(m::log_length)); ++k)
                if (e.accessory(m::at + j * m::log_length + k)[i] != e.accessory(m::at + before * m::log_length + k)[i])
                    text << " doubles at different times";
        }
    }
    return text.str();
}

const char* const form_names[] = {"g",         "c g",         "g^3",   "sinh(k g)", "exp(k g) - 1",
                                  "atan(k g)", "g (1 + t^2)", "g |g|", "root of g", "sign of g"};

/// The factors to try with each form. Trial steps reach |g| = 7, where the functions are still numbers.
template <class R>
std::vector<double> factors_of(int form) {
    const bool wide = std::is_same_v<R, double>;
    switch (form) {
        case m::scaled:
            return wide ? std::vector{1e-300, 1e-100, 1e-30, 1e-8, 1e8, 1e30, 1e100, 1e300}
                        : std::vector{1e-30, 1e-20, 1e-8, 1e8, 1e20, 1e30};
        case m::sinh:
            return wide ? std::vector{2.0, 30.0, 50.0} : std::vector{2.0, 8.0};
        case m::exp_minus_1:
            return wide ? std::vector{2.0, 8.0, 30.0} : std::vector{2.0, 8.0};
        case m::atan:
            return {1.0, 1e6};
        default:
            return {1.0};
    }
}

const std::vector<motion>& motions() {
    static const std::vector<motion> all = all_motions();
    return all;
}

/// All motions, with all factors of a form.
template <class R>
std::vector<instance> all_with(int form) {
    std::vector<instance> instances;
    for (const double factor : factors_of<R>(form))
        for (const motion& one : motions())
            if ((std::is_same_v<R, double> || one.needs == precision::any) && (form != m::jump || one.jumps))
                instances.push_back({.of = &one, .slots = as_written(one), .factor = factor});
    return instances;
}

/// Counts the cases of a test and those that fail, prints both, and what is wrong with the first ones.
class tally {
public:
    explicit tally(std::string what) : what_(std::move(what)) {}
    void add(const std::string& wrong, const std::string& which) {
        ++run_;
        if (wrong.empty()) return;
        ++failed_;
        if (failed_ <= 40) std::cout << "  " << which << ":" << wrong << '\n';
    }
    template <class Model, class R>
    void add_all(const myriad::ensemble<Model, R>& e, const std::vector<instance>& instances, const change& with,
                 const std::string& more = "") {
        for (std::size_t n = 0; n < instances.size(); ++n) {
            std::ostringstream which;
            which << instances[n].of->name << ", " << form_names[with.form] << ", " << instances[n].factor << more;
            add(fault(e, instances[n], static_cast<std::int64_t>(n), with), which.str());
        }
    }
    void check() {
        std::cout << "metamorphic events, " << what_ << ": " << run_ << " cases, " << failed_ << " failed\n";
        CHECK(run_ > 0);
        CHECK(failed_ == 0);
    }

private:
    std::string what_;
    int run_ = 0, failed_ = 0;
};

template <class Model, class Method, class R>
void check_forms(const std::string& what) {
    tally cases(what);
    for (int form = 0; form < m::n_form; ++form) {
        const auto instances = all_with<R>(form);
        const change with{.form = form};
        cases.add_all(solved<Model, Method, R>(instances, with), instances, with);
    }
    cases.check();
}

const int some_forms[] = {m::plain, m::cubed, m::sinh};

/// The same change made with some forms, each with its largest factor.
template <class Change>
void check_change(const std::string& what, Change changed) {
    tally cases(what);
    for (const int form : some_forms) {
        std::vector<instance> instances;
        for (const motion& one : motions())
            instances.push_back({.of = &one, .slots = as_written(one), .factor = factors_of<double>(form).back()});
        changed(cases, instances, form);
    }
    cases.check();
}

using tsit = myriad::tsitouras_5;

template <class R>
bool same_bits(const R& a, const R& b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
}

/// Whether what an instance has become is the same, to the bit, in both ensembles, whose units may differ.
template <class Model, class R>
std::string difference(const myriad::ensemble<Model, R>& a, std::int64_t i, const myriad::ensemble<Model, R>& b,
                       std::int64_t j, double state_unit = 1, double time_unit = 1) {
    if (a.status(i) != b.status(j)) return " statuses differ";
    for (int c = 0; c < m::slots; ++c)
        if (a.integer_accessory(m::count + c)[i] != b.integer_accessory(m::count + c)[j]) return " counts differ";
    if (!same_bits(a.t()[i], static_cast<R>(b.t()[j] / static_cast<R>(time_unit)))) return " ends differ";
    for (int c = 0; c < m::n_state; ++c)
        if (a.state(c)[i] != b.state(c)[j] / static_cast<R>(state_unit)) return " states differ";
    for (int c = 0; c < m::n_accessory; ++c)
        if (a.accessory(c)[i] != b.accessory(c)[j] / static_cast<R>(time_unit)) return " times differ";
    return "";
}

}  // namespace

TEST_CASE("metamorphic events: the same sign has the same events, in packs") {
    check_forms<metamorphic, tsit, double>("packs");
}

TEST_CASE("metamorphic events: the same sign has the same events, with cash_karp") {
    check_forms<metamorphic, myriad::cash_karp, double>("packs, cash_karp");
}

TEST_CASE("metamorphic events: the same sign has the same events, one lane at a time") {
    check_forms<metamorphic_alone, tsit, double>("single lanes");
}

TEST_CASE("metamorphic events: the same sign has the same events, in single precision") {
    check_forms<metamorphic, tsit, float>("packs, float");
}

TEST_CASE("metamorphic events: the order of the events, and events that are there twice, change nothing") {
    check_change("permuted and doubled", [](tally& cases, const std::vector<instance>& plain, int form) {
        std::mt19937_64 engine(7);
        std::vector<instance> instances;
        for (const instance& one : plain) {
            for (int k = 0; k < 4; ++k) {
                instance other = one;
                const int n = static_cast<int>(one.of->crossings.size());
                for (int j = 0; j < n && n + j < m::slots; ++j) other.slots[static_cast<std::size_t>(n + j)] = n + j;
                std::shuffle(other.slots.begin(), other.slots.end(), engine);
                instances.push_back(other);
            }
        }
        const change with{.form = form};
        cases.add_all(solved<metamorphic, tsit, double>(instances, with), instances, with);
    });
}

TEST_CASE("metamorphic events: units that are powers of two change no bit") {
    check_change("units", [](tally& cases, const std::vector<instance>& instances, int form) {
        for (const double first_step : {0.0, 1.0 / 1024}) {
            const auto base = solved<metamorphic, tsit, double>(instances, {.form = form, .first_step = first_step});
            for (const auto& [state_unit, time_unit] :
                 {std::pair{0x1p20, 1.0}, {0x1p-20, 1.0}, {1.0, 0x1p20}, {1.0, 0x1p-30}, {0x1p-100, 0x1p100}}) {
                const change with{
                    .form = form, .state_unit = state_unit, .time_unit = time_unit, .first_step = first_step};
                const auto e = solved<metamorphic, tsit, double>(instances, with);
                for (std::size_t n = 0; n < instances.size(); ++n) {
                    const auto i = static_cast<std::int64_t>(n);
                    std::ostringstream which;
                    which << instances[n].of->name << ", " << form_names[form] << ", units " << state_unit << " and "
                          << time_unit << ", first step " << first_step;
                    cases.add(difference(base, i, e, i, state_unit, time_unit), which.str());
                }
            }
        }
    });
}

TEST_CASE("metamorphic events: backwards in time the same happens") {
    check_change("backwards", [](tally& cases, const std::vector<instance>& instances, int form) {
        const change with{.form = form, .time_unit = -1};
        cases.add_all(solved<metamorphic, tsit, double>(instances, with), instances, with);
    });
}

TEST_CASE("metamorphic events: a domain cut at random times has the same events") {
    check_change("cut into calls", [](tally& cases, const std::vector<instance>& all, int form) {
        std::vector<instance> instances;
        for (const instance& one : all)
            if (one.of->splits) instances.push_back(one);
        for (const int calls : {2, 5, 17}) {
            const change with{.form = form, .calls = calls};
            cases.add_all(solved<metamorphic, tsit, double>(instances, with), instances, with,
                          ", calls " + std::to_string(calls));
        }
    });
}

TEST_CASE("metamorphic events: what happens where one call ends and the next begins happens once") {
    tally cases("end of a call");
    motion clock{.name = "clock",
                 .bodies = {{.rate = 1}, {.x = -1, .rate = 1}},
                 .crossings = {{.source = m::n_state, .level = 1, .times = {1}},
                               {.level = 1, .times = {1}},
                               {.source = 2, .act = m::set, .value = -1, .times = {1, 2}}},
                 .end = 2.5,
                 .amplified = 2};
    for (int form = 0; form < m::n_form; ++form) {
        for (const double cut : {1.0, 2.0}) {
            std::vector<instance> instances;
            for (const double factor : factors_of<double>(form))
                instances.push_back({.of = &clock, .slots = as_written(clock), .factor = factor});
            const change with{.form = form, .calls = 2, .cut = cut};
            cases.add_all(solved<metamorphic, tsit, double>(instances, with), instances, with,
                          ", cut at " + std::to_string(cut));
        }
    }
    cases.check();
}

TEST_CASE("metamorphic events: neighbours in the pack change no bit") {
    check_change("neighbours", [](tally& cases, const std::vector<instance>& instances, int form) {
        const change with{.form = form};
        const auto base = solved<metamorphic, tsit, double>(instances, with);
        std::mt19937_64 engine(5);
        std::vector<std::size_t> order;
        for (std::size_t n = 0; n < instances.size(); ++n) order.push_back(n);
        for (int k = 0; k < 3; ++k) {
            std::shuffle(order.begin(), order.end(), engine);
            std::vector<instance> shuffled;
            for (const std::size_t n : order) shuffled.push_back(instances[n]);
            const auto e = solved<metamorphic, tsit, double>(shuffled, with);
            for (std::size_t n = 0; n < order.size(); ++n)
                cases.add(difference(base, static_cast<std::int64_t>(order[n]), e, static_cast<std::int64_t>(n)),
                          instances[order[n]].of->name + ", " + form_names[form]);
        }
    });
}

TEST_CASE("metamorphic events: other steps have the same events") {
    check_change("other steps", [](tally& cases, const std::vector<instance>& instances, int form) {
        for (const double step : {1e-9, 1e-6, 1e-3, 0.1, 0.5}) {
            const change with{.form = form, .first_step = step};
            cases.add_all(solved<metamorphic, tsit, double>(instances, with), instances, with,
                          ", first step " + std::to_string(step));
        }
        for (const double step : {0.01, 0.07, 0.3}) {
            const change with{.form = form, .largest_step = step};
            cases.add_all(solved<metamorphic, tsit, double>(instances, with), instances, with,
                          ", largest step " + std::to_string(step));
        }
    });
}

TEST_CASE("metamorphic events: with sub_samples a function that passes zero and comes back within a step fires twice") {
    static const std::vector<motion> all = touches();
    tally cases("touches");
    for (int form = 0; form < m::n_form; ++form) {
        if (form == m::jump) continue;  // has no slope where it turns
        std::vector<instance> instances;
        for (const double factor : factors_of<double>(form))
            for (const motion& one : all) instances.push_back({.of = &one, .slots = as_written(one), .factor = factor});
        for (const double step : {0.07, 0.3, 0.5}) {
            for (const int points : {2, 16}) {
                const change with{.form = form, .largest_step = step, .sub_samples = points};
                cases.add_all(solved<metamorphic, tsit, double>(instances, with), instances, with,
                              ", " + std::to_string(points) + " points");
            }
        }
    }
    cases.check();
}

TEST_CASE("metamorphic events: with a tolerance the same happens, to that tolerance") {
    tally cases("tolerances");
    for (const double factor : {1e-200, 1e-8, 1.0, 1e8, 1e200}) {
        for (const double tolerance : {1e-7, 1e-10}) {
            std::vector<instance> instances;
            for (const motion& one : motions())
                if (one.name != "several levels")
                    instances.push_back({.of = &one, .slots = as_written(one), .factor = factor});
            const change with{.form = m::scaled, .tolerance = tolerance};
            cases.add_all(solved<metamorphic, tsit, double>(instances, with), instances, with,
                          ", tolerance " + std::to_string(tolerance));
        }
    }
    cases.check();
}
