// SPDX-License-Identifier: MIT
// Tables whose keys are asked for, values of the wanted types, and what wrong ones get.
#include "program/section.hpp"

#include <cstdint>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "myriad/host/core/error.hpp"
#include "tests/catch.hpp"

using namespace myriad::programs;
using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;

namespace {

/// A document of one key, "v", and its value.
struct single {
    toml_value document;
    explicit single(const std::string& value) : document(parse_toml("v = " + value, "a.toml")) {}
    const toml_value& value() const { return document.as<toml_value::table>()->at(0).value; }
    double number() const { return number_in(value(), "v"); }
    std::int64_t integer() const { return integer_in(value(), "v"); }
};

}  // namespace

TEST_CASE("what the library says is said in the words of study files") {
    using namespace myriad::host;
    const single v("1");
    CHECK_THROWS_WITH(placed(v.value(), "v",
                             [] {
                                 myriad::require(false, named_option("step"), " is not set", cure, cures::give_step,
                                                 ", or ", cures::use_doubles);
                             }),
                      "a.toml:1:1: v: step is not set: give step under [options], or write real = \"double\"");
    const auto said = myriad::statement_of("the tolerance of ",
                                           message_part(myriad::part_kind::event, "event 1", {}, 1), " is too small");
    CHECK(in_words_of_files(said, {"top", "bottom"}) == "the tolerance of event \"bottom\" is too small");
    CHECK(in_words_of_files(said) == "the tolerance of event 1 is too small");
}

TEST_CASE("no message about a study advises in C++") {
    using namespace myriad::host;
    for (int c = 0; c < static_cast<int>(std::size(all_cures)); ++c) {
        const auto known = static_cast<cures>(c);
        // Studies mark such instances, have no other records and samples than they keep, and scale no tolerances.
        if (known == cures::mark_invalid || known == cures::name_in_record || known == cures::name_in_samples ||
            known == cures::scale_tolerances)
            continue;
        const std::string words = in_words_of_files(myriad::statement_of(known));
        INFO(words);
        CHECK(words.find("::") == std::string::npos);
        CHECK(words.find("ensemble") == std::string::npos);
    }
}

TEST_CASE("numbers are numbers, integers, or multiples of pi") {
    constexpr double pi = std::numbers::pi;
    CHECK(single("1.5").number() == 1.5);
    CHECK(single("-3").number() == -3.0);
    CHECK(single("'pi'").number() == pi);
    CHECK(single("'2 pi'").number() == 2 * pi);
    CHECK(single("'-3*pi/4'").number() == -3 * pi / 4);
    CHECK(single("'pi / 2'").number() == pi / 2);
    CHECK(single("'0.5e1 pi'").number() == 5 * pi);
    CHECK(single("'1 / pi'").number() == 1 / pi);
    for (const char* const wrong : {"'2'", "'2 pie'", "'pi 2 3'", "'pi/'", "'*pi'", "''", "'2 * / pi'", "'- pi -'",
                                    "'2 pi pi'", "'1 / 2 pi'", "'1/0 pi'", "'-pi/0'", "'1e308*1e308 pi'"})
        CHECK_THROWS_WITH(single(wrong).number(), Contains("a.toml:1:1: v: must be a number, and is the string "));
    CHECK_THROWS_WITH(single("true").number(), "a.toml:1:1: v: must be a number, and is a boolean");
}

TEST_CASE("whole numbers may be written as floating-point ones, if they are whole and exact") {
    CHECK(single("1e6").integer() == 1'000'000);
    CHECK(single("9007199254740993").integer() == 9'007'199'254'740'993);
    CHECK_THROWS_WITH(single("8.5").integer(), "a.toml:1:1: v: must be a whole number, and is 8.5");
    CHECK_THROWS_WITH(single("1e300").integer(), Contains("must be a whole number"));
    CHECK_THROWS_WITH(single("nan").integer(), Contains("must be a whole number"));
    CHECK_THROWS_WITH(single("'5'").integer(), EndsWith("and is a string"));
}

TEST_CASE("strings, truths and arrays are not taken for each other") {
    CHECK(text_in(single("'x'").value(), "v") == "x");
    CHECK(truth_in(single("false").value(), "v") == false);
    CHECK(numbers_in(single("[1, 'pi', 0.5]").value(), "v") == std::vector<double>{1, std::numbers::pi, 0.5});
    CHECK(numbers_in(single("[]").value(), "v").empty());
    CHECK(texts_in(single("'x'").value(), "v") == std::vector<std::string>{"x"});
    CHECK(texts_in(single("['x', 'y']").value(), "v") == std::vector<std::string>{"x", "y"});
    CHECK_THROWS_WITH(text_in(single("1").value(), "v"), EndsWith("must be a string, and is an integer"));
    CHECK_THROWS_WITH(truth_in(single("1").value(), "v"), EndsWith("must be true or false, and is an integer"));
    CHECK_THROWS_WITH(numbers_in(single("1").value(), "v"), EndsWith("must be an array of numbers, and is an integer"));
    CHECK_THROWS_WITH(texts_in(single("['x', 1]").value(), "v"), "a.toml:1:11: v: must be a string, and is an integer");
}

TEST_CASE("a name that is like another is taken for a slip, otherwise all are listed") {
    const std::vector<std::string> names = {"phases", "relative_tolerance", "k"};
    CHECK(suggestion("relativ_tolerance", names) == ": did you mean \"relative_tolerance\"?");
    CHECK(suggestion("phaess", names) == ": did you mean \"phases\"?");  // neighbours swapped
    CHECK(suggestion("K", names) == ": did you mean \"k\"?");
    CHECK(suggestion("frobnicate", names) == ": there are phases, relative_tolerance, k");
    CHECK(suggestion("x", {}) == "");
}

TEST_CASE("a table gives what is asked for and refuses the rest") {
    const toml_value document = parse_toml("[o]\nphases = 8\ntitle = 'text'\nkind = 'both'\nphase = 2\n", "a.toml");
    section root(document, "");
    const toml_value* const table = root.find("o");
    REQUIRE(table != nullptr);
    CHECK_NOTHROW(root.finish());
    section o(*table, root.full("o"));
    std::int64_t phases = 1, untouched = 7;
    std::string title;
    double number = 0;
    o.read("phases", phases);
    o.read("samples", untouched);
    o.read("title", title);
    CHECK(phases == 8);
    CHECK(untouched == 7);
    CHECK(title == "text");
    CHECK_THROWS_WITH(o.read("title", number), Contains("a.toml:3:1: o.title: must be a number"));
    int kind = 0;
    CHECK_THROWS_WITH(o.read("kind", kind, {{"rising", 1}, {"bothe", 2}}),
                      "a.toml:4:1: o.kind: \"both\" is none of its values: did you mean \"bothe\"?");
    o.read("kind", kind, {{"rising", 1}, {"both", 2}});
    CHECK(kind == 2);
    CHECK_THROWS_WITH(o.finish(), "a.toml:5:1: o.phase: there is no such key: did you mean \"phases\"?");
    CHECK_THROWS_WITH(section(*o.find("phases"), "o.phases"),
                      "a.toml:2:1: o.phases: must be a table, and is an integer");
}

TEST_CASE("errors of a function get the place and the key once") {
    const single one("1");
    CHECK_THROWS_WITH(placed(one.value(), "v", [] { throw myriad::error("too small"); }), "a.toml:1:1: v: too small");
    CHECK_THROWS_WITH(placed(one.value(), "v", [&] { throw wrong(one.value(), "w", "inner"); }),
                      "a.toml:1:1: w: inner");
}
