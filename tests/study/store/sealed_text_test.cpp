// SPDX-License-Identifier: MIT
// Texts that hold a checksum of themselves.
#include "myriad/study/store/sealed_text.hpp"

#include "tests/catch.hpp"

namespace {

using namespace myriad::studies;

TEST_CASE("a sealed text is right, and is no more when any of its bytes changes") {
    const std::string text = sealed("{\"a\": 1, \"checksum\": \"00000000\"}\n");
    CHECK(seal_of(text).is_right());
    for (std::size_t i = 0; i < text.size(); ++i) {
        std::string changed = text;
        changed[i] = static_cast<char>(changed[i] ^ 1);
        CHECK_FALSE(seal_of(changed).is_right());
        changed.erase(i, 1);
        CHECK_FALSE(seal_of(changed).is_right());
    }
}

TEST_CASE("a text without a checksum has none, and the last entry of that name counts") {
    CHECK(seal_of("").stored.empty());
    CHECK(seal_of("{\"checksum\": 5}").stored.empty());
    CHECK(seal_of("{\"checksum\": \"1234").stored.empty());
    // What a user calls so, and a text of a user's with an entry in it.
    const std::string text =
        sealed(R"({"checksum": "abcdefgh", "note": "\"checksum\": \"00000000\"", "checksum": "00000000"})");
    CHECK(seal_of(text).is_right());
    CHECK(text.starts_with(R"({"checksum": "abcdefgh")"));
}

}  // namespace
