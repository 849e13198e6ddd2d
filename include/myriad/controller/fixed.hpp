// SPDX-License-Identifier: MIT
// Fixed steps: how many there are in a domain and which is the last.
#pragma once

#include <limits>

#include "myriad/integrator/state.hpp"

namespace myriad::inline MYRIAD_TARGET {

/// Lays the steps of lane i from t to t_end: their number, and the last one, which ends exactly at t_end. A domain that
/// is a whole number of steps up to rounding gets that number, without a sliver at the end.
template <class Model, class Method, class S>
MYRIAD_FUNCTION void lay_fixed_steps(integration_state<Model, Method, S>& s, int i, real_of<S> t, real_of<S> step) {
    using R = real_of<S>;
    // Past it counts are no longer exact; options::max_steps, which is checked to be smaller, ends the phase before.
    constexpr R most = std::numeric_limits<R>::digits > 31 ? R(2147483647) : R(16777216);
    const R t_end = get_lane(s.data.t_end, i);
    const R signed_step = copysign(step, t_end - t);
    const R ratio = abs(t_end - t) / step;
    const R steps = -floor(R(1e-6) - ratio * (R(1) - R(4) * std::numeric_limits<R>::epsilon()));
    const R bounded = min(max(steps, R(1)), most);
    set_lane(s.base, i, t);
    set_lane(s.step, i, signed_step);
    set_count(s.done, i, 0);
    set_count(s.left, i, bounded);
    set_lane(s.last_step, i, t_end - fma(bounded - R(1), signed_step, t));
}

/// The next step of every lane: the fixed one, or what is left of the domain.
template <class Model, class Method, class S>
MYRIAD_FUNCTION void propose_fixed_step(integration_state<Model, Method, S>& s) {
    using count = typename integration_state<Model, Method, S>::count;
    s.final_step = s.left <= count(1);
    s.h = select(s.final_step, s.last_step, s.step);
}

}  // namespace myriad::inline MYRIAD_TARGET
