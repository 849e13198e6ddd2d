// SPDX-License-Identifier: MIT
// How closely rounding lets event functions come to zero. Host code, which calls the model's `events`.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/model/hooks.hpp"
#include "myriad/kernel/model/lane.hpp"
#include "myriad/kernel/scalar/dual.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// What one instance says about the resolution of event functions, in their units.
template <class Model, class R>
struct event_resolution {
    /// Rounding of the constant that a function subtracts, as 1e6 in x - 1e6: closer to zero it has no values. The
    /// constant is g - p dg/dp, exact for functions linear in p = (t, y); of others the smaller of its values at p and
    /// at zero counts, and none where that is not finite.
    vec<R, n_event<Model>> of_constant;
    /// A thousandth of the rounding of g at the start. Time advances in steps of its own rounding, and g, which gets
    /// from here to zero, in steps proportional to them; a thousandth, since it may slow down on its way.
    vec<R, n_event<Model>> of_start;

    /// Whether instances can be asked: not those of models with `initialise`, before which `events` cannot be called.
    static constexpr bool is_known = has_events<Model> && !has_initialise<Model>;

    /// Of an instance that begins at time t in state `start`.
    event_resolution(R t, const vec<R, n_state<Model>>& start, const inputs<Model, R>& p) {
        vec<dual<R>, n_state<Model>> y;
        vec<R, n_state<Model>> origin;
        for (int c = 0; c < n_state<Model>; ++c) {
            y[c] = dual<R>(start[c], start[c]);
            origin[c] = R(0);
        }
        const auto g = Model::template events<dual<R>>(dual<R>(t, t), y, p);  // derivative: p dg/dp
        const auto g0 = Model::template events<R>(R(0), origin, p);
        constexpr R half_ulp = std::numeric_limits<R>::epsilon() / 2;
        for (int j = 0; j < n_event<Model>; ++j) {
            const R here = std::abs(g[j].value - g[j].derivative), there = std::abs(g0[j]);
            of_constant[j] = std::isfinite(here) && std::isfinite(there) ? half_ulp * std::min(here, there) : R(0);
            of_start[j] = std::isfinite(g[j].value) ? half_ulp * R(1e-3) * std::abs(g[j].value) : R(0);
        }
    }

    /// What rounding leaves of each function: the larger of both.
    void write(R* finest) const {
        for (int j = 0; j < n_event<Model>; ++j) finest[j] = std::max(of_constant[j], of_start[j]);
    }
};

}  // namespace myriad::host::inline MYRIAD_ABI
