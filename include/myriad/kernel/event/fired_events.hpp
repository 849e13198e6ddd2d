// SPDX-License-Identifier: MIT
// The events that have fired, passed from the locator to the loop and the hooks.
#pragma once

#include "myriad/kernel/core/vec.hpp"
#include "myriad/kernel/model/concepts.hpp"
#include "myriad/kernel/scalar/mask_set.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// The events that fired at the end of a trial or, in lanes whose trial was not accepted, at its start.
template <class Model, class S>
struct fired_events {
    mask_set<mask_of<S>, n_event<Model>> which;
    vec<S, n_event<Model>> value;  // of all event functions at that time
    mask_of<S> changed;            // lanes in which a hook has since changed inputs of event functions

    /// Sets whether event j fires in lane i, and its function's value.
    MYRIAD_FUNCTION void put(int j, int i, bool happens, real_of<S> g) {
        which.set(j, i, happens);
        set_lane(value[j], i, g);
    }
    /// No event. Values that are no longer read free their registers here.
    MYRIAD_FUNCTION void clear() {
        which.clear();
        changed = mask_of<S>(false);
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(n_event<Model>); ++j) value[j] = S(real_of<S>(0));
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
