// SPDX-License-Identifier: MIT
// Layouts as JSON and back. What readers of Zarr make of it is in check_exports.py.
#include "myriad/study/store/metadata.hpp"

#include <cmath>
#include <limits>

#include "tests/catch.hpp"
#include "tests/study/store/synthetic.hpp"

namespace {

using Catch::Matchers::Contains;
using namespace myriad::studies;

TEST_CASE("arrays are divided along their outermost dimension, and every file has the same length") {
    const layout content = tests::synthetic_layout();
    const array_shape step = shape_of(content, content.variables[3]);
    CHECK(step.items() == 35);
    CHECK(step.item_bytes() == 3 * 2 * 4);
    CHECK(step.file_bytes() == 4 * 24 + 4);
    CHECK(step.files() == 9);
    CHECK(step.file_name(7) == "c.7.0.0");
    const array_shape partial = shape_of(content, content.variables[6]);
    CHECK(partial.items() == 9);
    CHECK(partial.files() == 9);
    const array_shape total = shape_of(content, content.variables[7]);
    CHECK(total.files() == 1);
    CHECK(total.file_bytes() == 4 * 8 + 4);
    const array_shape number = shape_of(content, content.coordinates[3]);
    CHECK(number.dimensions.empty());
    CHECK(number.file_name(0) == "c");
    // A long axis has files of 8 MB.
    layout large = content;
    large.axes[0].length = std::int64_t{1} << 40;
    CHECK(shape_of(large, large.coordinates[0]).file_bytes() == (std::int64_t{8} << 20) + 4);
    CHECK(shape_of(large, large.coordinates[0]).files() == std::int64_t{1} << 20);
}

TEST_CASE("a layout comes back from the JSON of its group, whatever its attributes are") {
    layout content = tests::synthetic_layout();
    content.variables[0].attributes = {{"text", "with \"quotes\" and \xC3\xBC"},
                                       {"one", 1.0},
                                       {"tenth", 0.1},
                                       {"infinite", -std::numeric_limits<double>::infinity()},
                                       {"many", std::vector<double>{1.0, 2.5, std::numeric_limits<double>::infinity()}},
                                       {"integer", std::int64_t{1} << 62},
                                       {"integers", std::vector<std::int64_t>{-1, 0, 7}}};
    const layout read = group_of(group_json(content), "zarr.json").content;
    CHECK(read.axes == content.axes);
    CHECK(read.chunk == content.chunk);
    for (std::size_t v = 0; v < content.variables.size(); ++v)
        CHECK(read.variables[v].attributes == content.variables[v].attributes);
    for (std::size_t c = 0; c < content.coordinates.size(); ++c) {
        CHECK(read.coordinates[c].name == content.coordinates[c].name);
        CHECK(read.coordinates[c].dimension == content.coordinates[c].dimension);
        CHECK(read.coordinates[c].attributes == content.coordinates[c].attributes);
    }
    CHECK(differences(read, content).empty());
    CHECK_THROWS_WITH(group_of("{\"attributes\": {\"myriad\": {}}}", "f"), Contains("f is damaged"));
    CHECK_THROWS_WITH(group_of("{\"attributes\": {\"myriad\": {\"format\": 1, \"axes\": 5}}}", "f"),
                      Contains("damaged"));
}

TEST_CASE("a group's file of which any byte has changed is refused") {
    std::string text = group_json(tests::synthetic_layout());
    int taken = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char change = static_cast<char>(i % 7 == 0 ? 0x80 : 1 << (i % 3));
        text[i] = static_cast<char>(text[i] ^ change);
        try {
            group_of(text, "zarr.json");
            ++taken;
        } catch (const myriad::error&) {
        }
        text[i] = static_cast<char>(text[i] ^ change);
    }
    CHECK(taken == 0);
    CHECK(group_of(text, "zarr.json").checksum.size() == 8);
}

TEST_CASE("numbers in a description are equal if they are the same number") {
    layout a = tests::synthetic_layout(), b = a;
    a.description = R"({"x": 1, "y": [0.1, 2], "z": {"deep": {"deeper": null}}})";
    b.description = R"({"z": {"deep": {"deeper": null}}, "y": [1e-1, 2.0], "x": 1.0})";
    CHECK(differences(a, b).empty());
    b.description = R"({"z": {"deep": {"deeper": "0"}}, "y": [1e-1, 3], "x": 1.0000000000000002})";
    const std::vector<myriad::statement> found = differences(a, b);
    CHECK(std::vector<std::string>(found.begin(), found.end()) ==
          std::vector<std::string>{"x: 1 in the store, 1.0000000000000002 here",
                                   "y: [0.1,2] in the store, [0.1,3] here",
                                   "z.deep.deeper: nothing in the store, \"0\" here"});
    a.description = R"({"x": ")" + std::string(500, 'a') + "\"}";
    b.description = R"({"x": "b"})";
    CHECK(differences(a, b).at(0).text().size() < 150);
}

TEST_CASE("the contents name axes in place of instances, and have no partial results") {
    const std::string text = contents_json(tests::synthetic_layout());
    CHECK(same_json(text, text));
    std::string words;  // without white space
    for (const char c : text)
        if (c != ' ' && c != '\n') words += c;
    CHECK_THAT(words, Contains(R"("axes":["a","b"])"));
    CHECK_THAT(words, Contains(R"("y":{"dimensions":["a","b","phase"],"role":"data","attributes":{}})"));
    CHECK_THAT(words, Contains(R"("noise":{"dimensions":["a","b"],"role":"coordinate")"));
    CHECK_THAT(words,
               Contains(R"("a":{"dimensions":["a"],"role":"coordinate","attributes":{"long_name":"firstaxis"}})"));
    CHECK_THAT(words, Contains(R"("total":{"dimensions":["bin"])"));
    CHECK_THAT(words, Contains(R"("t_end":{"dimensions":[])"));
    CHECK_THAT(words, !Contains("partial"));
}

TEST_CASE("the entries of a description become attributes with dots in their names") {
    const auto attributes = attributes_of(
        R"({"model": "duffing", "options": {"tolerance": 1e-9, "steps": 5, "on": true, "none": null},
            "list": [1, 2], "reals": [1.5, 2], "mixed": [1, "a"], "empty": {}})");
    const std::vector<attribute> expected{{"model", "duffing"},
                                          {"options.tolerance", 1e-9},
                                          {"options.steps", std::int64_t{5}},
                                          {"options.on", "true"},
                                          {"list", std::vector<std::int64_t>{1, 2}},
                                          {"reals", std::vector<double>{1.5, 2}},
                                          {"mixed", "[1,\"a\"]"}};
    CHECK(attributes == expected);
}

TEST_CASE("a seed beyond the largest signed integer is no negative number among the attributes") {
    const std::vector<attribute> expected{{"seed", "18446744073709551615"}};
    CHECK(attributes_of(R"({"seed": 18446744073709551615})") == expected);
}

}  // namespace
