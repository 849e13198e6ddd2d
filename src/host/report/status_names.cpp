// SPDX-License-Identifier: MIT
// Names of statuses.
#include "myriad/host/report/status_names.hpp"

#include <iterator>

namespace myriad {

const char* name_of(status s) {
    constexpr const char* names[] = {"not_started",       "success",        "stopped_by_event", "stopped_by_user",
                                     "max_steps",         "step_underflow", "not_finite",       "event_accumulation",
                                     "singular_jacobian", "queue_overflow", "invalid_input",    "interrupted"};
    static_assert(std::size(names) == status_count, "a status has no name");
    return names[static_cast<int>(s)];
}

}  // namespace myriad
