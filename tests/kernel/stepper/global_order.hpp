// SPDX-License-Identifier: MIT
// Order of convergence of whole integrations with fixed steps, measured on problems with exact solutions.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "myriad/myriad.hpp"
#include "tests/catch.hpp"
#include "tests/support/compare.hpp"
#include "tests/support/device.hpp"

namespace global_order {

using compare::fixed_step;

/// Root mean square error at the end of instances that start at different times, so that no symmetry hides an error
/// term.
template <class Method, class Model, class R = double>
double end_error(double h, double span) {
    myriad::ensemble<Model, R> e(16);
    constexpr int n = Model::n_state;
    for (std::int64_t i = 0; i < e.size(); ++i) {
        e.t_begin()[i] = static_cast<R>(0.5 + 0.125 * static_cast<double>(i));
        e.t_end()[i] = e.t_begin()[i] + static_cast<R>(span);
        const auto start = Model::exact(e.t_begin()[i]);
        for (int c = 0; c < n; ++c) e.state(c)[i] = start[c];
    }
    const auto report = myriad::solve<Method>(tests::test_device(1), e, fixed_step(h));
    REQUIRE(report.count(myriad::status::success) == e.size());
    // the step must be the requested one, or the order measured is not the method's
    REQUIRE(report.accepted_steps == e.size() * static_cast<std::int64_t>(std::lround(std::abs(span) / h)));
    REQUIRE(report.rejected_steps == 0);
    double squares = 0;
    for (std::int64_t i = 0; i < e.size(); ++i) {
        const auto end = Model::exact(static_cast<double>(e.t_end()[i]));
        for (int c = 0; c < n; ++c) squares += std::pow(static_cast<double>(e.state(c)[i]) - end[c], 2);
    }
    return std::sqrt(squares / static_cast<double>(e.size()));
}

struct window {
    double below, above;
};

/// The global error is C h^order (1 + O(h)).
template <class Method, class Model, class R = double>
void check_order(double order, double first_h, double span, window allowed = {0.1, 0.1}) {
    double h = first_h, coarse = end_error<Method, Model, R>(h, span);
    std::vector<double> slopes;
    for (int i = 0; i < 3; ++i) {
        h /= 2;
        const double fine = end_error<Method, Model, R>(h, span);
        slopes.push_back(std::log2(coarse / fine));
        coarse = fine;
    }
    CAPTURE(span, first_h, slopes, coarse);
    // the roundings of N steps add up to about sqrt(N) eps
    REQUIRE(coarse > 10 * std::sqrt(std::abs(span) / h) * static_cast<double>(std::numeric_limits<R>::epsilon()));
    CHECK(slopes[2] > order - allowed.below);
    CHECK(slopes[2] < order + allowed.above);
}

}  // namespace global_order
