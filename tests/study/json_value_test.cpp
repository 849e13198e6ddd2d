// SPDX-License-Identifier: MIT
// JSON as values: what is read, what is refused, and that what is written reads back.
#include "myriad/study/json_value.hpp"

#include <cstdint>
#include <limits>
#include <map>
#include <string>

#include "tests/catch.hpp"

namespace {

using Catch::Matchers::Contains;
using myriad::studies::json_error;
using myriad::studies::json_value;
using list = json_value::list;
using object = json_value::object;

std::string refusal(std::string_view text) {
    try {
        json_value::parse(text);
    } catch (const json_error& failure) {
        return failure.what();
    }
    return "it was read";
}

TEST_CASE("JSON of every kind is read, and written as it was") {
    const std::string text =
        R"({"null":null,"yes":true,"no":false,"integer":-7,"real":0.1,"text":"x","list":[1,[],{}],"object":{"a":1}})";
    const json_value value = json_value::parse(text);
    CHECK(value.text_of() == text);
    CHECK(value.at("null").is_null());
    CHECK(value.at("yes").boolean());
    CHECK_FALSE(value.at("no").boolean());
    CHECK(value.at("integer").integer() == -7);
    CHECK(value.at("real").number() == 0.1);
    CHECK(value.at("text").string() == "x");
    CHECK(value.at("list").at(0).integer() == 1);
    CHECK(value.at("object").members().at(0).key == "a");
    CHECK(value.find("nothing") == nullptr);
    CHECK(json_value::parse(" \t\r\n[ 1 , { \"a\" : 2 } ] ").text_of() == R"([1,{"a":2}])");
}

TEST_CASE("Indented JSON has every value in a line of its own") {
    const json_value value = object{{"a", list{1, object{{"b", "c"}}}}, {"empty", list{}}, {"none", object{}}};
    CHECK(value.text_of(2) == R"({
  "a": [
    1,
    {
      "b": "c"
    }
  ],
  "empty": [],
  "none": {}
})");
    CHECK(json_value::parse(value.text_of(1)) == value);
}

TEST_CASE("Numbers in JSON keep their value, and reals stay reals") {
    CHECK(json_value(1.0).text_of() == "1.0");
    CHECK(json_value(-0.0).text_of() == "-0.0");
    for (const double value : {0.1, 1e-9, 5e-324, 1.7976931348623157e308, 1.0 / 3, 1e22, 250000.0, -1.5}) {
        const json_value read = json_value::parse(json_value(value).text_of());
        CHECK_FALSE(read.is_integer());
        CHECK(read.number() == value);
    }
    constexpr auto least = std::numeric_limits<std::int64_t>::min();
    CHECK(json_value::parse("-9223372036854775808").integer() == least);
    CHECK(json_value(std::uint64_t{7}).integer() == 7);
    const json_value seed = json_value::parse("18446744073709551615");
    CHECK((seed.is_large() && seed.is_number() && !seed.is_integer()));
    CHECK(seed.text_of() == "18446744073709551615");
    CHECK(seed == json_value(std::numeric_limits<std::uint64_t>::max()));
    CHECK(json_value::parse("18446744073709551616").number() == 0x1p64);
    CHECK(json_value::parse("[-1.5e+3, 2E2, 3e-1]") == json_value(list{-1500, 200, 0.3}));
    CHECK(json_value(2) == json_value(2.0));
    CHECK_FALSE(json_value(2) == json_value("2"));
    CHECK_THROWS_AS(json_value(std::numeric_limits<double>::infinity()).text_of(), json_error);
}

TEST_CASE("Strings in JSON hold any text in UTF-8") {
    std::string all;
    for (char c = 1; c < 0x7F; ++c) all += c;
    all += '\0';
    all += "\xC3\xBC \xE2\x82\xAC \xF0\x9F\x98\x80";
    CHECK(json_value::parse(json_value(all).text_of()).string() == all);
    CHECK(json_value("\"\\\n\x01").text_of() == R"("\"\\\n\u0001")");
    CHECK(json_value::parse(R"("\u00fc\u20AC\ud83d\ude00\/\b")").string() == "\xC3\xBC\xE2\x82\xAC\xF0\x9F\x98\x80/\b");
    // Bytes that continue nothing, a cut character, a character in too many bytes, a surrogate, one beyond the last.
    for (const char* const wrong : {"\x80", "\xC3", "\xC0\xAF", "\xE0\x80\xAF", "\xED\xA0\x80", "\xF4\x90\x80\x80"}) {
        CHECK_THROWS_AS(json_value(wrong).text_of(), json_error);
        CHECK_THAT(refusal('"' + std::string(wrong) + '"'), Contains("UTF-8"));
    }
}

TEST_CASE("What is no JSON is refused, with the place and the reason") {
    const std::map<std::string, std::string> wrong{{"", "no JSON at byte 0: a value"},
                                                   {"[1, 2", "at byte 5: a comma or an end"},
                                                   {"[1 2]", "at byte 3: a comma or an end"},
                                                   {"[1,]", "at byte 3: a value"},
                                                   {"{\"a\" 1}", "at byte 5: a colon"},
                                                   {"{a: 1}", "at byte 1: a value or a string"},
                                                   {"{} {}", "at byte 3: it goes on"},
                                                   {"nul", "a value"},
                                                   {"NaN", "a value"},
                                                   {"01", "at byte 1: it goes on"},
                                                   {"-", "digit"},
                                                   {"1.", "digit"},
                                                   {".5", "digit"},
                                                   {"1e", "digit"},
                                                   {"1e999", "out of range"},
                                                   {"\"a", "has no end"},
                                                   {"\"a\nb\"", "control character"},
                                                   {R"("\x")", "unknown escape"},
                                                   {R"("\u12")", "four digits"},
                                                   {R"("\u-123")", "four digits"},
                                                   {R"("\ud83d")", "surrogate"},
                                                   {R"("\ude00")", "surrogate"},
                                                   {R"("\ud83d\u0041")", "surrogate"},
                                                   {std::string(100000, '['), "too many values inside each other"}};
    for (const auto& [text, reason] : wrong) {
        CAPTURE(text.substr(0, 20));
        CHECK_THAT(refusal(text), Contains(reason));
    }
}

TEST_CASE("A value of another kind than the one asked for is refused") {
    const json_value value = object{{"list", list{1}}, {"text", "x"}};
    CHECK_THROWS_WITH(value.at("text").integer(), "a string where an integer is needed");
    CHECK_THROWS_WITH(value.at("list").members(), "a list where an object is needed");
    CHECK_THROWS_WITH(value.at("list").at("x"), Contains("an object is needed"));
    CHECK_THROWS_WITH(value.at("list").at(1), Contains("only 1 values"));
    CHECK_THROWS_WITH(value.at("more"), Contains("\"more\" is missing"));
    CHECK_THROWS_AS(json_value()["key"], json_error);
}

TEST_CASE("Members of objects are added, replaced and sorted") {
    json_value value = object{};
    value["b"] = 1;
    value["a"] = list{object{{"d", 1}, {"c", 2}}};
    value["b"] = 3;
    CHECK(value.text_of() == R"({"b":3,"a":[{"d":1,"c":2}]})");
    CHECK(value.sorted().text_of() == R"({"a":[{"c":2,"d":1}],"b":3})");
    CHECK_FALSE(value == value.sorted());
}

}  // namespace
