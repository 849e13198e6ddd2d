// SPDX-License-Identifier: MIT
// The weights of a method in the precision of a kernel. In single precision, rounding each weight separately may change
// the sum of a row of the tableau by many rounding errors, since weights that nearly cancel may be large; every step
// then has an error of order one or two, whatever the method's order. So some weights of a row compensate for the
// rounding of the others. Evaluated at compile time only.
#pragma once

#include <array>
#include <cstddef>

namespace myriad::detail {

/// One number per stage: the weights of a row, or the factors in its order conditions.
template <std::size_t stages>
using stage_numbers = std::array<double, stages>;

/// The weights divided by `divisor`, rounded to R. If R is less precise than double, the one or two smallest weights
/// from `first` to `last` are adjusted to preserve sum_j w_j x_j and, if there are two, sum_j w_j x_j c_j; adjusting
/// the smallest affects other sums least. `x` and `c` are those of the tableau, `kept_x` and `kept_c` those of earlier
/// rows after rounding.
template <class R, std::size_t stages>
constexpr std::array<R, stages> rounded_weights(const stage_numbers<stages>& w, double divisor, std::size_t first,
                                                std::size_t last, const stage_numbers<stages>& x,
                                                const stage_numbers<stages>& c, const stage_numbers<stages>& kept_x,
                                                const stage_numbers<stages>& kept_c) {
    std::array<R, stages> rounded{};
    for (std::size_t j = 0; j < stages; ++j) rounded[j] = static_cast<R>(w[j] / divisor);
    if (sizeof(R) >= sizeof(double)) return rounded;

    // The error of the row's sum, or of its first moment.
    const auto lacking = [&](bool moment) {
        double lack = 0;
        for (std::size_t j = 0; j < stages; ++j)
            lack += w[j] / divisor * x[j] * (moment ? c[j] : 1) -
                    static_cast<double>(rounded[j]) * kept_x[j] * (moment ? kept_c[j] : 1);
        return lack;
    };
    const auto change = [&](std::size_t j, double by) {
        rounded[j] = static_cast<R>(static_cast<double>(rounded[j]) + by);
    };
    const auto size_of = [](double a) { return a < 0 ? -a : a; };
    constexpr double distinct = 0.1;
    const auto smallest = [&](std::size_t beside) {
        std::size_t found = stages;
        for (std::size_t j = first; j < last; ++j) {
            if (w[j] == 0 || size_of(kept_x[j]) < distinct) continue;
            if (beside < stages && size_of(kept_c[j] - kept_c[beside]) < distinct) continue;
            if (found == stages || size_of(w[j]) < size_of(w[found])) found = j;
        }
        return found;
    };
    const std::size_t one = smallest(stages);
    if (one == stages) return rounded;
    const std::size_t other = smallest(one);
    if (other < stages) {
        const double moment = lacking(true) - kept_c[one] * lacking(false);
        change(other, moment / (kept_x[other] * (kept_c[other] - kept_c[one])));
    }
    change(one, lacking(false) / kept_x[one]);
    return rounded;
}

/// Whether a method has a second error estimate, of lower order.
template <class Method>
inline constexpr bool has_coarse_estimate = requires {
    Method::coarse_error_weight(0);
};

/// Numbers of the rows of an explicit method's weights; the arguments of stages 1, 2, ... come first.
template <class Method>
struct row_of {
    static constexpr int solution = Method::stages;
    static constexpr int error = Method::stages + 1;
    static constexpr int coarse_error = Method::stages + 2;
};
template <class Method>
constexpr double weight_in(int row, int stage) {
    if constexpr (has_coarse_estimate<Method>) {
        if (row == row_of<Method>::coarse_error) return Method::coarse_error_weight(stage);
    }
    return Method::tableau().weight(row, stage);
}

/// First stage with a non-zero weight in `row`.
template <class Method, int row>
inline constexpr int first_stage = [] {
    int j = 0;
    while (weight_in<Method>(row, j) == 0) ++j;
    return j;
}();
/// Its weight.
template <class Method, int row, class R>
inline constexpr R first_weight = static_cast<R>(weight_in<Method>(row, first_stage<Method, row>));

/// The weights of all rows, each divided by its row's first weight; row 0, for the first stage, is empty.
template <class Method, class R>
inline constexpr auto relative_weights = [] {
    constexpr auto stages = static_cast<std::size_t>(Method::stages);
    constexpr std::size_t rows = stages + (has_coarse_estimate<Method> ? 3 : 2);
    std::array<std::array<R, stages>, rows> kept{};
    stage_numbers<stages> ones{}, c{}, kept_c{};
    for (double& one : ones) one = 1;
    for (std::size_t row = 1; row < rows; ++row) {
        stage_numbers<stages> w{};
        for (std::size_t j = 0; j < stages; ++j) w[j] = weight_in<Method>(static_cast<int>(row), static_cast<int>(j));
        std::size_t first = 0;
        while (first < stages && w[first] == 0) ++first;
        if (first == stages) continue;  // a method without error estimate
        // The first weight is rounded before the division, and is one after it.
        const double divisor = static_cast<double>(static_cast<R>(w[first]));
        kept[row] = rounded_weights<R>(w, sizeof(R) < sizeof(double) ? divisor : w[first], first + 1, stages, ones, c,
                                       ones, kept_c);
        kept[row][first] = R(1);
        if (row >= stages) continue;
        for (std::size_t j = 0; j < row; ++j) {
            c[row] += w[j];
            kept_c[row] += divisor * static_cast<double>(kept[row][j]);
        }
    }
    return kept;
}();
/// The weight of stage j divided by the row's first weight.
template <class Method, int row, int j, class R>
inline constexpr R relative_weight =
    relative_weights<Method, R>[static_cast<std::size_t>(row)][static_cast<std::size_t>(j)];
/// The node of stage i.
template <class Method, int i, class R>
inline constexpr R node = static_cast<R>(Method::tableau().c[static_cast<std::size_t>(i)]);

}  // namespace myriad::detail
