// SPDX-License-Identifier: MIT
// Roots in brackets: found to rounding, in each lane separately, and the value returned if there is none.
#include "myriad/kernel/scalar/root_finder.hpp"

#include <cmath>

#include "myriad/kernel/scalar/pack.hpp"
#include "tests/catch.hpp"

namespace {

using myriad::select;
using myriad::detail::bracket;
using myriad::detail::find_root;
using myriad::detail::get_lane;
using myriad::detail::set_lane;
using pack = myriad::pack<double, 2>;

constexpr double eps = 2.3e-16;

/// A bracket of a decreasing function.
template <class F>
bracket<double> around(double low, double high, F&& f) {
    return {low, high, f(low), f(high)};
}

TEST_CASE("a root is found to rounding where nothing counts as close") {
    const auto f = [](double x) { return 2 - x * x; };
    const double root = find_root(around(1, 2, f), true, [&](double x, bool&) { return f(x); });
    CHECK(std::abs(root - std::sqrt(2.0)) <= 8 * eps);
    CHECK(f(root) >= -eps);
}

TEST_CASE("the first value that counts as close is returned") {
    const auto f = [](double x) { return 1 - x * x * x * x; };
    int calls = 0;
    const double root = find_root(around(0, 3, f), true, [&](double x, bool& close) {
        ++calls;
        close = std::abs(f(x)) < 1e-3;
        return f(x);
    });
    CHECK(std::abs(f(root)) < 1e-3);
    CHECK(calls < 20);
}

TEST_CASE("a jump through zero is found from below, where the function is positive") {
    const auto f = [](double x) { return x < 0.3 ? 1.0 : -2.0; };
    const double root = find_root(around(0, 1, f), true, [&](double x, bool&) { return f(x); });
    CHECK(root < 0.3);
    CHECK(root > 0.3 - 1e-12);
}

TEST_CASE("a nearly flat function does not leave the secant stuck at one end") {
    const auto f = [](double x) { return 1e-3 - std::pow(x, 15); };
    int calls = 0;
    const double root = find_root(around(0, 10, f), true, [&](double x, bool&) {
        ++calls;
        return f(x);
    });
    CHECK(std::abs(root - std::pow(1e-3, 1.0 / 15)) <= 1e-14);
    CHECK(calls < 64);
}

TEST_CASE("lanes have their own roots, and those that are not wanted return the upper end") {
    pack square, high;
    for (int i = 0; i < pack::lanes; ++i) {
        set_lane(square, i, 1.0 + i);
        set_lane(high, i, 2.0 + i);
    }
    const auto f = [&](const pack& x) { return square - x * x; };
    const bracket<pack> b{pack(0.5), high, f(pack(0.5)), f(high)};
    const pack root = find_root(b, square > pack(1.5), [&](const pack& x, auto&) { return f(x); });
    CHECK(get_lane(root, 0) == 2);
    for (int i = 1; i < pack::lanes; ++i) {
        CAPTURE(i);
        CHECK(std::abs(get_lane(root, i) - std::sqrt(1.0 + i)) <= 16 * eps * std::sqrt(1.0 + i));
    }
}

}  // namespace
