// SPDX-License-Identifier: MIT
// Says what the library sees in a model, so that a misspelt hook shows.
#pragma once

#include <string>

#include "myriad/core/error.hpp"
#include "myriad/scalar/matrix_loop.hpp"
#include "myriad/model/concepts.hpp"
#include "myriad/model/hooks.hpp"

namespace myriad {

/// A few lines for people: the model's counts of components, its hooks, its declarations, and what methods for stiff
/// systems make of it.
template <class Model>
[[nodiscard]] std::string describe() {
    static_assert(hooks_fit<Model, double>);
    std::string hooks = "rhs", declares;
    const auto add = [](std::string& to, bool present, const char* name) {
        if (present) to += (to.empty() ? "" : ", ") + std::string(name);
    };
    add(hooks, gives_jacobian<Model>, "jacobian");
    add(hooks, has_events<Model>, "events");
    add(hooks, has_initialise<Model>, "initialise");
    add(hooks, has_after_step<Model>, has_generic_after_step<Model> ? "after_step (generic)" : "after_step (scalar)");
    add(hooks, has_after_event<Model>, "after_event");
    add(hooks, has_finalise<Model>, "finalise");
    add(declares, writes_parameters<Model>, "writes_parameters");
    add(declares, writes_time_domain<Model>, "writes_time_domain");
    add(declares, accessories_are_outputs<Model>, "accessories_are_outputs");
    add(declares, scalar_only<Model>, "scalar_only");
    add(declares, rare_events<Model>, "rare_events");
    return message("components: ", n_state<Model>, " state, ", n_parameter<Model>, " parameter, ", n_shared<Model>,
                   " shared, ", n_shared_integer<Model>, " shared integer, ", n_accessory<Model>, " accessory, ",
                   n_integer_accessory<Model>, " integer accessory, ", n_event<Model>, " event\nhooks: ", hooks,
                   "\ndeclares: ", declares.empty() ? "nothing" : declares, "\nstiff methods: ",
                   gives_jacobian<Model> ? "the model's Jacobian" : "Jacobian by dual numbers", ", LU factors on GPUs in ",
                   matrix_loop<double, n_state<Model>>::unrolled ? "registers" : "local memory", '\n');
}

}  // namespace myriad
