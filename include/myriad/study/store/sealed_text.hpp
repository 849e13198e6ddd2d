// SPDX-License-Identifier: MIT
// JSON texts that hold a checksum of themselves, so that no change of a store's metadata goes unseen.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "myriad/kernel/core/abi.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

/// The key of a sealed text's checksum, the last one of its name, and what it is before the text is sealed.
inline constexpr const char* seal_key = "checksum";
inline constexpr const char* unsealed = "00000000";

/// The text with its checksum: CRC-32C of all of it, with zeros in the place of the checksum. It has the entry
/// "checksum": "00000000".
std::string sealed(std::string text);

/// What a text says of itself.
struct seal {
    std::string stored;    ///< the checksum in it; empty if there is none
    std::string computed;  ///< what it should be
    bool is_right() const { return !stored.empty() && stored == computed; }
};
seal seal_of(std::string_view text);

/// A checksum as text: "1f2e3d4c".
std::string hexadecimal(std::uint32_t value);

}  // namespace myriad::studies::inline MYRIAD_ABI
