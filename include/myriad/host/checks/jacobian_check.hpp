// SPDX-License-Identifier: MIT
// Compares a model's own Jacobian, and its pattern, with the one by dual numbers. Host code; it calls the model on some
// initial states.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>

#include "myriad/host/checks/instance_inputs.hpp"
#include "myriad/host/core/error.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/model/jacobian.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// Throws `error` if an entry of the Jacobian differs from the derivative of `rhs` in the first half of the digits,
/// relative to its row: cancellation may cost the other half, and a wrong formula is wrong by more. Checks the initial
/// states of a thousand or so instances. Not for models with `initialise`, before which `rhs` cannot be called.
template <class Model, class R>
void check_jacobian(const argument_head<R>& a, std::int64_t count) {
    if constexpr (gives_jacobian<Model> && !has_initialise<Model>) {
        constexpr int n = n_state<Model>;
        const std::int64_t stride = std::max<std::int64_t>(count / 1024, 1);
        for (std::int64_t i = 0; i < count; i += stride) {
            if (a.ended[i] != 0) continue;
            const auto p = detail::inputs_of<Model>(a, i);
            const auto y = detail::state_of<Model>(a, i);
            const R t = detail::begin_of(a, i);
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
        }
    }
}

/// Throws `error` if a derivative of `rhs` that the model's `jacobian_pattern` leaves out is not zero. Looks at some
/// initial states and, as derivatives may vanish there, at states beside them. Not for models with `initialise`.
template <class Model, class R>
void check_jacobian_pattern(const argument_head<R>& a, std::int64_t count) {
    if constexpr (has_jacobian_pattern<Model> && !has_initialise<Model>) {
        constexpr int n = n_state<Model>;
        const std::int64_t stride = std::max<std::int64_t>(count / 8, 1);
        const auto matrix_of = std::make_unique<matrix<R, n>>();
        auto& dual = *matrix_of;
        bool declared[n][n]{};
        for (const jacobian_entry& entry : Model::jacobian_pattern) declared[entry.row][entry.column] = true;
        for (std::int64_t i = 0; i < count; i += stride) {
            if (a.ended[i] != 0) continue;
            const auto p = detail::inputs_of<Model>(a, i);
            for (const bool beside : {false, true}) {
                auto y = detail::state_of<Model>(a, i);
                for (int c = 0; c < n; ++c)
                    if (beside) y[c] += (std::abs(y[c]) + 1) * static_cast<R>(c + 1) / static_cast<R>(4 * n);
                detail::dual_jacobian<Model>(detail::begin_of(a, i), y, p, dual);
                for (int row = 0; row < n; ++row) {
                    for (int j = 0; j < n; ++j) {
                        require(declared[row][j] || dual[row][j] == 0 || !std::isfinite(dual[row][j]),
                                "jacobian_pattern has no entry {", row, ", ", j, "}, but the derivative of component ",
                                row, " by state ", j, beside ? " beside" : " at", " the start of instance ", i, " is ",
                                dual[row][j], cure, "add the entry, or leave out jacobian_pattern");
                    }
                }
            }
        }
    }
}

}  // namespace myriad::host::inline MYRIAD_ABI
