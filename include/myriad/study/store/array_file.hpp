// SPDX-License-Identifier: MIT
// The files of arrays: little-endian numbers, and four bytes of checksum of all of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "myriad/kernel/core/abi.hpp"
#include "myriad/study/store/file_system.hpp"
#include "myriad/study/store/metadata.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

/// What reading a file showed: its checksum, and what is wrong with it, if anything.
struct file_check {
    std::uint32_t checksum = 0;
    std::string damage;

    /// With the checksum that a record has, too.
    file_check& compare(std::uint32_t recorded);
};

/// Reads a file of an array as a whole, since its checksum is about the whole, and copies the bytes from `begin` to
/// `end`.
file_check read_array_file(file_system& files, const std::string& path, const array_shape& shape,
                           std::int64_t begin = 0, std::int64_t end = 0, std::byte* to = nullptr);

/// Writes a file of an array, filled up to its full length, to a temporary place.
new_file write_array_file(file_system& files, const std::string& temporary, const array_shape& shape,
                          std::span<const std::byte> bytes, std::uint32_t& checksum);

}  // namespace myriad::studies::inline MYRIAD_ABI
