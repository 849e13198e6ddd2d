// SPDX-License-Identifier: MIT
// Sets up ensembles of the model `logged_motion` and reads its log, for the tests of events.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <numbers>
#include <vector>

#include <myriad/myriad.hpp>

#include "tests/kernel/event/logged_motion.hpp"
#include "tests/kernel/event/methods.hpp"
#include "tests/support/device.hpp"
#include "tests/support/prepared.hpp"

namespace logged_motions {

inline constexpr double pi = std::numbers::pi;
inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// One event function X x + V v + T t + Q (t - 1)^2 - c and the action when it fires.
struct function {
    double X = 0, V = 0, T = 0, Q = 0, c = 0;
    int action = logged_motion::log;
};
inline function position(double c = 0, int action = logged_motion::log) { return {.X = 1, .c = c, .action = action}; }
inline function velocity(double c = 0, int action = logged_motion::log) { return {.V = 1, .c = c, .action = action}; }
inline function time(double c, int action = logged_motion::log) { return {.T = 1, .c = c, .action = action}; }
inline function never() { return {.c = -1}; }

/// Start, acceleration a and stiffness k of x'' = a - k x.
struct motion {
    double x = 0, v = 0, a = 0, k = 0;
};
inline constexpr motion sine{.x = 0, .v = 1, .k = 1};    // x = sin t
inline constexpr motion cosine{.x = 1, .v = 0, .k = 1};  // x = cos t

/// Which event fired, and when.
struct firing {
    int event;
    double t;
};

template <class R = double>
myriad::ensemble<logged_motion, R> ensemble_of(const std::vector<motion>& starts,
                                               const std::array<function, 3>& functions, double t_begin, double t_end,
                                               double restitution = 1) {
    myriad::ensemble<logged_motion, R> e(static_cast<std::int64_t>(starts.size()));
    for (std::size_t n = 0; n < starts.size(); ++n) {
        const auto i = static_cast<Eigen::Index>(n);
        e.state(logged_motion::x)[i] = static_cast<R>(starts[n].x);
        e.state(logged_motion::v)[i] = static_cast<R>(starts[n].v);
        e.parameter(logged_motion::acceleration)[i] = static_cast<R>(starts[n].a);
        e.parameter(logged_motion::stiffness)[i] = static_cast<R>(starts[n].k);
    }
    e.shared(logged_motion::restitution) = static_cast<R>(restitution);
    for (int j = 0; j < 3; ++j) {
        const function& f = functions[static_cast<std::size_t>(j)];
        e.parameter(logged_motion::c0 + j) = static_cast<R>(f.c);
        const int base = logged_motion::n_event_shared * j;
        e.shared(base + logged_motion::of_x) = static_cast<R>(f.X);
        e.shared(base + logged_motion::of_v) = static_cast<R>(f.V);
        e.shared(base + logged_motion::of_t) = static_cast<R>(f.T);
        e.shared(base + logged_motion::of_square) = static_cast<R>(f.Q);
        e.shared_integer(logged_motion::action_0 + j) = f.action;
    }
    e.time_domain(static_cast<R>(t_begin), static_cast<R>(t_end));
    e.accessory(logged_motion::smallest_x) = std::numeric_limits<R>::infinity();
    e.accessory(logged_motion::beyond) = -std::numeric_limits<R>::infinity();
    e.accessory(logged_motion::gap) = -std::numeric_limits<R>::infinity();
    return e;
}

template <class R = double>
myriad::ensemble<logged_motion, R> ensemble_of(const motion& start, const std::array<function, 3>& functions,
                                               double t_begin, double t_end, double restitution = 1) {
    return ensemble_of<R>(std::vector<motion>{start}, functions, t_begin, t_end, restitution);
}

/// Everything instance i logged, in order.
template <class R>
std::vector<firing> log_of(const myriad::ensemble<logged_motion, R>& e, std::int64_t i = 0) {
    std::vector<firing> log;
    const int n = std::min<int>(e.integer_accessory(logged_motion::fired)[i], logged_motion::log_length);
    for (int k = 0; k < n; ++k)
        log.push_back({e.integer_accessory(logged_motion::which + k)[i],
                       static_cast<double>(e.accessory(logged_motion::at + k)[i])});
    return log;
}

/// How often instance i fired, whether or not the log had room.
template <class R>
int count_of(const myriad::ensemble<logged_motion, R>& e, std::int64_t i = 0) {
    return e.integer_accessory(logged_motion::fired)[i];
}

/// The times of one event.
template <class R>
std::vector<double> times_of(const myriad::ensemble<logged_motion, R>& e, int event = 0, std::int64_t i = 0) {
    std::vector<double> times;
    for (const firing& f : log_of(e, i))
        if (f.event == event) times.push_back(f.t);
    return times;
}

/// Whether both lists have the same length and agree within the tolerance; NaN agrees with nothing.
inline bool agree(const std::vector<double>& found, const std::vector<double>& expected, double tolerance) {
    if (found.size() != expected.size()) return false;
    for (std::size_t i = 0; i < found.size(); ++i)
        if (!(std::abs(found[i] - expected[i]) <= tolerance)) return false;
    return true;
}

/// Options with one event tolerance for all three functions and steps that suit fixed and adaptive methods.
inline myriad::options options_for(double event_tolerance, double step,
                                   myriad::direction d = myriad::direction::either) {
    myriad::options o;
    o.relative_tolerance = 1e-12;
    o.absolute_tolerance = 1e-12;
    o.step = step;
    o.events.assign(3, myriad::event_options{.direction = d, .tolerance = event_tolerance});
    return o;
}

template <class Method, class R>
auto solve(myriad::ensemble<logged_motion, R>& e, const myriad::options& o) {
    return myriad::solve<Method>(tests::test_device(1), e, o);
}

/// Without the checks of options, which refuse cases that fail only by rounding: the kernel itself, on the CPU.
template <class Method, class R>
void solve_unchecked(myriad::ensemble<logged_motion, R>& e, const myriad::options& o) {
    myriad::openmp::run<logged_motion, Method, R>(tests::prepare<Method>(e, o).arguments(), {});
}

}  // namespace logged_motions
