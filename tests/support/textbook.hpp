// SPDX-License-Identifier: MIT
// Butcher's formulas, written independently from a tableau and summed in long double: one step of a test problem
// without parameters, for comparison with the library's.
#pragma once

#include <cmath>
#include <cstddef>

#include <myriad/model.hpp>

// Both kinds of test files include this: the name carries the instruction set, as the library's do.
namespace textbook::inline MYRIAD_TARGET {

template <class Method, class Model>
struct step {
    static constexpr int n = Model::n_state, stages = Method::stages;
    double y[n];         // new state
    double estimate[n];  // error estimate
    double size[n];      // sum of the magnitudes of all terms, to which rounding errors are proportional

    step(double t, double h, const myriad::vec<double, n>& start) {
        constexpr auto tableau = Method::tableau();
        const auto entry = [](const auto& row, int j) {
            return static_cast<long double>(row[static_cast<std::size_t>(j)]);
        };
        const auto a = [&](int i, int j) { return entry(tableau.a[static_cast<std::size_t>(i)], j); };
        long double k[stages][n];
        for (int i = 0; i < stages; ++i) {
            myriad::vec<double, n> argument;
            for (int c = 0; c < n; ++c) {
                long double sum = 0;
                for (int j = 0; j < i; ++j) sum += a(i, j) * k[j][c];
                argument[c] = static_cast<double>(start[c] + h * sum);
            }
            const auto slope =
                Model::template rhs<double>(static_cast<double>(t + entry(tableau.c, i) * h), argument, 0);
            for (int c = 0; c < n; ++c) k[i][c] = slope[c];
        }
        for (int c = 0; c < n; ++c) {
            long double b = 0, e = 0, sum = 0;
            for (int i = 0; i < stages; ++i) {
                b += entry(tableau.b, i) * k[i][c];
                e += entry(tableau.e, i) * k[i][c];
                sum += std::abs(entry(tableau.b, i) * k[i][c]);
                for (int j = 0; j < i; ++j) sum += std::abs(entry(tableau.b, i) * h * a(i, j) * k[j][c]);
            }
            y[c] = static_cast<double>(start[c] + h * b);
            estimate[c] = static_cast<double>(h * e);
            size[c] = static_cast<double>(std::abs(start[c]) + std::abs(h) * sum);
        }
    }
};

}  // namespace textbook::inline MYRIAD_TARGET
