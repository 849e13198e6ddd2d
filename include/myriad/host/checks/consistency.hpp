// SPDX-License-Identifier: MIT
// Whether initial values satisfy the algebraic equations of a model with a singular mass matrix, and their projection
// onto these. Host code; it calls the model on initial states.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "myriad/host/checks/algebraic_part.hpp"
#include "myriad/host/checks/instance_inputs.hpp"
#include "myriad/host/core/error.hpp"
#include "myriad/host/ensemble/ensemble.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/model/jacobian.hpp"
#include "myriad/kernel/model/mass_matrix.hpp"

namespace myriad::host::inline MYRIAD_ABI {

template <class Model>
std::vector<double> dense_mass_matrix() {
    constexpr std::size_t n = n_state<Model>;
    std::vector<double> mass(n * n);
    if constexpr (has_mass_matrix<Model>)
        for (const mass_entry& e : Model::mass_matrix)
            mass[static_cast<std::size_t>(e.row) * n + static_cast<std::size_t>(e.column)] += e.value;
    return mass;
}

/// The algebraic equations at time t in a state, which is copied to y.
template <class Model, class R>
algebraic_equations equations_at(R t, const vec<R, n_state<Model>>& state, const inputs<Model, R>& p,
                                 const algebraic_part& part, std::vector<double>& y) {
    constexpr int n = n_state<Model>;
    const auto matrix_of = std::make_unique<matrix<R, n>>();
    detail::dual_jacobian<Model>(t, state, p, *matrix_of);
    const vec<R, n> slopes = Model::template rhs<R>(t, state, p);
    std::vector<double> f, jacobian;
    y.clear();
    for (int c = 0; c < n; ++c) {
        y.push_back(static_cast<double>(state[c]));
        f.push_back(static_cast<double>(slopes[c]));
        for (int j = 0; j < n; ++j) jacobian.push_back(static_cast<double>((*matrix_of)[c][j]));
    }
    return {part, f, jacobian};
}

inline constexpr const char* higher_index =
    "the algebraic equations do not determine their states (an index above one, or a mistake in mass_matrix): "
    "differentiate equations until they do";

/// Throws `error` if the initial values of some instance do not satisfy the algebraic equations to within what the
/// tolerances allow of each state, or if the index is above one. Looks at a thousand or so instances. Not for models
/// with `initialise`, before which `rhs` cannot be called.
template <class Model, class R>
void check_consistency(const argument_head<R>& a, const double* relative_tolerance, const double* absolute_tolerance,
                       std::int64_t count) {
    if constexpr (has_mass_matrix<Model> && !has_initialise<Model>) {
        constexpr int n = n_state<Model>;
        const algebraic_part part(n, dense_mass_matrix<Model>());
        if (part.count == 0) return;
        const std::int64_t stride = std::max<std::int64_t>(count / 1024, 1);
        for (std::int64_t i = 0; i < count; i += stride) {
            if (a.ended[i] != 0) continue;
            std::vector<double> y, change;
            const algebraic_equations equations = equations_at<Model>(
                detail::begin_of(a, i), detail::state_of<Model>(a, i), detail::inputs_of<Model>(a, i), part, y);
            for (int k = 0; k < part.count; ++k) {
                const double residual = equations.residual[static_cast<std::size_t>(k)];
                double allowed = 0;
                for (std::size_t j = 0; j < static_cast<std::size_t>(n); ++j) {
                    const double relative =
                        std::max(relative_tolerance[j], 16.0 * static_cast<double>(std::numeric_limits<R>::epsilon()));
                    allowed += std::abs(equations.slope[static_cast<std::size_t>(k * n) + j]) *
                               (relative * std::abs(y[j]) + absolute_tolerance[j]);
                }
                require(std::abs(residual) <= allowed, "the initial values of instance ", i,
                        " do not satisfy the algebraic equation ", equations.text(k), ", whose right-hand side is ",
                        residual, " at them and may be ", allowed, " by the tolerances", cure,
                        "set values that do, or call myriad::make_consistent(ensemble)");
            }
            require(equations.solve(change), "at the initial values of instance ", i, ' ', higher_index);
        }
    }
}

}  // namespace myriad::host::inline MYRIAD_ABI

namespace myriad {

/// Changes the initial states of all instances so that they satisfy the algebraic equations of a model with a singular
/// `mass_matrix`, by Newton's method in the directions that leave M y as it is. Times, parameters and shared values
/// must be set. Throws `error`, with the instance, where the index is above one or the method does not converge.
template <class Model, class R>
void make_consistent(ensemble<Model, R>& e) {
    static_assert(detail::has_mass_matrix<Model>, "the model has no mass_matrix, and so no algebraic equations");
    const host::algebraic_part part(detail::n_state<Model>, host::dense_mass_matrix<Model>());
    constexpr double enough = 8.0 * static_cast<double>(std::numeric_limits<R>::epsilon());
    std::vector<double> y, change;
    for (std::int64_t i = 0; i < e.size(); ++i) {
        bool done = part.count == 0;
        for (int iteration = 0; iteration < 50 && !done; ++iteration) {
            inputs<Model, R> p;
#define MYRIAD_READ_KIND(kind, ...) \
    for (int c = 0; c < detail::n_##kind<Model>; ++c) p.kind[c] = e.kind(c)[i];
            MYRIAD_PARAMETER_KINDS(MYRIAD_READ_KIND)
            if constexpr (!detail::accessories_are_outputs<Model>) {
                MYRIAD_ACCESSORY_KINDS(MYRIAD_READ_KIND)
            }
#undef MYRIAD_READ_KIND
            if constexpr ((detail::n_shared<Model>) > 0) p.shared = &e.shared(0);
            if constexpr ((detail::n_shared_integer<Model>) > 0) p.shared_integer = &e.shared_integer(0);
            vec<R, detail::n_state<Model>> state;
            for (int c = 0; c < detail::n_state<Model>; ++c) state[c] = e.state(c)[i];
            const host::algebraic_equations equations = host::equations_at<Model>(e.t_begin_of(i), state, p, part, y);
            require(equations.solve(change), "at the initial values of instance ", i, ' ', host::higher_index);
            done = true;
            for (int c = 0; c < detail::n_state<Model>; ++c) {
                const double by = change[static_cast<std::size_t>(c)];
                if (by == 0) continue;
                done = done && std::abs(by) <= enough * std::abs(y[static_cast<std::size_t>(c)]);
                e.state(c)[i] = static_cast<R>(y[static_cast<std::size_t>(c)] + by);
            }
        }
        require(done, "no values near the initial ones of instance ", i,
                " were found that satisfy the algebraic equations", host::cure, "give values closer to them");
    }
}

}  // namespace myriad
