// SPDX-License-Identifier: MIT
// The functions of a model and a method that checks and notes call: for host code that knows them when it is compiled,
// and for what is compiled at run time.
#pragma once

#include "myriad/host/checks/event_resolution.hpp"
#include "myriad/host/checks/instance_functions.hpp"
#include "myriad/host/checks/instance_inputs.hpp"
#include "myriad/host/checks/linearisation.hpp"
#include "myriad/host/report/stability.hpp"
#include "myriad/kernel/study/generator.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

template <class Model, class Method, class R>
constexpr instance_functions<R> functions_of() {
    instance_functions<R> all;
    if constexpr (host::may_advise_stiff_methods<Model, Method>) {
        all.rhs = [](const argument_head<R>& a, std::int64_t i, R t, const R* y, R* slopes) {
            vec<R, n_state<Model>> state;
            for (int c = 0; c < n_state<Model>; ++c) state[c] = y[c];
            const auto f = detail::evaluate_rhs<Model>(t, state, detail::inputs_of<Model>(a, i));
            for (int c = 0; c < n_state<Model>; ++c) slopes[c] = f[c];
        };
        all.stability_limit = &host::real_stability_limit<Method>;
    }
    if constexpr (host::event_resolution_is_known<Model>) {
        all.event_resolution = [](const argument_head<R>& a, std::int64_t i, R* finest) {
            host::write_event_resolution<Model, R>(detail::begin_of(a, i), detail::state_of<Model>(a, i),
                                                   detail::inputs_of<Model>(a, i), finest);
        };
    }
    if constexpr (!has_initialise<Model>) detail::add_linearisation<Model>(all);
    if constexpr (generates<Model, R>) {
        all.generate = [](const argument_head<R>& a, std::uint64_t seed, std::int64_t begin, std::int64_t end) {
            for (std::int64_t i = begin; i < end; ++i) detail::generate_instance<Model, R>(a, a, a.shared, seed, i);
        };
    }
    return all;
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
