// SPDX-License-Identifier: MIT
// The checksum of stored data: CRC-32C (Castagnoli), as Zarr's codec "crc32c" has it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "myriad/kernel/core/abi.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

/// The checksum of the bytes after those whose checksum is `before`: of a whole in parts.
std::uint32_t crc32c(std::span<const std::byte> bytes, std::uint32_t before = 0);

/// The same by tables, which is what CPUs without the instruction use.
std::uint32_t crc32c_by_tables(std::span<const std::byte> bytes, std::uint32_t before = 0);

}  // namespace myriad::studies::inline MYRIAD_ABI
