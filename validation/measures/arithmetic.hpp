// SPDX-License-Identifier: MIT
// Differences and medians for the measures. A NaN in a result must give NaN, which is within no bounds; the standard
// library's maximum and selection lose it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <vector>

namespace validation {

/// The larger one, or NaN if one of them is.
inline double larger(double a, double b) { return std::isnan(a) || a > b ? a : b; }

/// The largest of non-negative values, NaN if one of them is, 0 for none.
inline double largest(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0, larger);
}

/// Largest difference of two states; components that are NaN in the second, the reference, are not compared.
inline double distance(const std::vector<double>& a, const std::vector<double>& b) {
    double most = 0;
    for (std::size_t c = 0; c < a.size() && c < b.size(); ++c)
        if (!std::isnan(b[c])) most = larger(most, std::abs(a[c] - b[c]));
    return most;
}

/// The median, the upper one for an even number of values; NaN for no values, or if one is NaN.
inline double median(std::vector<double> values) {
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    if (values.empty() || std::any_of(values.begin(), values.end(), [](double v) { return std::isnan(v); }))
        return unknown;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// The median over the instances of a[i] / b[i], except where b is zero: where a leading error coefficient happens to
/// vanish, an instance tells nothing.
inline double median_ratio(const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (b[i] != 0) ratios.push_back(a[i] / b[i]);
    return median(ratios);
}

}  // namespace validation
