// SPDX-License-Identifier: MIT
// The shell of liquid: the parts common to its models, and its solutions in closed form.
#pragma once

#include <cmath>
#include <numbers>

#include <Eigen/Core>

#include "chebyshev.hpp"
#include "heat_conduction.hpp"

namespace shell {

constexpr double outer = 3;  // radius at which the temperature is zero; the bubble's is one
constexpr int flows = 4;     // of liquid, for each diffusivity

// snippet: shared
/// The values common to all instances: D, row by row, then r r and 1 / (r r) at the points.
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

/// Heat flow in still liquid, in the unit of `heat` per time.
constexpr double still = outer / (outer - 1);

/// Temperature in still liquid with the wall at one; all instances start with it.
inline Eigen::ArrayXd still_temperature(const Eigen::ArrayXd& r) { return (outer / r - 1) / (outer - 1); }

/// sin(k (r - 1)) / r with k = pi / (outer - 1): decays by exp(-diffusivity k^2 t) when wall and sphere are at zero.
inline Eigen::ArrayXd slowest_mode(const Eigen::ArrayXd& r) {
    return (std::numbers::pi / (outer - 1) * (r - 1)).sin() / r;
}

}  // namespace shell
