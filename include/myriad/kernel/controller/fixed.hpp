// SPDX-License-Identifier: MIT
// Fixed steps: how many there are in a domain and which is the last.
#pragma once

#include <limits>

#include "myriad/kernel/state/integration_state.hpp"
#include "myriad/kernel/state/phase_interval.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// base + done * step - t, without the rounding of such times: that of base - t is added (Knuth, The Art of Computer
/// Programming 2, 4.2.2, theorem B).
template <class R>
MYRIAD_FUNCTION R elapsed_beyond(R base, R t, R done, R step) {
    const R difference = base - t;
    const R subtracted = base - difference;
    const R rounding = (base - (difference + subtracted)) + (subtracted - t);
    return fma(done, step, difference) + rounding;
}

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

/// Lays the steps of lane i anew from t, where it is after `done` steps up to rounding, which time_low keeps, or after
/// the last one.
template <class Model, class Method, class S>
MYRIAD_FUNCTION void move_fixed_steps(const kernel_arguments<Model, real_of<S>>& args,
                                      integration_state<Model, Method, S>& s, int i, real_of<S> t) {
    using R = real_of<S>;
    const R taken =
        detail::elapsed_beyond(get_lane(s.base, i), t, static_cast<R>(get_lane(s.done, i)), get_lane(s.step, i));
    set_lane(s.time_low, i, get_lane(s.left, i) == 0 ? R(0) : get_lane(s.time_low, i) + taken);
    detail::lay_fixed_steps(args, s, i, t);
}

/// Where lane i's phase is to end, for rare use: from the ensemble, so that it need not stay in a register. With
/// events, which compare it with t at every step, it does.
template <class Model, class Method, class S>
MYRIAD_FUNCTION real_of<S> domain_end(const kernel_arguments<Model, real_of<S>>& args,
                                      const integration_state<Model, Method, S>& s, int i) {
    if constexpr (writes_time_domain<Model> || has_events<Model>) {
        return get_lane(s.data.t_end, i);
    } else {
        const bool own = args.t_end != nullptr;
        const auto t_end = own ? args.t_end[s.instance[i]] : args.common_t_end;
        if (args.phase_length == real_of<S>(0)) return t_end;
        const auto t_begin = own ? args.t_begin[s.instance[i]] : args.common_t_begin;
        return detail::interval_from(args, args.t[s.instance[i]], t_begin, t_end)
            .end;  // where the steps were laid from
    }
}

/// Time of lane i's committed state. For rare use: from the ensemble's array, so that a model whose right-hand side
/// does not depend on time keeps none in its registers. Exactly t_end after the last step.
template <class Model, class Method, class S>
MYRIAD_FUNCTION real_of<S> fixed_step_time(const kernel_arguments<Model, real_of<S>>& args,
                                           const integration_state<Model, Method, S>& s, int i) {
    using R = real_of<S>;
    if (get_lane(s.left, i) == 0) return detail::domain_end(args, s, i);
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
        using R = real_of<S>;
        for_each_lane(s.running() & s.final_step, [&](int i) MYRIAD_LAMBDA {
            R beyond = detail::elapsed_beyond(args.t[s.instance[i]], detail::domain_end(args, s, i),
                                              static_cast<R>(get_lane(s.done, i)), get_lane(s.step, i));
            if constexpr (keeps_time_low<Model, Method, R>) beyond += get_lane(s.time_low, i);
            set_lane(s.h, i, -beyond);
        });
    }
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
