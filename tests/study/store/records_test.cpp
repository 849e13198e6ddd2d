// SPDX-License-Identifier: MIT
// Records as JSON and back, and those that are not what they should be.
#include "myriad/study/store/records.hpp"

#include <cmath>

#include "myriad/study/store/sealed_text.hpp"
#include "tests/catch.hpp"
#include "tests/study/store/synthetic.hpp"
#include "tests/support/message_of.hpp"

namespace {

using Catch::Matchers::Contains;
using namespace myriad::studies;

TEST_CASE("the record of a chunk comes back, and that of another chunk or study does not") {
    const layout content = tests::synthetic_layout();
    const arithmetic by{"avx2", "g++ 12", "Myriad", "a host"};
    const stored_chunk stored{{"a \"device\"", std::nan(""), {{"ok", 3}, {"failed", 1}}, by},
                              {1, 2, 3, 4, 5, 0xFFFFFFFF, 7}};
    const std::string text = record_json(content, "12345678", 3, stored);
    const stored_chunk read = record_of(text, content, "12345678", 3);
    CHECK(read.record.device == stored.record.device);
    CHECK(std::isnan(read.record.seconds));
    CHECK(read.record.statuses == stored.record.statuses);
    CHECK(read.record.computed_by.same_as(by));
    CHECK(read.record.computed_by.host == "a host");
    CHECK(read.checksums == stored.checksums);
    CHECK_THROWS_WITH(record_of(text, content, "12345678", 4), Contains("that of another chunk"));
    CHECK_THROWS_WITH(record_of(text, content, "87654321", 3), Contains("that of another study"));
    CHECK_THROWS_WITH(record_of("", content, "12345678", 4), Contains("the record of chunk 4 is damaged"));
    CHECK_THROWS_WITH(record_of(text.substr(0, text.size() / 2), content, "12345678", 3), Contains("is damaged"));
    CHECK_THROWS_WITH(record_of(sealed(R"({"checksum": "00000000"})"), content, "12345678", 3),
                      Contains("damaged: an entry is missing, or of another kind"));
}

TEST_CASE("a record of which any byte has changed is refused") {
    const layout content = tests::synthetic_layout();
    const stored_chunk stored{{"device", 0.5, {{"ok", 4}}, {}}, {1, 2, 3, 4, 5, 6, 7}};
    std::string text = record_json(content, "12345678", 3, stored);
    for (char& byte : text) {
        for (const int change : {1, 2, 16, 0x20, 0x80}) {
            byte = static_cast<char>(byte ^ change);
            CHECK_THROWS_AS(record_of(text, content, "12345678", 3), myriad::error);
            byte = static_cast<char>(byte ^ change);
        }
    }
    CHECK_NOTHROW(record_of(text, content, "12345678", 3));
}

TEST_CASE("the message about a damaged record does not repeat bytes that are no characters") {
    const std::string damaged = "{\"kind\": \"chunk\xe3\x1b[2J";
    CHECK(tests::message_of([&] { record_of(damaged, tests::synthetic_layout(), "12345678", 3); }) ==
          "the record of chunk 3 is damaged: it is no JSON");
}

TEST_CASE("records of coordinates, final results and the arithmetic are not taken for each other") {
    const std::string coordinates = coordinates_json("12345678", {{"a", {1, 2}}, {"b", {3}}});
    CHECK(coordinates_of(coordinates, "12345678") == coordinate_checksums{{"a", {1, 2}}, {"b", {3}}});
    const std::string result = result_json("12345678", "total", 17);
    CHECK(result_of(result, "12345678", "total") == 17);
    CHECK_THROWS_WITH(result_of(result, "12345678", "other"), Contains("that of another variable"));
    const std::string by = arithmetic_json("12345678", {"avx2", "g++ 12", "Myriad", "a host"});
    CHECK(arithmetic_of(by, "12345678").text() == "avx2, g++ 12, Myriad");
    CHECK_THROWS_WITH(coordinates_of(result, "12345678"), Contains("the record of the coordinates is damaged"));
    CHECK_THROWS_WITH(result_of(by, "12345678", "total"), Contains("the record of total is damaged"));
    CHECK_THROWS_WITH(arithmetic_of(coordinates, "12345678"), Contains("the record of the arithmetic is damaged"));
    CHECK_THROWS_WITH(coordinates_of(coordinates, "87654321"), Contains("that of another study"));
}

TEST_CASE("records without a checksum of themselves, or of numbers that are none, are refused") {
    const layout content = tests::synthetic_layout();
    std::string text =
        R"({"kind": "chunk", "group": "12345678", "chunk": 3, "instances": 4, "device": "CPU", "seconds": 0.5,
            "statuses": {"ok": 4}, "crc32c": {"x": "00000001", "y": "00000002", "count": "00000003",
            "step": "00000004", "status": "00000005", "noise": "00000006", "partial": "00000007"},
            "checksum": "00000000"})";
    CHECK(record_of(sealed(text), content, "12345678", 3).checksums.size() == 7);
    std::string without = text;
    without.erase(without.rfind(",\n"), without.size() - 1 - without.rfind(",\n"));
    CHECK_THROWS_WITH(record_of(without, content, "12345678", 3), Contains("its own checksum is missing"));
    text.replace(text.find("00000006"), 8, "zzzzzzzz");
    CHECK_THROWS_WITH(record_of(sealed(text), content, "12345678", 3), Contains("a checksum is no number"));
}

}  // namespace
