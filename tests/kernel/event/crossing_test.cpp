// SPDX-License-Identifier: MIT
// Where a function crosses zero, from its values and slopes at both ends of a step.
#include "myriad/kernel/event/crossing.hpp"

#include <cmath>
#include <limits>

#include "tests/catch.hpp"

namespace {

using myriad::detail::crossing_fraction;
using myriad::detail::cubic_root;
using myriad::detail::function_ends;

template <class R>
R crossing_from_above(const function_ends<R>& g) {
    return crossing_fraction(g, R(0));
}

constexpr double epsilon = std::numeric_limits<double>::epsilon();

TEST_CASE("the crossing of a cubic is found to rounding, wherever in the step it is") {
    for (const double root : {1e-9, 1e-3, 0.1, 0.5, 0.9, 0.999}) {
        CAPTURE(root);
        // (root - x) (1 + x + x^2), which has no other root
        const double end = 3 * (root - 1);
        const function_ends<double> g{root, root - 1, end, 3 * (root - 1) - 3};
        CHECK(std::abs(crossing_from_above(g) - root) <= 8 * epsilon);
    }
}

TEST_CASE("the crossing of a function that is no cubic is off by the fourth power of the step") {
    const auto off = [](double h) {
        const double at = 1;  // of cos(x + pi / 2 - 1) in x, over [1 - h / 3, 1 + 2 h / 3]
        const double begin = at - h / 3, end = at + 2 * h / 3;
        const function_ends<double> g{std::sin(at - begin), -h * std::cos(at - begin), std::sin(at - end),
                                      -h * std::cos(at - end)};
        return std::abs(begin + h * crossing_from_above(g) - at);
    };
    CHECK(off(0.2) <= 1e-5);
    CHECK(std::log2(off(0.4) / off(0.2)) >= 3.9);
}

TEST_CASE("a flight from the surface and back has the length that its speed and acceleration give") {
    for (const double flight : {1e-12, 1e-3, 0.5, 0.99}) {
        for (const double start : {0.0, 1e-17, -1e-17}) {
            CAPTURE(flight, start);
            const function_ends<double> g{start * flight, flight, flight - 1, flight - 2};  // x (flight - x)
            CHECK(std::abs(crossing_fraction(g, 0.0) - flight) <= 4 * epsilon);
        }
    }
}

TEST_CASE("a flat flight from the surface and back has the length that its slopes give") {
    for (const double flight : {1e-3, 0.5, 0.99}) {
        for (const double slope : {0.0, 1e-30, 1e-20}) {
            CAPTURE(flight, slope);
            const function_ends<double> g{-1e-46, slope, flight - 1, 2 * flight - 3};  // x^2 (flight - x)
            CHECK(std::abs(crossing_fraction(g, 0.0) - flight) <= 4 * epsilon);
        }
    }
}

TEST_CASE("the fraction lies inside the step, so that what is redone is shorter") {
    CHECK(crossing_from_above(function_ends<double>{1, -1, -1e-300, -1}) < 1);
    CHECK(crossing_from_above(function_ends<double>{1e-300, -1, -1, -1}) >= 0);
    CHECK(crossing_from_above(function_ends<float>{1, -1, -1e-30f, -1}) < 1);
}

TEST_CASE("slopes that cannot be, as those of stiff equations, still give a point inside") {
    for (const double slope : {-1e12, -1.0, 0.0, 1e12}) {
        for (const double end_slope : {-1e12, 0.0, 1e12}) {
            CAPTURE(slope, end_slope);
            const double x = crossing_from_above(function_ends<double>{1, slope, -1, end_slope});
            CHECK((x > 0 && x < 1));
        }
    }
    const double infinite = std::numeric_limits<double>::infinity();
    CHECK(crossing_from_above(function_ends<double>{infinite, 0, -1, 0}) == 0.5);
    CHECK(cubic_root(1.0, std::nan(""), 0.0, -2.0, 0.0) == 0.5);
}

}  // namespace
