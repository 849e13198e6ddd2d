// SPDX-License-Identifier: MIT
// Which models have an adjoint as they are written in C++: their equations alone change the state.
#pragma once

#include "myriad/kernel/methods/dense.hpp"
#include "myriad/kernel/model/concepts.hpp"
#include "myriad/kernel/model/mass_matrix.hpp"

namespace myriad::detail {

/// Refuses a model or a method without adjoint.
template <class Model, class Method>
constexpr bool check_adjoint() {
    constexpr bool has_hooks = has_initialise<Model> || has_after_step<Model> || has_finalise<Model>;
    static_assert(!has_events<Model> && !has_stops<Model> && !has_triggers<Model> && !has_hooks,
                  "the model has hooks, events, triggers or stop times, of which there is no adjoint in C++: give the "
                  "equations alone as a model, or take with_sensitivities");
    static_assert(n_accessory<Model> == 0 && n_integer_accessory<Model> == 0,
                  "the model has accessories, of which there is no adjoint: take with_sensitivities");
    static_assert(!has_delays<Model> && !has_diffusion<Model>,
                  "there is no adjoint of delays and of stochastic equations");
    static_assert(!has_mass_matrix<Model>, "there is no adjoint of models with a mass matrix");
    static_assert(n_tangent<Model> == 0, "the model has tangents or sensitivities: give the adjoint the original");
    static_assert(!has_publish<Model>, "there is no adjoint of coupled units: write their equations as one model");
    static_assert(samples_trajectory<Method>,
                  "an adjoint needs all steps, which methods with dense output keep: myriad::dense<Method>");
    return true;
}

}  // namespace myriad::detail
