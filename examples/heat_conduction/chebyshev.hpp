// SPDX-License-Identifier: MIT
// Polynomials through Chebyshev points: the points, and the matrices that differentiate and interpolate. Sources:
// Berrut and Trefethen, "Barycentric Lagrange interpolation", SIAM Review 46 (2004) 501, sections 4, 5 and 9.3.
#pragma once

#include <cmath>
#include <numbers>

#include <Eigen/Core>

namespace chebyshev {

/// n points from `first` to `last`, both included.
inline Eigen::ArrayXd points(double first, double last, int n) {
    const Eigen::ArrayXd angle = Eigen::ArrayXd::LinSpaced(n, 0, std::numbers::pi);
    return (first + last) / 2 - (last - first) / 2 * angle.cos();
}

/// Barycentric weights of such points.
inline Eigen::ArrayXd weights(Eigen::Index n) {
    Eigen::ArrayXd w(n);
    for (Eigen::Index i = 0; i < n; ++i) w[i] = i % 2 == 0 ? 1 : -1;
    w[0] /= 2;
    w[n - 1] /= 2;
    return w;
}

// snippet: matrix
/// Maps values at the points r to the slopes there of the polynomial through them.
inline Eigen::MatrixXd differentiation_matrix(const Eigen::ArrayXd& r) {
    const Eigen::Index n = r.size();
    const Eigen::ArrayXd w = weights(n);
    Eigen::MatrixXd D = Eigen::MatrixXd::Zero(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
        for (Eigen::Index j = 0; j < n; ++j)
            if (j != i) D(i, j) = w[j] / w[i] / (r[i] - r[j]);
    D.diagonal() = -D.rowwise().sum();  // the slope of a constant is zero
    return D;
}
// end of snippet

/// Maps values at the points r to those of their polynomial at x.
inline Eigen::MatrixXd interpolation_matrix(const Eigen::ArrayXd& r, const Eigen::ArrayXd& x) {
    const Eigen::ArrayXd w = weights(r.size());
    Eigen::MatrixXd P(x.size(), r.size());
    for (Eigen::Index i = 0; i < x.size(); ++i) {
        const Eigen::ArrayXd share = w / (x[i] - r);
        Eigen::Index at = 0;
        if ((r - x[i]).abs().minCoeff(&at) == 0) {
            P.row(i) = Eigen::VectorXd::Unit(r.size(), at);
        } else {
            P.row(i) = share / share.sum();
        }
    }
    return P;
}

}  // namespace chebyshev
