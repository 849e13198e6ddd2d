// SPDX-License-Identifier: MIT
// What a model, compiled with a method for a real type, tells of itself.
#pragma once

#include "myriad/kernel/controller/adaptive.hpp"
#include "myriad/kernel/model/hooks.hpp"
#include "myriad/python/any_arguments.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// Where a model `with_tangents` has what notes about its exponents look at.
struct tangent_facts {
    std::int32_t n_original, n_vectors, first_growth, transient_phases;
};
template <class Model>
constexpr tangent_facts tangent_facts_of() {
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
inline constexpr python::model_facts facts_of{
    .interface_version = python::interface_version,
    .real_bytes = sizeof(R),
    .n_state = n_state<Model>,
    .n_parameter = n_parameter<Model>,
    .n_shared = n_shared<Model>,
    .n_shared_integer = n_shared_integer<Model>,
    .n_accessory = n_accessory<Model>,
    .n_integer_accessory = n_integer_accessory<Model>,
    .n_event = n_event<Model>,
    .embedded_order = Method::embedded_order,
    .writes_parameters = writes_parameters<Model>,
    .writes_time_domain = writes_time_domain<Model>,
    .hooks_may_stop = hooks_may_stop<Model, R>(),
    .scales_tolerances = scales_tolerances<Method>,
    .samples_trajectory = samples_trajectory<Method>,
    .n_original = tangent_facts_of<Model>().n_original,
    .n_vectors = tangent_facts_of<Model>().n_vectors,
    .first_growth = tangent_facts_of<Model>().first_growth,
    .transient_phases = tangent_facts_of<Model>().transient_phases,
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
