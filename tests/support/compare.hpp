// SPDX-License-Identifier: MIT
// Ensembles compared bit for bit, and a test run for every method. Host test files only.
#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <type_traits>

#include "myriad/myriad.hpp"
#include "tests/catch.hpp"

namespace compare {

/// The same bits: NaN equals the same NaN here, and 0 differs from -0.
template <class T>
bool same_bits(T a, T b) {
    if constexpr (std::is_floating_point_v<T>) {
        using bits = std::conditional_t<sizeof(T) == 8, std::uint64_t, std::uint32_t>;
        return std::bit_cast<bits>(a) == std::bit_cast<bits>(b);
    } else {
        return a == b;
    }
}

/// Compares all results of instance i in one ensemble with instance j in another: the difference as text, or nothing.
template <class Model, class R>
std::string difference(const myriad::ensemble<Model, R>& a, std::int64_t i, const myriad::ensemble<Model, R>& b,
                       std::int64_t j) {
    std::string differs;
    const auto compare = [&](const char* what, int c, auto x, auto y) {
        if (!same_bits(x, y)) differs += myriad::message(' ', what, ' ', c, ": ", x, " != ", y, ';');
    };
    for (int c = 0; c < myriad::detail::n_state<Model>; ++c) compare("state", c, a.state(c)[i], b.state(c)[j]);
    for (int c = 0; c < myriad::detail::n_accessory<Model>; ++c)
        compare("accessory", c, a.accessory(c)[i], b.accessory(c)[j]);
    for (int c = 0; c < myriad::detail::n_integer_accessory<Model>; ++c)
        compare("integer accessory", c, a.integer_accessory(c)[i], b.integer_accessory(c)[j]);
    compare("t", 0, a.t()[i], b.t()[j]);
    compare("next step", 0, a.next_step()[i], b.next_step()[j]);
    compare("phases done", 0, a.phases_done()[i], b.phases_done()[j]);
    compare("status", 0, static_cast<int>(a.status(i)), static_cast<int>(b.status(j)));
    if (a.counted() && b.counted()) {
        compare("accepted steps", 0, a.accepted_steps()[i], b.accepted_steps()[j]);
        compare("rejected steps", 0, a.rejected_steps()[i], b.rejected_steps()[j]);
        compare("located steps", 0, a.located_steps()[i], b.located_steps()[j]);
        compare("evaluations", 0, a.rhs_evaluations()[i], b.rhs_evaluations()[j]);
    }
    return differs.empty() ? differs : myriad::message("instance ", i, ':', differs);
}

/// The first instance that differs, or nothing.
template <class Model, class R>
std::string difference(const myriad::ensemble<Model, R>& a, const myriad::ensemble<Model, R>& b) {
    if (a.size() != b.size()) return "sizes";
    for (std::int64_t i = 0; i < a.size(); ++i) {
        const std::string d = difference(a, i, b, i);
        if (!d.empty()) return d;
    }
    return {};
}

template <class A, class B>
bool same_bits_everywhere(const A& a, const B& b) {
    if (a.rows() != b.rows() || a.cols() != b.cols()) return false;
    for (Eigen::Index i = 0; i < a.rows(); ++i)
        for (Eigen::Index j = 0; j < a.cols(); ++j)
            if (!same_bits(a(i, j), b(i, j))) return false;
    return true;
}

/// Calls `test.operator()<Method>()` for every method, or for those with step-size control.
template <class Test>
void each_method(Test test) {
    {
        INFO("runge_kutta_4");
        test.template operator()<myriad::runge_kutta_4>();
    }
    {
        INFO("cash_karp");
        test.template operator()<myriad::cash_karp>();
    }
    {
        INFO("tsitouras_5");
        test.template operator()<myriad::tsitouras_5>();
    }
}
template <class Test>
void each_adaptive_method(Test test) {
    {
        INFO("cash_karp");
        test.template operator()<myriad::cash_karp>();
    }
    {
        INFO("tsitouras_5");
        test.template operator()<myriad::tsitouras_5>();
    }
}

/// Steps of length h only, for every method: tolerances that no error exceeds.
inline myriad::options fixed_step(double h) {
    myriad::options o;
    o.step = o.minimum_step = o.maximum_step = h;
    o.relative_tolerance = 0;
    o.absolute_tolerance = 1e30;
    return o;
}

/// Equal tolerances for adaptive methods, and a step for the others.
inline myriad::options with_tolerance(double tolerance, double fixed_step = 1.0 / 64) {
    myriad::options o;
    o.step = fixed_step;
    o.relative_tolerance = o.absolute_tolerance = tolerance;
    return o;
}

}  // namespace compare
