// SPDX-License-Identifier: MIT
// Statuses by name and in numbers.
#include "myriad/host/report/status_names.hpp"

#include <iterator>
#include <numeric>

namespace myriad {

const char* name_of(status s) {
    constexpr const char* names[] = {"not_started",       "success",        "stopped_by_event", "stopped_by_user",
                                     "max_steps",         "step_underflow", "not_finite",       "event_accumulation",
                                     "singular_jacobian", "invalid_input",  "queue_overflow",   "history_overflow",
                                     "invalid_delay",     "interrupted"};
    static_assert(std::size(names) == status_count, "a status has no name");
    return names[static_cast<int>(s)];
}

}  // namespace myriad

namespace myriad::host::inline MYRIAD_ABI {

std::int64_t failed_in(const std::array<std::int64_t, status_count>& by_status) {
    return std::accumulate(by_status.begin() + static_cast<int>(status::max_steps), by_status.end(), std::int64_t{0});
}

}  // namespace myriad::host::inline MYRIAD_ABI
