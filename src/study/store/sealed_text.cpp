// SPDX-License-Identifier: MIT
// Finds the place of a text's checksum, and computes it.
#include "myriad/study/store/sealed_text.hpp"

#include <cstddef>
#include <cstdio>
#include <span>

#include "myriad/study/store/crc32c.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

namespace {

constexpr std::size_t seal_digits = 8;

// Where the digits are. Within strings quotes are escaped, so that no text of a user's looks like this entry; keys of a
// user's may, so it is the last one.
std::size_t place_of_digits(std::string_view text) {
    const std::string before = std::string("\"") + seal_key + "\": \"";
    const std::size_t entry = text.rfind(before);
    if (entry == std::string_view::npos) return entry;
    const std::size_t place = entry + before.size();
    return place + seal_digits < text.size() && text[place + seal_digits] == '"' ? place : std::string_view::npos;
}

std::string checksum_of(std::string_view text, std::size_t place) {
    const auto bytes = [](std::string_view part) { return std::as_bytes(std::span(part)); };
    std::uint32_t value = crc32c(bytes(text.substr(0, place)), 0);
    value = crc32c(bytes(unsealed), value);
    return hexadecimal(crc32c(bytes(text.substr(place + seal_digits)), value));
}

}  // namespace

std::string sealed(std::string text) {
    const std::size_t place = place_of_digits(text);
    if (place != std::string::npos) text.replace(place, seal_digits, checksum_of(text, place));
    return text;
}

seal seal_of(std::string_view text) {
    const std::size_t place = place_of_digits(text);
    if (place == std::string_view::npos) return {};
    return {std::string(text.substr(place, seal_digits)), checksum_of(text, place)};
}

std::string hexadecimal(std::uint32_t value) {
    char text[9];
    std::snprintf(text, sizeof text, "%08x", value);
    return text;
}

}  // namespace myriad::studies::inline MYRIAD_ABI
