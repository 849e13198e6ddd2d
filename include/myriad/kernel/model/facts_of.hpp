// SPDX-License-Identifier: MIT
// What a model, compiled with a method for a real type, tells of itself.
#pragma once

#include "myriad/kernel/methods/controller_policies.hpp"
#include "myriad/kernel/methods/dense.hpp"
#include "myriad/kernel/model/hooks.hpp"
#include "myriad/kernel/model/model_facts.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

template <class Model>
constexpr tangent_places tangents_of() {
    if constexpr (requires {
                      Model::n_vectors;
                      Model::growth(0);
                      Model::transient_phases;
                  }) {
        return {Model::n_original, Model::n_vectors, Model::growth(0), Model::transient_phases};
    } else {
        return {};
    }
}

template <class Model, class Method, class R>
inline constexpr call_facts facts_of{
    .embedded_order = Method::embedded_order,
    .scales_tolerances = scales_tolerances<Method>,
    .samples_trajectory = samples_trajectory<Method>,
    .hooks_may_stop = hooks_may_stop<Model, R>(),
    .history_terms = history_terms<Method>,
    .tangents = tangents_of<Model>(),
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
