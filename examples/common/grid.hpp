// SPDX-License-Identifier: MIT
// Grids of parameters.
#pragma once

#include <cmath>
#include <cstdint>

#include <Eigen/Core>

namespace examples {

/// n values from `first` to `last`, both included; a single one is `first`.
inline Eigen::ArrayXd linspace(double first, double last, std::int64_t n) {
    if (n == 1) return Eigen::ArrayXd::Constant(1, first);  // LinSpaced would give the last value
    return Eigen::ArrayXd::LinSpaced(n, first, last);
}

/// n values from `first` to `last`, both included and positive, with a constant ratio from one to the next.
inline Eigen::ArrayXd logspace(double first, double last, std::int64_t n) {
    return Eigen::exp(linspace(std::log(first), std::log(last), n));
}

}  // namespace examples
