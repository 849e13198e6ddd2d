// SPDX-License-Identifier: MIT
// What host code that is compiled once, for all models, has to know of one. Host code only.
#pragma once

#include "myriad/host/model/numbering.hpp"
#include "myriad/kernel/model/concepts.hpp"

namespace myriad::host {

/// How many components of each kind a model has, and how messages name them.
struct model_shape {
    int n_state, n_parameter, n_shared, n_shared_integer, n_accessory, n_integer_accessory, n_event;
    bool writes_time_domain;
    component_label (*state)(int);
    component_label (*parameter)(int);
    component_label (*shared)(int);
};
template <class Model>
inline constexpr model_shape shape_of{detail::n_state<Model>,         detail::n_parameter<Model>,
                                      detail::n_shared<Model>,        detail::n_shared_integer<Model>,
                                      detail::n_accessory<Model>,     detail::n_integer_accessory<Model>,
                                      detail::n_event<Model>,         detail::writes_time_domain<Model>,
                                      &state_numbering<Model>::label, &parameter_numbering<Model>::label,
                                      &shared_numbering<Model>::label};

}  // namespace myriad::host
