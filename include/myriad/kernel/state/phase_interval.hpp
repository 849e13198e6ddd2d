// SPDX-License-Identifier: MIT
// Phases of a given length: where the one that goes on from some time begins and ends.
#pragma once

#include "myriad/kernel/scalar/math.hpp"
#include "myriad/kernel/state/kernel_arguments.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

template <class R>
struct phase_interval {
    R begin, end;
};

/// The interval between two of the times t_begin + k phase_length that leads on from t, towards t_end and no further.
/// Each end is computed from t_begin, so that no rounding adds up; t counts as on an end if rounding alone keeps it
/// from it. A phase that an event or a hook ended early leaves the rest of its interval to the next.
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
