// SPDX-License-Identifier: MIT
// What host code that is compiled once, for all models, has to know of one. Host code only.
#pragma once

#include "myriad/host/model/numbering.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/model/concepts.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// How many components of each kind a model has, and how messages name them.
struct model_shape {
    int n_state, n_parameter, n_shared, n_shared_integer, n_accessory, n_integer_accessory, n_event;
    bool writes_parameters, writes_time_domain;
    component_label (*state)(const model_shape&, int);
    component_label (*parameter)(const model_shape&, int);
    component_label (*shared)(const model_shape&, int);
};
/// What a numbering calls component c of any model of that shape.
template <class Numbering>
component_label label_of(const model_shape&, int c) {
    return Numbering::label(c);
}
template <class Model>
inline constexpr model_shape shape_of{
    .n_state = detail::n_state<Model>,
    .n_parameter = detail::n_parameter<Model>,
    .n_shared = detail::n_shared<Model>,
    .n_shared_integer = detail::n_shared_integer<Model>,
    .n_accessory = detail::n_accessory<Model>,
    .n_integer_accessory = detail::n_integer_accessory<Model>,
    .n_event = detail::n_event<Model>,
    .writes_parameters = detail::writes_parameters<Model>,
    .writes_time_domain = detail::writes_time_domain<Model>,
    .state = &label_of<state_numbering<Model>>,
    .parameter = &label_of<parameter_numbering<Model>>,
    .shared = &label_of<shared_numbering<Model>>,
};

}  // namespace myriad::host::inline MYRIAD_ABI
