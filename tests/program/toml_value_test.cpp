// SPDX-License-Identifier: MIT
// TOML documents as plain data, with the places of everything in them.
#include "program/toml_value.hpp"

#include <cstdint>
#include <string>
#include <string_view>

#include "tests/catch.hpp"

using namespace myriad::programs;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

toml_value parse(std::string_view text) { return parse_toml(text, "a.toml"); }

const toml_value::entry& entry(const toml_value& table, std::size_t number) {
    return table.as<toml_value::table>()->at(number);
}

}  // namespace

TEST_CASE("values of all kinds are read, in the order of the file") {
    const toml_value all = parse(
        "z = 1\n"
        "a = 0.5\n"
        "m = 'text'\n"
        "b = true\n"
        "l = [1, [2.5, 'x']]\n"
        "d = 2026-11-23\n"
        "c = 10:30:00\n"
        "[s]\n"
        "k = 3\n");
    std::string keys, kinds;
    for (const toml_value::entry& e : *all.as<toml_value::table>()) {
        keys += e.key;
        kinds += std::string(e.value.kind()) + ", ";
    }
    CHECK(keys == "zambldcs");
    CHECK(kinds == "an integer, a number, a string, a boolean, an array, a date, a time of day, a table, ");
    CHECK(*entry(all, 0).value.as<std::int64_t>() == 1);
    CHECK(*entry(all, 1).value.as<double>() == 0.5);
    CHECK(*entry(all, 2).value.as<std::string>() == "text");
    CHECK(*entry(all, 3).value.as<bool>());
    const auto& list = *entry(all, 4).value.as<toml_value::array>();
    REQUIRE(list.size() == 2);
    CHECK(list[0].as<double>() == nullptr);
    CHECK(*list[1].as<toml_value::array>()->at(1).as<std::string>() == "x");
    CHECK(*entry(entry(all, 7).value, 0).value.as<std::int64_t>() == 3);
}

TEST_CASE("the place of a value is that of its key, or its own in an array") {
    const toml_value all = parse("\n  key = [1,\n   2]\n[section]\ninner.most = 1\n");
    const toml_value& list = entry(all, 0).value;
    CHECK(position(list.place) == "a.toml:2:3: ");
    CHECK(position(list.as<toml_value::array>()->at(1).place) == "a.toml:3:4: ");
    const toml_value& inner = entry(entry(all, 1).value, 0).value;
    CHECK(position(entry(inner, 0).value.place) == "a.toml:5:7: ");
}

TEST_CASE("a place without a line is the file, and without a file nothing") {
    CHECK(position({"a.toml", 0, 0}) == "a.toml: ");
    CHECK(position({}) == "");
}

TEST_CASE("keys that begin with # are errors, and do not end programs with assertions") {
    for (const char* const text :
         {"[#set]\na = 1\n", "[[#set]]\n", "[ #x]\n", "[a.#b]\n", "a.#b = 1\n", "[\n", "[a.\n"})
        CHECK_THROWS_AS(parse(text), input_error);
}

TEST_CASE("what is no TOML is refused with its place") {
    CHECK_THROWS_WITH(parse("a = 1\nb = \n"), StartsWith("a.toml:2:"));
    CHECK_THROWS_WITH(parse("[s"), StartsWith("a.toml:1:"));
    CHECK_THROWS_WITH(parse("a = 1\na = 2"), StartsWith("a.toml:2:") && Contains("a"));
    CHECK_THROWS_AS(parse("= 1"), input_error);
}

TEST_CASE("a key of a hundred thousand parts is refused, and does not end the program") {
    std::string key = "a";
    for (int i = 0; i < 100'000; ++i) key += " . a";
    CHECK_THROWS_WITH(parse("k = 1\n" + key + " = 1"), StartsWith("a.toml:2:1: a key has more than 64 parts"));
    CHECK_THROWS_WITH(parse('[' + key + ']'), Contains("a key has more than 64 parts"));
    std::string nested = "1";
    for (int i = 0; i < 1000; ++i) nested = "{a.a.a.a = " + nested + '}';
    CHECK_THROWS(parse("k = " + nested));
    const std::string dots(1000, '.');
    CHECK_NOTHROW(parse("k = '" + dots + "'  # " + dots + "\nl = \"\"\"\n" + dots + "\"\n\"\"\"\nm = [0.1, 0.2]"));
}
