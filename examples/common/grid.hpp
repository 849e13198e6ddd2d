// SPDX-License-Identifier: MIT
// Grids of parameters and of initial values.
#pragma once

#include <cmath>
#include <cstdint>

#include <Eigen/Core>

namespace examples {

/// n values from `first` to `last`, both included; a single one is `first`.
inline Eigen::ArrayXd linspace(double first, double last, std::int64_t n) {
    if (n == 1) return Eigen::ArrayXd::Constant(1, first);  // LinSpaced would return the last value
    return Eigen::ArrayXd::LinSpaced(n, first, last);
}

/// n values from `first` to `last`, both included and positive, with a constant ratio between neighbours.
inline Eigen::ArrayXd geomspace(double first, double last, std::int64_t n) {
    return Eigen::exp(linspace(std::log(first), std::log(last), n));
}

/// Sets two components on a plane of across.size() x up.size() instances, row by row: one varies along each row, the
/// other from row to row.
inline void fill_plane(Eigen::Ref<Eigen::ArrayXd> along_rows, const Eigen::ArrayXd& across,
                       Eigen::Ref<Eigen::ArrayXd> from_row_to_row, const Eigen::ArrayXd& up) {
    along_rows = across.replicate(up.size(), 1);
    for (Eigen::Index row = 0; row < up.size(); ++row)
        from_row_to_row.segment(row * across.size(), across.size()) = up[row];
}

}  // namespace examples
