// SPDX-License-Identifier: MIT
// Fixed steps: how many there are in a domain and which is the last.
#pragma once

#include <limits>

#include "myriad/integrator/state.hpp"

namespace myriad::inline MYRIAD_TARGET {

/// Lays the steps of lane i from t to t_end: their number, and the last one, which ends exactly at t_end. A domain that
/// is a whole number of steps up to rounding gets that number, without a sliver at the end.
template <class Model, class Method, class S>
MYRIAD_FUNCTION void lay_fixed_steps(const kernel_arguments<Model, real_of<S>>& args,
                                     integration_state<Model, Method, S>& s, int i, real_of<S> t) {
    using R = real_of<S>;
    // Past it counts are no longer exact; options::max_steps, which is checked to be smaller, ends the phase before.
    constexpr R most = std::numeric_limits<R>::digits > 31 ? R(2147483647) : R(16777216);
    const R t_end = get_lane(s.data.t_end, i);
    const R signed_step = copysign(args.step, t_end - t);
    const R ratio = abs(t_end - t) / args.step;
    const R steps = -floor(R(1e-6) - ratio * (R(1) - R(4) * epsilon_of<R>));
    const R bounded = min(max(steps, R(1)), most);
    args.t[s.instance[i]] = t;
    set_lane(s.base, i, t);
    set_lane(s.step, i, signed_step);
    set_count(s.done, i, 0);
    set_count(s.left, i, bounded);
}

/// The end of lane i's time domain, for rare use: from the ensemble, so that it need not stay in a register.
template <class Model, class Method, class S>
MYRIAD_FUNCTION real_of<S> domain_end(const kernel_arguments<Model, real_of<S>>& args,
                                      const integration_state<Model, Method, S>& s, int i) {
    if constexpr (writes_time_domain<Model>) return get_lane(s.data.t_end, i);
    return args.t_end != nullptr ? args.t_end[s.instance[i]] : args.common_t_end;
}

/// Time of lane i's committed state. For rare use: from the ensemble's array, so that a model whose right-hand side does
/// not depend on time keeps none in its registers. Exactly t_end after the last step.
template <class Model, class Method, class S>
MYRIAD_FUNCTION real_of<S> fixed_step_time(const kernel_arguments<Model, real_of<S>>& args,
                                           const integration_state<Model, Method, S>& s, int i) {
    using R = real_of<S>;
    if (get_lane(s.left, i) == 0) return domain_end(args, s, i);
    return fma(static_cast<R>(get_lane(s.done, i)), get_lane(s.step, i), args.t[s.instance[i]]);
}

/// The next step of every lane: the fixed one, or what is left of the domain.
template <class Model, class Method, class S>
MYRIAD_FUNCTION void propose_fixed_step(const kernel_arguments<Model, real_of<S>>& args,
                                        integration_state<Model, Method, S>& s) {
    using count = typename integration_state<Model, Method, S>::count;
    s.final_step = s.left <= count(1);
    s.h = s.step;
    if (MYRIAD_UNLIKELY(any(s.final_step))) {
        for_each_lane(s.running() & s.final_step, [&](int i) MYRIAD_LAMBDA {
            set_lane(s.h, i, domain_end(args, s, i) - fixed_step_time(args, s, i));
        });
    }
}

}  // namespace myriad::inline MYRIAD_TARGET
