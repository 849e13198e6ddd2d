// SPDX-License-Identifier: MIT
// Statuses by name and in numbers.
#pragma once

#include <array>
#include <cstdint>

#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/core/status.hpp"

namespace myriad {

/// The name of a status, as in the code.
const char* name_of(status s);

}  // namespace myriad

namespace myriad::host::inline MYRIAD_ABI {

/// How many of the instances with these statuses failed.
std::int64_t failed_in(const std::array<std::int64_t, status_count>& by_status);

}  // namespace myriad::host::inline MYRIAD_ABI
