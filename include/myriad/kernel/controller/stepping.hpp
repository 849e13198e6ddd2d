// SPDX-License-Identifier: MIT
// One interface to adaptive and fixed steps.
#pragma once

#include <type_traits>

#include "myriad/kernel/controller/adaptive.hpp"
#include "myriad/kernel/controller/adaptive_on_path.hpp"
#include "myriad/kernel/controller/fixed.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// How the steps of a method follow one another:
///
///     load(i), store(i)              what an instance keeps between phases and calls
///     choose_step(i, phase)          the step that `initialise` sees
///     begin(i, t)                    a phase of lane i begins at t, after `initialise`
///     propose(locating)              the next trial: s.h, s.final_step; `locating`: redone, to end at an event
///     end_time()                     the time at which it ends
///     judge(trial, t1, valid, end_stuck)
///                                    accepts or rejects the trial: a `step_decision`, which the loop carries out;
///                                    `end_stuck(failed, still)` ends the lanes that failed at their shortest step and,
///                                    of those whose step does not advance t, the ones that it returns
///     failure_of(i)                  the status of lane i, if it is stuck
///     advance(accepted, t1, at_event)
///                                    advances time in accepted lanes; returns those that are at the phase's end
///     move(i, t)                     a hook has moved the end of the phase of lane i, which is at t
///     resume(i, h)                   continues with step h after event location
///     time(i)                        time of the committed state
///     stagnation_interval, stagnates(i)
///                                    every so many iterations: will the phase never end? 0: no check
template <class Model, class Method, class S>
using stepping =
    std::conditional_t<!is_adaptive<Method>, fixed_stepping<Model, Method, S>,
                       std::conditional_t<stochastic_method<Method>, adaptive_stepping_on_path<Model, Method, S>,
                                          adaptive_stepping<Model, Method, S>>>;

}  // namespace myriad::detail::inline MYRIAD_TARGET
