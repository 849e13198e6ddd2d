// SPDX-License-Identifier: MIT
// Tangent dynamics: a model with its variational equations, whose right-hand side is the model's called with dual
// numbers, and with the growth of the tangent vectors, which gives Lyapunov exponents.
#pragma once

#include "myriad/kernel/model/variations.hpp"

namespace myriad {

/// Model with `vectors` solutions v' = J v of its variational equations, J the Jacobian of its right-hand side: itself
/// a model, in which `with_tangents<Model>::tangent(c, i)` is component c of tangent i among the states. The tangents
/// start orthonormal (`initial_tangents(ensemble)` sets them) and are orthonormalised at the end of every phase by a QR
/// decomposition. The logarithms of the diagonal of R are summed from phase `transient_phases` on: divided by
/// `time_summed`, the sums are the Lyapunov exponents (`exponent(i)`), the largest first; Benettin et al., Meccanica 15
/// (1980) 9 and 21. The first components, parameters, shared values, accessories, events and hooks are
/// those of Model; actions transform the tangents like the distance to a neighbouring solution.
///
/// Model's functions, hooks included, are called with dual numbers: their variables must be `auto` or R, the functions
/// they call those of `myriad`. Values that a hook writes outside the state, and `rhs` reads, must not depend on the
/// state, and `rhs` may jump only at an event with `after_event`.
template <class Model, int vectors = 1>
struct with_tangents : detail::with_variations<Model, detail::state_directions<vectors>> {
    static_assert(vectors >= 1 && vectors <= detail::n_state<Model>,
                  "a model of n components has from 1 to n independent tangent vectors");

    static_assert(vectors == 1 || !detail::has_delays<Model>,
                  "a model with delays has one tangent vector, for the largest exponent: several would have to be "
                  "orthogonal with their past");

    using base = detail::with_variations<Model, detail::state_directions<vectors>>;  ///< with their equations
    using base::n_original, base::n_tangent, base::n_state;
    static constexpr int n_vectors = vectors;  ///< number of tangent vectors
    /// Component c of tangent vector i, among the states.
    MYRIAD_FUNCTION static int tangent(int c, int i = 0) { return n_original + i * n_original + c; }

    /// The sum of ln |r_ii| over the phases, among the accessories.
    MYRIAD_FUNCTION static int growth(int i = 0) { return detail::n_accessory<Model> + i; }
    /// The time summed, among the accessories.
    static constexpr int time_summed = detail::n_accessory<Model> + vectors;
    static constexpr int phase_began = time_summed + 1;  ///< the time at which the current phase began
    /// The Lyapunov exponent so far, among the accessories: NaN before the first phase that counts.
    MYRIAD_FUNCTION static int exponent(int i = 0) { return phase_began + 1 + i; }
    static constexpr int n_accessory = phase_began + 1 + vectors;  ///< number of all accessories

    /// Number of phases, from the ensemble's start, left out of the sums, among the shared integers.
    static constexpr int transient_phases = detail::n_shared_integer<Model>;
    static constexpr int n_shared_integer = transient_phases + 1;  ///< number of all shared integers

    /// The model's own hook; sets the sums to zero in phase 0.
    MYRIAD_FUNCTION static void initialise(auto& wrapped) {
        const bool at_t_begin = wrapped.t == wrapped.t_begin;
        if constexpr (detail::has_initialise<Model>) {
            const auto given = detail::part<n_tangent>(wrapped.y, n_original);
            base::initialise(wrapped);
            if (wrapped.phase == 0) detail::set_part(wrapped.y, n_original, given);  // they start as given
        }
        wrapped.accessory[phase_began] = at_t_begin ? wrapped.t_begin : wrapped.t;
        if (wrapped.phase == 0) {
            for (int i = 0; i < vectors; ++i) wrapped.accessory[growth(i)] = 0;
            wrapped.accessory[time_summed] = 0;
            set_exponents(wrapped);
            detail::orthonormalise<n_original, vectors>(wrapped.y, n_original, [](int, const auto&) MYRIAD_LAMBDA {});
        }
    }

    /// The model's own hook; then orthonormalises the tangents and adds their growth to the sums.
    MYRIAD_FUNCTION static void finalise(auto& wrapped) {
        if constexpr (detail::has_finalise<Model>) base::finalise(wrapped);
        const bool counts = wrapped.phase >= wrapped.shared_integer[transient_phases];
        detail::orthonormalise<n_original, vectors>(wrapped.y, n_original,
                                                    [&](int i, const auto& length) MYRIAD_LAMBDA {
                                                        if (counts) wrapped.accessory[growth(i)] += log(length);
                                                        if constexpr (detail::has_delays<Model>)
                                                            detail::scale_past(wrapped.past, n_original, 1 / length);
                                                    });
        if (counts) wrapped.accessory[time_summed] += wrapped.t - wrapped.accessory[phase_began];
        set_exponents(wrapped);
    }

private:
    MYRIAD_FUNCTION static void set_exponents(auto& wrapped) {
        for (int i = 0; i < vectors; ++i)
            wrapped.accessory[exponent(i)] = wrapped.accessory[growth(i)] / wrapped.accessory[time_summed];
    }
};

}  // namespace myriad
