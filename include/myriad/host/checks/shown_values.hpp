// SPDX-License-Identifier: MIT
// What a model's functions give for one instance, as plain values with what they are: by which a study tells whether a
// model is the one that it was begun with.
#pragma once

#include <cstdint>

#include "myriad/kernel/state/kernel_arguments.hpp"

namespace myriad::detail {

/// A function of a model.
enum class model_function : std::uint8_t {
    start,  ///< what the instance begins with
    rhs,
    mass_matrix,
    events,
    observe,
    summary,
    stop_time,
    condition,
    initialise,
    after_step,
    after_event,
    after_stop,
    after_trigger,
    finalise,
};

/// What a function gives or an action changes.
enum class shown_kind : std::uint8_t {
    result,  ///< of a function that returns one number, and of one that returns several their number
    state,
    parameter,
    accessory,
    integer_accessory,
    t_begin,
    t_end,
    next_step,
    wish,  ///< of an action: to end the phase or the instance
};

/// One value.
struct shown_value {
    model_function function;
    std::int32_t number;  ///< of the event, stop or trigger
    shown_kind kind;
    std::int32_t component;
    double value;
};

/// Where the functions are called.
struct shown_place {
    int at = 0;        ///< 0: the start; others: in its neighbourhood, so that terms which vanish there are seen, too
    int rounding = 0;  ///< others than 0: all real inputs differ by some roundings
};

/// Calls `take(to, value)` for what the functions of a model give for instance i; of actions, for what they change.
template <class R>
using behaviour_function = void (*)(const argument_head<R>&, std::int64_t i, const shown_place&, void* to,
                                    void (*take)(void* to, const shown_value&));

}  // namespace myriad::detail
