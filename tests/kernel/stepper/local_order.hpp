// SPDX-License-Identifier: MIT
// Order of the errors of single steps, of problems with two components. For model files, compiled as kernels are.
#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "myriad/kernel/core/macros.hpp"
#include "tests/catch.hpp"

// The name carries the instruction set, as the library's do.
namespace local_order::inline MYRIAD_TARGET {

/// Root mean squares over many starts, so that a zero of the leading error term at one of them does not count.
struct mean_error {
    double leading;  // the part of the error with the order's parity: C h^order + C' h^(order + 2) + ...
    double whole;    // the error of a step of length h

    template <class Error>
    mean_error(Error error, int order, double h) {
        constexpr int starts = 32;
        double leading_squares = 0, whole_squares = 0;
        for (int i = 0; i < starts; ++i) {
            const double t = 0.5 + 0.0625 * i;
            const auto forward = error(t, h), backward = error(t, -h);
            for (int c = 0; c < 2; ++c) {
                const double part = 0.5 * (forward[c] + (order % 2 == 0 ? 1 : -1) * backward[c]);
                leading_squares += part * part;
                whole_squares += forward[c] * forward[c];
            }
        }
        leading = std::sqrt(leading_squares / starts);
        whole = std::sqrt(whole_squares / starts);
    }
};

/// error(h) = C h^order + C' h^(order + 1) + ... for both signs of h. If C is small, as it should be, the next term
/// hides it at any h whose error is clear of rounding; a step forward and one back separate the two. The leading part
/// must decrease with the order, up to a term in h^2, small enough at the finest h for a window of 0.1, and the whole
/// error at least as fast.
template <class Error>
void check_local_order(Error error, int order, double first_h, double window = 0.1) {
    for (const double sign : {1.0, -1.0}) {
        double h = sign * first_h;
        mean_error coarse(error, order, h);
        std::vector<double> leading_slopes, slopes;
        for (int i = 0; i < 3; ++i) {
            h /= 2;
            const mean_error fine(error, order, h);
            leading_slopes.push_back(std::log2(coarse.leading / fine.leading));
            slopes.push_back(std::log2(coarse.whole / fine.whole));
            coarse = fine;
        }
        CAPTURE(sign, first_h, leading_slopes, slopes);
        REQUIRE(coarse.leading >
                10 * std::numeric_limits<double>::epsilon());  // rounding then changes a slope by at most 0.1
        CHECK(std::abs(leading_slopes[2] - order) < window);
        CHECK(slopes[1] > order - 3 * window);
        CHECK(slopes[2] > order - 3 * window);
    }
}

}  // namespace local_order::inline MYRIAD_TARGET
