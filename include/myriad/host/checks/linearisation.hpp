// SPDX-License-Identifier: MIT
// What checks of algebraic equations call of a model: its mass matrix, and its right-hand side with all derivatives by
// the states. For code that knows the model when it is compiled.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "myriad/host/checks/instance_functions.hpp"
#include "myriad/host/checks/instance_inputs.hpp"
#include "myriad/kernel/model/jacobian.hpp"
#include "myriad/kernel/model/mass_matrix.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// The mass matrix row by row.
template <class Model>
inline constexpr auto dense_mass_matrix = [] {
    constexpr auto n = static_cast<std::size_t>(n_state<Model>);
    std::array<double, n * n> mass{};
    for (const mass_entry& e : Model::mass_matrix)
        mass[static_cast<std::size_t>(e.row) * n + static_cast<std::size_t>(e.column)] += e.value;
    return mass;
}();

/// See `instance_functions`.
template <class Model, class R>
void linearise(const argument_head<R>& a, std::int64_t i, R t, const R* y, R* slopes, R* jacobian) {
    constexpr auto n = n_state<Model>;
    vec<R, n> state;
    for (int c = 0; c < n; ++c) state[c] = y[c];
    const auto p = detail::inputs_of<Model>(a, i);
    const auto f = Model::template rhs<R>(t, state, p);
    const auto derivatives = std::make_unique<matrix<R, n>>();
    detail::dual_jacobian<Model>(t, state, p, *derivatives);
    for (int c = 0; c < n; ++c) {
        slopes[c] = f[c];
        for (int j = 0; j < n; ++j) jacobian[c * n + j] = (*derivatives)[c][j];
    }
}

/// Adds these to the functions of a model that has a mass matrix.
template <class Model, class R>
constexpr void add_linearisation(instance_functions<R>& all) {
    if constexpr (has_mass_matrix<Model>) {
        all.mass_matrix = dense_mass_matrix<Model>.data();
        all.linearise = &linearise<Model, R>;
    }
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
