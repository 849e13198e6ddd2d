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

namespace myriad::host::inline MYRIAD_ABI {

/// Adds a note if a relative tolerance was below what the precision can reach and the method uses it.
template <class Method, class Model, class R>
void note_tolerances(report<Model, R>& r, const options& o) {
    if (Method::embedded_order > 0) note_raised_tolerances<R>(r, o);
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
