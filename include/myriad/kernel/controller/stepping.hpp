// SPDX-License-Identifier: MIT
// One interface to adaptive and to fixed steps.
#pragma once

#include <type_traits>

#include "myriad/kernel/controller/adaptive.hpp"
#include "myriad/kernel/controller/fixed.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// How the steps of a method follow each other:
///
///     load(i), store(i)              what an instance keeps of it between phases and calls
///     choose_step(i, phase)          the step that `initialise` sees
///     begin(i, t)                    a phase of lane i begins at t, after `initialise`
///     propose()                      the next trial: s.h, s.final_step
///     end_time()                     where it ends
///     judge(trial, t1, valid, ...)   accepted lanes; lanes whose step cannot be shortened any more are ended
///     advance(accepted, t1, events)  time moves on in accepted lanes; those at their phase's end, s.ended
///     move(i, t)                     a hook has moved the end of the phase of lane i, which is at t
///     resume(i, h)                   goes on with step h after the location of an event
///     time(i)                        of the committed state
///     look_interval, creeps(i)       after so many iterations in a phase: whether it will never end; 0: never asked
template <class Model, class Method, class S>
using stepping =
    std::conditional_t<is_adaptive<Method>, adaptive_stepping<Model, Method, S>, fixed_stepping<Model, Method, S>>;

}  // namespace myriad::detail::inline MYRIAD_TARGET
