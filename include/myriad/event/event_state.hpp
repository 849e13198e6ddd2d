// SPDX-License-Identifier: MIT
// What is remembered of the events of a pack between its steps, the event functions with their slopes along the solution,
// and choosing among the events of each lane.
#pragma once

#include <cstdint>

#include "myriad/model/lane.hpp"
#include "myriad/scalar/dual.hpp"
#include "myriad/scalar/math.hpp"

namespace myriad::inline MYRIAD_TARGET {

/// By what a side is multiplied while it is kept between phases.
namespace event_sides {
/// The function was beyond its tolerance: if the next phase begins within it, something other than the integration put it
/// there (finalise, the host, a time that starts again).
inline constexpr int beyond = 2;
/// The phase ended on a jump of the function: on which side the next one begins is to be seen.
inline constexpr int on_jump = 3;
}  // namespace event_sides

/// What is remembered of the events of a pack. Absent, and empty, for a model without events.
template <class Model, class S>
struct event_state {
    static constexpr int m = n_event<Model>;
    using mask = mask_of<S>;
    vec<S, m> value;       // event functions at the committed state
    vec<S, m> side;        // -1, +1: the side last seen; 0: on the surface, not yet known
    vec<S, m> heading;     // slope of a firing function along the solution, before the actions
    vec<mask, m> target;   // the event a lane is being stepped to
    vec<mask, m> crossed;  // events that crossed in the trial in which the target was found
    vec<mask, m> firing;   // events that have happened at the committed state
    vec<mask, m> left;     // the function has been beyond its tolerance since the event last fired
    mask locating;         // lanes whose next trial is a step redone to the time of an event
    S h_redo;              // its length
    S h_resume;            // the step size to go on with afterwards
    S h_before, h_beyond;  // longest step known to end before the event, shortest beyond it
    S tries;
    std::int32_t lingered[m][lanes_of<S>];
};

template <class Model, class S>
MYRIAD_FUNCTION vec<S, n_event<Model>> evaluate_events(const S& t, const vec<S, n_state<Model>>& y,
                                                       const inputs<Model, S>& p) {
    return Model::template events<S>(t, y, p);
}

/// Derivatives of the event functions along the solution that passes (t, y) with the given slope.
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

template <class S>
MYRIAD_FUNCTION S sign_of(const S& x) {
    using R = real_of<S>;
    return select(x > S(R(0)), S(R(1)), select(x < S(R(0)), S(R(-1)), S(R(0))));
}

/// Whether any of the event's masks holds, lane by lane.
template <class M, int m>
MYRIAD_FUNCTION M any_event(const vec<M, m>& masks) {
    M joined = masks[0];
    MYRIAD_UNROLL
    for (int j = 1; j < m; ++j) joined = joined | masks[j];
    return joined;
}

/// The value of the first event whose mask holds.
template <class M, class S, int m>
MYRIAD_FUNCTION S pick(const vec<M, m>& which, const vec<S, m>& values) {
    S picked = values[m - 1];
    MYRIAD_UNROLL
    for (int j = m - 2; j >= 0; --j) picked = select(which[j], values[j], picked);
    return picked;
}

/// Keeps only the first event of each lane.
template <class M, int m>
MYRIAD_FUNCTION vec<M, m> first_event(const vec<M, m>& masks) {
    vec<M, m> first;
    M seen = M(false);
    MYRIAD_UNROLL
    for (int j = 0; j < m; ++j) {
        first[j] = masks[j] & !seen;
        seen = seen | masks[j];
    }
    return first;
}

}  // namespace myriad::inline MYRIAD_TARGET
