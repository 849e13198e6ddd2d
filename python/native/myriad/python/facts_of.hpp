// SPDX-License-Identifier: MIT
// What a model, compiled with a method for a real type, tells of itself.
#pragma once

#include "myriad/kernel/controller/adaptive.hpp"
#include "myriad/kernel/model/hooks.hpp"
#include "myriad/python/any_arguments.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

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
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
