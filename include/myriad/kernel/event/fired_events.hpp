// SPDX-License-Identifier: MIT
// The events that have happened, as the locator tells the loop and the hooks.
#pragma once

#include "myriad/kernel/core/vec.hpp"
#include "myriad/kernel/model/concepts.hpp"
#include "myriad/kernel/scalar/mask_set.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// The events that have happened where a trial ended, or where it began in lanes whose trial was not accepted.
template <class Model, class S>
struct fired_events {
    mask_set<mask_of<S>, n_event<Model>> which;
    vec<S, n_event<Model>> value;  // of all event functions there
    vec<S, n_event<Model>> slope;  // along the solution, before the actions
    mask_of<S> changed;            // lanes in which a hook has since changed what event functions depend on

    /// Whether event j happens in lane i, where its function has this value and slope.
    MYRIAD_FUNCTION void put(int j, int i, bool happens, real_of<S> g, real_of<S> g_slope) {
        which.set(j, i, happens);
        set_lane(value[j], i, g);
        set_lane(slope[j], i, g_slope);
    }
    /// No event; values that nobody reads any more take no registers from here on.
    MYRIAD_FUNCTION void clear() {
        which.clear();
        changed = mask_of<S>(false);
        MYRIAD_UNROLL
        for (int j = 0; j < n_event<Model>; ++j) value[j] = slope[j] = S(real_of<S>(0));
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
