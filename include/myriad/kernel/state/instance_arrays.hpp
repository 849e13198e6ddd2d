// SPDX-License-Identifier: MIT
// The arrays that an ensemble has for its instances: as pointers in a kernel's arguments, as memory in the ensemble.
#pragma once

#include <cstdint>

#include "myriad/kernel/core/status.hpp"

namespace myriad::detail {

/// One array of each kind. Arrays are structures of arrays: component c of instance i is at `array[c * size + i]`. What
/// is known of each one besides its type is in host/backend/arrays.hpp.
template <template <class> class Array, class R>
struct instance_arrays {
    // read; parameters and times are written only if the model declares it
    Array<R> parameter;
    Array<R> t_begin, t_end;  // none if all instances have the same domain
    Array<R> tolerance_scale;
    // read and written
    Array<R> t;
    Array<R> state;
    Array<R> accessory;
    Array<std::int32_t> integer_accessory;
    // needed to continue in a later call
    Array<R> h_next;               // step to try next
    Array<std::int32_t> phase;     // phases done
    Array<std::int32_t> side;      // per event: see kept_event
    Array<std::uint8_t> ended;     // by action::end_instance or a failure
    Array<myriad::status> status;  // how the last phase ended
    // work done in all calls; none if counting is off
    Array<std::int64_t> accepted;
    Array<std::int64_t> rejected;     // with adaptive methods
    Array<std::int64_t> located;      // steps redone to locate an event, in models with events
    Array<std::int64_t> evaluations;  // of the right-hand side
};
template <class T>
using array_pointer = T*;

}  // namespace myriad::detail
