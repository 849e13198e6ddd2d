// SPDX-License-Identifier: MIT
// Host side of tangent dynamics: initial tangent vectors, tolerances, and Lyapunov exponents from the kernels' sums.
#pragma once

#include <cmath>
#include <vector>

#include <Eigen/Core>

#include "myriad/host/ensemble/ensemble.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/kernel/model/tangent.hpp"

namespace myriad {

/// Sets the tangents of all instances to the same orthonormal vectors, columns of a Householder reflection. No
/// component is zero and no two are equal, so that no symmetry of the model leaves them invariant.
template <class Model, int vectors, class R>
void initial_tangents(ensemble<with_tangents<Model, vectors>, R>& e) {
    using wrapped = with_tangents<Model, vectors>;
    Eigen::ArrayXd mirror(wrapped::n_original);
    for (int c = 0; c < wrapped::n_original; ++c) {
        const double golden = 0.6180339887498949 * (c + 1);
        mirror[c] = 1 + golden - std::floor(golden);
    }
    mirror /= std::sqrt(mirror.square().sum());
    for (int i = 0; i < vectors; ++i)
        for (int c = 0; c < wrapped::n_original; ++c)
            e.state(wrapped::tangent(c, i)) = static_cast<R>((c == i ? 1 : 0) - 2 * mirror[c] * mirror[i]);
}

/// One row per instance, one column per tangent vector: the Lyapunov exponents over the phases summed, per unit of
/// time, with the natural logarithm. NaN if there was no phase. A backward solution has the exponents of the forward
/// flow, the smallest first.
template <class Model, int vectors, class R>
[[nodiscard]] Eigen::Array<R, Eigen::Dynamic, Eigen::Dynamic> exponents(
    const ensemble<with_tangents<Model, vectors>, R>& e) {
    using wrapped = with_tangents<Model, vectors>;
    Eigen::Array<R, Eigen::Dynamic, Eigen::Dynamic> out(e.size(), vectors);
    for (int i = 0; i < vectors; ++i) out.col(i) = e.accessory(wrapped::growth(i)) / e.accessory(wrapped::time_summed);
    return out;
}

/// Tolerances for `options` with which only the states of the model determine the steps, as for the model alone.
template <class Wrapped>
[[nodiscard]] per_component without_tangents(const per_component& of_model) {
    std::vector<double> values(static_cast<std::size_t>(Wrapped::n_state), 1e30);
    for (std::size_t c = 0; c < static_cast<std::size_t>(Wrapped::n_original); ++c) values[c] = of_model[c];
    return values;
}

}  // namespace myriad
