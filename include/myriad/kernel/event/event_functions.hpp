// SPDX-License-Identifier: MIT
// A model's event functions, and their slopes along the solution.
#pragma once

#include "myriad/kernel/model/lane.hpp"
#include "myriad/kernel/scalar/dual.hpp"
#include "myriad/kernel/scalar/math.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

template <class Model, class S>
MYRIAD_FUNCTION vec<S, n_event<Model>> evaluate_events(const S& t, const vec<S, n_state<Model>>& y,
                                                       const inputs<Model, S>& p) {
    return Model::template events<S>(t, y, p);
}

/// Derivatives of the event functions along the solution through (t, y) with the given slope.
template <class Model, class S>
MYRIAD_FUNCTION vec<S, n_event<Model>> event_slopes(const S& t, const vec<S, n_state<Model>>& y,
                                                    const vec<S, n_state<Model>>& slope, const inputs<Model, S>& p) {
    using R = real_of<S>;
    vec<dual<S>, n_state<Model>> y_dual;
    MYRIAD_UNROLL
    for (int c = 0; c < n_state<Model>; ++c) y_dual[c] = dual<S>(y[c], slope[c]);
    const auto g = Model::template events<dual<S>>(dual<S>(t, S(R(1))), y_dual, p);
    vec<S, n_event<Model>> slopes;
    MYRIAD_UNROLL
    for (int j = 0; j < n_event<Model>; ++j) slopes[j] = g[j].derivative;
    return slopes;
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
