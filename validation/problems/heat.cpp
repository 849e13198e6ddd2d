// SPDX-License-Identifier: MIT
// Heat conduction in shells of different diffusivity, with one differentiation matrix for all; in closed form except
// for the collocation error.
#include "heat.hpp"

#include <cmath>
#include <numbers>

#include "../runner.hpp"
#include "problems.hpp"

namespace validation {
namespace {

/// The Chebyshev points of [1, 2] in rising order.
std::vector<double> radii() {
    std::vector<double> r;
    for (int i = 0; i < heat::points; ++i) r.push_back(1.5 - 0.5 * std::cos(std::numbers::pi * i / (heat::points - 1)));
    return r;
}

/// The differentiation matrix of the polynomial through all points, row by row, and the points: from barycentric
/// weights (Berrut and Trefethen, SIAM Review 46 (2004) 501, section 9.3).
std::vector<double> matrix_and_radii() {
    const auto r = radii();
    const auto n = r.size();
    std::vector<double> weight(n, 1), D(n * n, 0);
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j)
            if (j != i) weight[i] /= r[i] - r[j];
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j) {
            if (j == i) continue;
            D[i * n + j] = weight[j] / weight[i] / (r[i] - r[j]);
            D[i * n + i] -= D[i * n + j];
        }
    }
    D.insert(D.end(), r.begin(), r.end());
    return D;
}

/// sin(pi (r - 1)) / r exp(-kappa pi^2 t) at the inner points.
std::vector<double> temperature(double kappa, double t) {
    constexpr double pi = std::numbers::pi;
    std::vector<double> T;
    for (std::size_t i = 1; i + 1 < heat::points; ++i)
        T.push_back(std::sin(pi * (radii()[i] - 1)) / radii()[i] * std::exp(-kappa * pi * pi * t));
    return T;
}

}  // namespace

problem heat_problem() {
    problem p;
    p.name = "heat";
    p.what =
        "Heat conduction in shells 1 < r < 2 by collocation at 12 Chebyshev points with a shared matrix, to t = 0.1; "
        "diffusivity from 0.2 to 1";
    for (const double kappa : spread(0.2, 1, 64)) p.instances.push_back({temperature(kappa, 0), {kappa}, 0.1});
    p.shared = matrix_and_radii();
    p.sampled = {0, 4, 9};
    p.fixed_step = 5e-4;
    p.error_follows_tolerance = false;  // stability bounds the step
    // Steps bound by stability are long for the fastest modes, and the estimate of such a step may happen to vanish:
    // with one tolerance for each step, dormand_prince_8 at 1e-11 was above the bound in 11 of 400 runs whose
    // tolerances were within 4e-4 of each other, by a factor of at most 1.5.
    p.error_of_a_step = 4;
    p.closed_form_error = 1e-8;
    p.exactly = [](const instance& i, std::int64_t) {
        solution s;
        s.end = temperature(i.parameter[heat::kappa], i.t_end);
        return s;
    };
    complete<heat>(p);
    return p;
}

}  // namespace validation
