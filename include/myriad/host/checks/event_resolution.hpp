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

/// Whether instances can be asked. With `initialise` in the model they cannot, as `events` must not be called before.
template <class Model>
inline constexpr bool event_resolution_is_known = has_events<Model> && !has_initialise<Model> && !has_delays<Model>;

/// What rounding leaves of an event function, in its unit, by what an instance says: `g` is its value at p = (t, y),
/// with the derivative p dg/dp, and `at_zero` its value at zero.
template <class R>
R event_resolution(const dual<R>& g, R at_zero) {
    constexpr R half_ulp = std::numeric_limits<R>::epsilon() / 2;
    // Rounding of the constant that a function subtracts, as 1e6 in x - 1e6: closer to zero it has no values. The
    // constant is g - p dg/dp, exact for functions linear in p; of others the smaller of its values at p and at zero
    // counts, and none where that is not finite.
    const R here = std::abs(g.value - g.derivative), there = std::abs(at_zero);
    const R of_constant = std::isfinite(here) && std::isfinite(there) ? half_ulp * std::min(here, there) : R(0);
    // A thousandth of the rounding of g at the start. Time advances in steps of its own rounding, and g, which gets
    // from here to zero, in steps proportional to them; a thousandth, since it may slow down on its way.
    const R of_start = std::isfinite(g.value) ? half_ulp * R(1e-3) * std::abs(g.value) : R(0);
    return std::max(of_constant, of_start);
}

/// That of each event function of a model, for an instance that begins at time t in state `start`.
template <class Model, class R>
void write_event_resolution(R t, const vec<R, n_state<Model>>& start, const inputs<Model, R>& p, R* finest) {
    vec<dual<R>, n_state<Model>> y;
    vec<R, n_state<Model>> origin;
    for (int c = 0; c < n_state<Model>; ++c) {
        y[c] = dual<R>(start[c], start[c]);
        origin[c] = R(0);
    }
    const auto g = Model::template events<dual<R>>(dual<R>(t, t), y, p);
    const auto g0 = Model::template events<R>(R(0), origin, p);
    for (int j = 0; j < n_event<Model>; ++j) finest[j] = event_resolution(g[j], g0[j]);
}

}  // namespace myriad::host::inline MYRIAD_ABI
