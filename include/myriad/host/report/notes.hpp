// SPDX-License-Identifier: MIT
// The notes of a report: tolerances that had to be raised, signs of stiffness, and phases too long for the smallest
// Lyapunov exponent.
#pragma once

#include <cstdint>

#include "myriad/host/ensemble/inputs_of.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/host/report/report.hpp"
#include "myriad/host/report/stability.hpp"
#include "myriad/host/report/stiffness.hpp"
#include "myriad/host/report/tangent_note.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/model/tangent.hpp"
#include "myriad/kernel/scalar/matrix_loop.hpp"
#include "myriad/kernel/stepper/sparse_lu.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// Adds a note if a relative tolerance was below what the precision can reach and the method uses it.
template <class Method, class Model, class R>
void note_tolerances(report<Model, R>& r, const options& o) {
    if (Method::embedded_order > 0) note_raised_tolerances<R>(r, o);
}

/// What a stiff method makes of the Jacobian; adds a note if its pattern is not known and would be of use.
template <class Method, class Model, class R>
void note_matrix(report<Model, R>& r) {
    // As the concept of Rosenbrock methods, whose header has kernels.
    if constexpr (requires { Method::tableau().coupling; }) {
        constexpr int n = n_state<Model>;
        constexpr bool known = detail::origin_of_pattern<Model>() != detail::pattern_origin::none;
        r.matrix = {n, known ? detail::n_jacobian_entry<Model> : n * n, detail::n_factor_entry<Model>};
        if constexpr (!known && n > detail::largest_matrix_in_registers<R>)
            r.notes.push_back(
                "rhs looks at values, of a state, a parameter or a shared integer, so that the compiler cannot find "
                "which entries of the Jacobian are zero, and the method works with all of them: use myriad::select "
                "instead of branches, or declare jacobian_pattern");
    }
}

/// The right-hand side of an ensemble's model, as long as the ensemble is there.
template <class Model, class R>
any_rhs<R> rhs_of(ensemble<Model, R>& e) {
    return {&e, [](void* of, std::int64_t i, R t, const R* y, R* slopes) {
                vec<R, n_state<Model>> state;
                for (int c = 0; c < n_state<Model>; ++c) state[c] = y[c];
                const auto f =
                    detail::evaluate_rhs<Model>(t, state, inputs_of(*static_cast<ensemble<Model, R>*>(of), i));
                for (int c = 0; c < n_state<Model>; ++c) slopes[c] = f[c];
            }};
}

/// Adds a note if stability, not accuracy, limited an explicit method's steps.
template <class Method, class Model, class R>
void note_stiffness(report<Model, R>& r, ensemble<Model, R>& e, const options& o) {
    if constexpr (may_advise_stiff_methods<Model, Method>)
        note_stiffness<R>(r, ensemble_access::data(e), o, &real_stability_limit<Method>, rhs_of(e));
}

/// Adds a note if phases are too long for the smallest exponent.
template <class Method, class Model, class R>
void note_exponents(report<Model, R>& r, ensemble<Model, R>& e, const options& o) {
    if constexpr (n_tangent<Model> != 0)
        note_exponents<R>(r, ensemble_access::data(e), o,
                          {Model::n_original, Model::n_vectors, Model::growth(0), Model::transient_phases,
                           Method::embedded_order > 0});
}

}  // namespace myriad::host::inline MYRIAD_ABI
