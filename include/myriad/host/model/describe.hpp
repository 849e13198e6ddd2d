// SPDX-License-Identifier: MIT
// Describes what the library finds in a model, which reveals a misspelt hook.
#pragma once

#include <string>

#include "myriad/host/core/error.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/model/concepts.hpp"
#include "myriad/kernel/model/hooks.hpp"
#include "myriad/kernel/scalar/matrix_loop.hpp"
#include "myriad/kernel/stepper/sparse_lu.hpp"

namespace myriad {

namespace host::inline MYRIAD_ABI {

/// Where stiff methods keep a model's LU factors, and how many entries they have.
template <class Model>
std::string lu_factors_of() {
    if constexpr (factorises_sparsely<Model>) {
        constexpr int n = n_state<Model>;
        return message("of ", n_factor_entry<Model>, " entries instead of ", n * n, ", for ", n_jacobian_entry<Model>,
                       " of the Jacobian, ",
                       has_jacobian_pattern<Model> ? "as declared" : "found when the model was compiled");
    } else {
        return matrix_loop<double, n_state<Model>>::unrolled ? "on GPUs in registers" : "on GPUs in local memory";
    }
}

}  // namespace host::inline MYRIAD_ABI

/// A few lines of text: the model's numbers of components, its hooks, its declarations, and how methods for stiff
/// systems treat it.
template <class Model>
[[nodiscard]] std::string describe() {
    static_assert(detail::hooks_fit<Model, double>);
    std::string hooks = "rhs", declares;
    const auto add = [](std::string& to, bool present, const char* name) {
        if (present) to += (to.empty() ? "" : ", ") + std::string(name);
    };
    add(hooks, detail::gives_jacobian<Model>, "jacobian");
    add(hooks, detail::has_events<Model>, "events");
    if constexpr (detail::has_summaries<Model>)
        hooks += message(", observe (", detail::n_summary<Model>,
                         detail::n_summary<Model> == 1 ? " summary)" : " summaries)");
    if constexpr (detail::has_diffusion<Model>)
        hooks += message(", diffusion (", detail::n_wiener<Model>,
                         detail::n_wiener<Model> == 1 ? " process)" : " processes)");
    add(hooks, detail::has_initialise<Model>, "initialise");
    add(hooks, detail::has_after_step<Model>,
        detail::has_generic_after_step<Model> ? "after_step (generic)" : "after_step (scalar)");
    add(hooks, detail::has_after_event<Model>, "after_event");
    add(hooks, detail::has_triggers<Model>, "condition, after_trigger");
    add(hooks, detail::has_stops<Model>, "stop_time");
    if constexpr (detail::has_delays<Model>)
        hooks += message(", lag (", detail::n_delayed<Model>, detail::n_delayed<Model> == 1 ? " value)" : " values)");
    add(hooks, detail::has_history<Model>, "history");
    add(hooks, detail::has_after_stop<Model>, "after_stop");
    add(hooks, detail::has_finalise<Model>, "finalise");
    add(declares, detail::writes_parameters<Model>, "writes_parameters");
    add(declares, detail::writes_time_domain<Model>, "writes_time_domain");
    add(declares, detail::accessories_are_outputs<Model>, "accessories_are_outputs");
    add(declares, detail::scalar_only<Model>, "scalar_only");
    add(declares, detail::rare_events<Model>, "rare_events");
    add(declares, detail::large_rhs<Model>, "large_rhs");
    add(declares, detail::autonomous<Model>, "autonomous");
    add(declares, detail::has_jacobian_pattern<Model>, "jacobian_pattern");
    add(declares, detail::additive_noise<Model>, "additive_noise");
    std::string counts;
#define MYRIAD_SHOW_COUNT(kind, plural, words, type) \
    counts += message(counts.empty() ? "" : ", ", detail::n_##kind<Model>, ' ', words);
    MYRIAD_COMPONENT_KINDS(MYRIAD_SHOW_COUNT)
#undef MYRIAD_SHOW_COUNT
    return message(
        "components: ", counts, "\nhooks: ", hooks, "\ndeclares: ", declares.empty() ? "nothing" : declares,
        "\nstiff methods: ", detail::gives_jacobian<Model> ? "the model's Jacobian" : "Jacobian by dual numbers",
        ", LU factors ", host::lu_factors_of<Model>(), '\n');
}

}  // namespace myriad
