// SPDX-License-Identifier: MIT
// The tangent vectors of an instance as columns of a matrix. Host test files only.
#pragma once

#include <cmath>

#include <Eigen/Dense>

#include "myriad/host/ensemble/exponents.hpp"

namespace tangents {

/// Column i holds tangent vector i of an instance.
template <class W, class R>
Eigen::MatrixXd tangents_of(const myriad::ensemble<W, R>& e, Eigen::Index instance) {
    Eigen::MatrixXd q(W::n_original, W::n_vectors);
    for (int i = 0; i < W::n_vectors; ++i)
        for (int c = 0; c < W::n_original; ++c) q(c, i) = static_cast<double>(e.state(W::tangent(c, i))[instance]);
    return q;
}

/// The position of the first tangent after one phase, with its length.
template <class W>
Eigen::VectorXd first_tangent(const myriad::ensemble<W>& e, Eigen::Index instance) {
    return tangents_of(e, instance).col(0) * std::exp(e.accessory(W::growth(0))[instance]);
}

}  // namespace tangents
