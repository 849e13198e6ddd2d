// SPDX-License-Identifier: MIT
// Compares a model's own Jacobian with the one by dual numbers. Host code; it calls the model on some initial states.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "myriad/host/core/error.hpp"
#include "myriad/host/ensemble/inputs_of.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/model/jacobian.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// Throws `error` if an entry of the Jacobian differs from the derivative of `rhs` in the first half of the digits,
/// relative to its row: cancellation may cost the other half, and a wrong formula is wrong by more. Checks the initial
/// states of a thousand or so instances. Not for models with `initialise`, before which `rhs` cannot be called.
template <class Model, class R>
void check_jacobian(ensemble<Model, R>& e, std::int64_t count) {
    if constexpr (gives_jacobian<Model> && !has_initialise<Model>) {
        constexpr int n = n_state<Model>;
        for_sampled_instances(e, count, [&](std::int64_t i) {
            const auto p = inputs_of(e, i);
            vec<R, n> y;
            for (int c = 0; c < n; ++c) y[c] = e.state(c)[i];
            const R t = e.t_begin_of(i);
            matrix<R, n> own, dual;
            detail::evaluate_jacobian<Model>(t, y, p, own);
            detail::dual_jacobian<Model>(t, y, p, dual);
            for (int row = 0; row < n; ++row) {
                R scale = 0;
                for (int j = 0; j < n; ++j) scale = std::max(scale, std::abs(dual[row][j]));
                const R allowed = std::sqrt(std::numeric_limits<R>::epsilon()) * scale;
                for (int j = 0; j < n; ++j) {
                    // at the edge of the domain of rhs its derivative may not exist
                    require(!std::isfinite(dual[row][j]) || std::abs(own[row][j] - dual[row][j]) <= allowed,
                            "jacobian gives ", own[row][j], " for the derivative of component ", row, " by state ", j,
                            " at the start of instance ", i, ", but that of rhs is ", dual[row][j],
                            ": mend the formula (df_i/dy_j belongs in row i, column j), or leave out jacobian");
                }
            }
        });
    }
}

}  // namespace myriad::host::inline MYRIAD_ABI
