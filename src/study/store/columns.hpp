// SPDX-License-Identifier: MIT
// The values that a chunk is handed over with, compared with the variables.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "myriad/study/store/store.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

// The bytes of a variable's column, which has so many items. Throws `error` if there is none, or it is another's.
std::span<const std::byte> bytes_for(const variable& wanted, std::span<const column> columns, std::int64_t items);
// The columns of a chunk in the order of the variables, empty for those without.
std::vector<std::span<const std::byte>> ordered_columns(const layout& content, std::int64_t chunk,
                                                        std::span<const column> columns);

}  // namespace myriad::studies::inline MYRIAD_ABI
