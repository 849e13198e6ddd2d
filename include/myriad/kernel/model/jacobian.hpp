// SPDX-License-Identifier: MIT
// Derivatives of a model's right-hand side: the time derivative, and the Jacobian, the model's own or by dual numbers.
#pragma once

#include "myriad/kernel/model/concepts.hpp"
#include "myriad/kernel/model/lane.hpp"
#include "myriad/kernel/scalar/dual.hpp"
#include "myriad/kernel/scalar/matrix_loop.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// Derivative of the right-hand side in the direction given by the derivatives of t and y.
template <class Model, class S>
MYRIAD_FUNCTION vec<S, n_state<Model>> directional_derivative(const dual<S>& t, const vec<dual<S>, n_state<Model>>& y,
                                                              const inputs<Model, S>& p) {
    const auto f = Model::template rhs<dual<S>>(t, y, p);
    vec<S, n_state<Model>> out;
    MYRIAD_UNROLL
    for (int c = 0; c < n_state<Model>; ++c) out[c] = f[c].derivative;
    return out;
}

/// y as constants.
template <class S, int n>
MYRIAD_FUNCTION vec<dual<S>, n> constants(const vec<S, n>& y) {
    vec<dual<S>, n> out;
    MYRIAD_UNROLL
    for (int c = 0; c < n; ++c) out[c] = dual<S>(y[c]);
    return out;
}

/// df/dt.
template <class Model, class S>
MYRIAD_FUNCTION vec<S, n_state<Model>> time_derivative(const S& t, const vec<S, n_state<Model>>& y,
                                                       const inputs<Model, S>& p) {
    return detail::directional_derivative<Model>(dual<S>(t, S(real_of<S>(1))), constants(y), p);
}

/// df_i/dy_j in row i and column j, by one evaluation of the right-hand side with dual numbers per column. In an
/// unrolled loop (small systems), the compiler computes the values, common to all columns, once.
template <class Model, class S>
MYRIAD_FUNCTION void dual_jacobian(const S& t, const vec<S, n_state<Model>>& y, const inputs<Model, S>& p,
                                   matrix<S, n_state<Model>>& jacobian) {
    constexpr int n = n_state<Model>;
    matrix_loop<S, n>::all([&](auto j) MYRIAD_LAMBDA {
        auto seeded = constants(y);
        seeded[j].derivative = S(real_of<S>(1));
        const auto column = detail::directional_derivative<Model>(dual<S>(t), seeded, p);
        matrix_loop<S, n>::all([&](auto i) MYRIAD_LAMBDA { jacobian[i][j] = column[i]; });
    });
}

/// The model's own Jacobian if it has one, else that by dual numbers.
template <class Model, class S>
MYRIAD_FUNCTION void evaluate_jacobian(const S& t, const vec<S, n_state<Model>>& y, const inputs<Model, S>& p,
                                       matrix<S, n_state<Model>>& jacobian) {
    if constexpr (gives_jacobian<Model>) {
        jacobian = Model::template jacobian<S>(t, y, p);
    } else {
        detail::dual_jacobian<Model>(t, y, p, jacobian);
    }
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
