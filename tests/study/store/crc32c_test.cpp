// SPDX-License-Identifier: MIT
// The checksum against published values, and by both ways.
#include "myriad/study/store/crc32c.hpp"

#include <string_view>
#include <vector>

#include "tests/catch.hpp"

namespace {

using myriad::studies::crc32c;
using myriad::studies::crc32c_by_tables;

std::span<const std::byte> bytes(std::string_view text) { return std::as_bytes(std::span(text)); }

TEST_CASE("checksums are those of RFC 3720, appendix B.4") {
    const auto check = [](auto checksum) {
        const std::vector<std::byte> zeros(32), ones(32, std::byte{255});
        std::vector<std::byte> up(32), down(32);
        for (std::size_t i = 0; i < 32; ++i) up[i] = std::byte(i), down[i] = std::byte(31 - i);
        CHECK(checksum(zeros, 0) == 0x8A9136AAu);
        CHECK(checksum(ones, 0) == 0x62A8AB43u);
        CHECK(checksum(up, 0) == 0x46DD794Eu);
        CHECK(checksum(down, 0) == 0x113FDB5Cu);
        CHECK(checksum(bytes("123456789"), 0) == 0xE3069283u);
        CHECK(checksum(bytes(""), 0) == 0u);
    };
    check([](std::span<const std::byte> b, std::uint32_t before) { return crc32c(b, before); });
    check([](std::span<const std::byte> b, std::uint32_t before) { return crc32c_by_tables(b, before); });
}

TEST_CASE("the checksum of parts is that of the whole, by the instruction and by tables, at any offset") {
    std::vector<std::byte> data(1000);
    for (std::size_t i = 0; i < data.size(); ++i) data[i] = std::byte((i * 37 + i / 7) & 255);
    const std::uint32_t whole = crc32c(data);
    for (std::size_t cut = 0; cut <= 40; ++cut) {
        const std::span<const std::byte> first = std::span(data).first(cut), rest = std::span(data).subspan(cut);
        CHECK(crc32c(rest, crc32c(first)) == whole);
        CHECK(crc32c_by_tables(rest, crc32c_by_tables(first)) == whole);
    }
}

}  // namespace
