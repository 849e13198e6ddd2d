// SPDX-License-Identifier: MIT
// Host side of sensitivities: their values where the solution starts.
#pragma once

#include "myriad/host/ensemble/ensemble.hpp"
#include "myriad/kernel/model/sensitivity.hpp"

namespace myriad {

/// Sets the sensitivities of all instances where the solution starts: one of an initial state by itself, and zero of
/// all others. Where initial states depend on the components, set their derivatives afterwards.
template <class wrapped, class R>
requires(wrapped::n_directions > 0) void initial_sensitivities(ensemble<wrapped, R>& e) {
    for (int i = 0; i < wrapped::n_directions; ++i) {
        const detail::moving_component its = wrapped::directions::all[i];
        for (int c = 0; c < wrapped::n_original; ++c)
            e.state(wrapped::sensitivity(c, i)) =
                static_cast<R>(its.kind == detail::moving::state && its.number == c ? 1 : 0);
    }
}

}  // namespace myriad
