// SPDX-License-Identifier: MIT
// The shell of liquid of the study: what its models share, and its solutions in closed form.
#pragma once

#include <cmath>
#include <numbers>

#include <Eigen/Core>

#include "chebyshev.hpp"
#include "heat_conduction.hpp"

namespace shell {

constexpr double outer = 3;  // radius at which the temperature is zero; that of the bubble is one
constexpr int flows = 4;     // of liquid, with each diffusivity

// snippet: shared
/// The values that all instances share: D, row by row, and r r and 1 / (r r) at the points.
template <int points>
Eigen::ArrayXd shared_values(double wall) {
    using model = heat_conduction<points>;
    const Eigen::ArrayXd r = chebyshev::points(1, outer, points);
    const Eigen::MatrixXd D = chebyshev::differentiation_matrix(r);
    Eigen::ArrayXd values(+model::n_shared);
    values.segment(model::matrix, points * points) = D.reshaped<Eigen::RowMajor>();
    values.segment(model::square, points) = r * r;
    values.segment(model::inverse_square, points) = (r * r).inverse();
    values[model::wall] = wall;
    return values;
}
// end of snippet

/// Heat flow without flow of liquid, in the unit of `heat` per time.
constexpr double still = outer / (outer - 1);

/// Temperature of a wall at one without flow of liquid, where all instances start.
inline Eigen::ArrayXd still_temperature(const Eigen::ArrayXd& r) { return (outer / r - 1) / (outer - 1); }

/// sin(k (r - 1)) / r with k = pi / (outer - 1): decays by exp(-diffusivity k^2 t) when wall and sphere are at zero.
inline Eigen::ArrayXd slowest_mode(const Eigen::ArrayXd& r) {
    return (std::numbers::pi / (outer - 1) * (r - 1)).sin() / r;
}

}  // namespace shell
