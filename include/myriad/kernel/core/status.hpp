// SPDX-License-Identifier: MIT
// How an instance ended, and what a hook may request: the two enumerations exchanged by host and kernel.
#pragma once

#include <cstdint>

#include "myriad/kernel/core/macros.hpp"

namespace myriad {

/// How the last integration phase of an instance ended. Values from `max_steps` on are failures: the state is the last
/// finite one, and the instance takes no further part until the ensemble is restarted.
enum class status : std::uint8_t {
    not_started,         ///< never integrated
    success,             ///< reached the end of its time domain
    stopped_by_event,    ///< an event reached the number of detections at which it stops the phase
    stopped_by_user,     ///< a hook returned `action::end_phase` or `action::end_instance`
    max_steps,           ///< more trial steps in one phase than `options::max_steps`
    step_underflow,      ///< the error test failed at the minimum step, or the step became negligible against t
    not_finite,          ///< the right-hand side, an event function or a hook gave a non-finite value
    event_accumulation,  ///< actions of one event accumulated on its surface (Zeno), or stops at one time; t is when
                         ///< the last one was counted: a bouncing ball comes to rest 2 v / (g (1 - e)) later
                         ///< (docs/numerics/events.md)
    singular_jacobian,  ///< a linear solve of an implicit method failed, or no algebraic states satisfy their equations
    invalid_input,      ///< a state, parameter or time was not finite at the start
    queue_overflow,     ///< a hook returned `action::overflow`: no room for an action that is to run later
    history_overflow,   ///< a delay reaches further back than the `options::history_steps` steps that are kept
    invalid_delay,      ///< a delay is negative, zero or not a number, or a fixed step is longer than it
    interrupted,  ///< the call ended before: by its time limit, or half a second after the progress function asked
};
/// The number of statuses.
inline constexpr int status_count = 14;

/// True for the statuses that end an instance for good.
MYRIAD_FUNCTION bool is_failure(status s) { return s >= status::max_steps; }

/// The request made by a scalar hook's return value; a hook that returns nothing requests to proceed.
enum class action : std::uint8_t {
    proceed,       ///< continue
    end_phase,     ///< end this integration phase here
    end_instance,  ///< end the instance: no further phases
    overflow,      ///< end the instance as `queue_overflow`, in models with stop times; elsewhere as `end_phase`
};

}  // namespace myriad
