// SPDX-License-Identifier: MIT
// Phases of a given length: the interval of the phase that starts at a given time.
#pragma once

#include "myriad/kernel/scalar/math.hpp"
#include "myriad/kernel/state/kernel_arguments.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

template <class R>
struct phase_interval {
    R begin, end;
};

/// The interval between two of the times t_begin + k phase_length that leads from t towards t_end, and not beyond it.
/// Both ends are computed from t_begin, so that rounding does not accumulate; t counts as an end if it differs by
/// rounding alone. A phase ended early by an event or a hook leaves the rest of its interval to the next.
template <class Model, class R>
MYRIAD_FUNCTION phase_interval<R> interval_from(const kernel_arguments<Model, R>& args, R t, R t_begin, R t_end) {
    const R length = copysign(args.phase_length, t_end - t);
    const R rounding = R(4) * epsilon_of<R> * (max(abs(t), abs(t_begin)) + args.phase_length);
    const R nearest = floor((t - t_begin) * copysign(args.phases_per_time, length) + R(0.5));
    const R ahead = (fma(nearest, length, t_begin) - t) * copysign(R(1), length);
    const R first = ahead > rounding ? nearest - R(1) : nearest;
    const R end = fma(first + R(1), length, t_begin);
    const bool is_last = !(abs(t_end - t) > abs(end - t) + rounding);
    return {fma(first, length, t_begin), is_last ? t_end : end};
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
