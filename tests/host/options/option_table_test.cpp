// SPDX-License-Identifier: MIT
// The table of options is complete, and what it says of ranges, choices and defaults is what calls check.
#include "myriad/host/options/option_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "myriad/host/options/option_checks.hpp"
#include "tests/catch.hpp"

namespace {

using namespace myriad;
using host::option_effect;
using host::option_row;

constexpr host::model_components two_states{.state = {2, ""}};
constexpr host::option_limits limits{two_states, 1, false, true, true, false, 53, [](double value) { return value; }};

std::string refusal_of(const options& o) {
    try {
        limits.check(o);
    } catch (const error& e) {
        return e.what();
    }
    return "";
}
/// Options with records and samples, so that theirs are checked.
options valid() {
    options o;
    o.events.resize(1);
    o.record.states = {0};
    o.samples = {.states = {0}, .capacity = 10, .evenly = 2};
    return o;
}

/// Calls `function(entry, group of o, what messages call it)` for all entries of all structs.
template <class Function>
void for_all(options& o, Function&& function) {
    const auto each = [&](auto& group, const std::string& before) {
        host::for_each_option<std::decay_t<decltype(group)>>(
            [&](const auto& e) { function(e, group.*e.member, before + e.name); });
    };
    each(o, "");
    each(o.events[0], "event ");
    each(o.record, "record.");
    each(o.samples, "samples.");
}

TEST_CASE("every number out of the range in the table of options is refused by its name", "[options]") {
    options o = valid();
    REQUIRE(refusal_of(o) == "");
    int numbers = 0;
    for_all(o, [&](const auto& e, auto& value, const std::string& name) {
        using T = std::decay_t<decltype(value)>;
        if constexpr (std::is_same_v<T, double> || std::is_same_v<T, std::int64_t>) {
            ++numbers;
            std::vector<T> wrong;
            if (!e.range.contains(e.range.least - 1)) wrong.push_back(static_cast<T>(e.range.least - 1));
            if (e.range.without_least) wrong.push_back(static_cast<T>(e.range.least));
            if (std::isfinite(e.range.most)) wrong.push_back(static_cast<T>(e.range.most + 1));
            if constexpr (std::is_same_v<T, double>) {
                if (e.range.without_most) wrong.push_back(e.range.most);
                if (!std::isnan(value)) wrong.push_back(std::numeric_limits<double>::quiet_NaN());
            }
            CHECK(wrong.size() >= 1);
            const T right = value;
            for (const T bad : wrong) {
                CAPTURE(name, bad);
                value = bad;
                CHECK(refusal_of(o).starts_with(name + " is "));
            }
            value = right;
        }
    });
    CHECK(numbers >= 20);
    CHECK(refusal_of(o) == "");
}

TEST_CASE("every choice that the table of options does not have is refused by its name", "[options]") {
    options o = valid();
    int choices = 0;
    for_all(o, [&](const auto&, auto& value, const std::string& name) {
        using T = std::decay_t<decltype(value)>;
        if constexpr (std::is_enum_v<T>) {
            ++choices;
            const T right = value;
            value = static_cast<T>(99);
            CAPTURE(name);
            CHECK(refusal_of(o).starts_with(name + " is 99, which is none: choose "));
            for (const auto& c : host::choices(T{})) {
                value = c.value;
                CHECK(refusal_of(o) == "");
                CHECK(host::name_of_choice(value) == std::string_view(c.name));
            }
            value = right;
        }
    });
    CHECK(choices == 8);
}

TEST_CASE("defaults are in the ranges of the table of options, but for what must be given", "[options]") {
    options o{.events = {event_options{}}};
    for_all(o, [&](const auto& e, auto& value, const std::string& name) {
        using T = std::decay_t<decltype(value)>;
        CAPTURE(name);
        if constexpr (std::is_same_v<T, double> || std::is_same_v<T, std::int64_t>) {
            const auto number = static_cast<double>(value);
            const bool must_be_given = std::isnan(number) || name == "samples.capacity";
            CHECK(e.range.contains(number) == !must_be_given);
        }
    });
}

TEST_CASE("the rows of the table of options are what readers need: each once, with its default and a meaning",
          "[options]") {
    const std::vector<option_row> rows = host::option_rows();
    std::set<std::string> names;
    for (const option_row& r : rows) {
        CAPTURE(r.name);
        CHECK(names.insert(r.name).second);
        CHECK(!r.meaning.empty());
        CHECK(r.meaning.back() != '.');
        CHECK((r.type == "choice") == !r.choices.empty());
        if (r.type == "choice") CHECK(std::count(r.choices.begin(), r.choices.end(), r.initial) == 1);
    }
    const auto row = [&](const std::string& name) {
        return *std::find_if(rows.begin(), rows.end(), [&](const option_row& r) { return r.name == name; });
    };
    CHECK(row("max_steps").initial == "0");
    CHECK(row("max_steps").range == "0 or [1, 2000000000]");
    CHECK(row("max_steps").type == "whole number");
    CHECK(row("step").initial == "");
    CHECK(row("step").range == "(0, inf)");
    CHECK(row("step").unit == "time");
    CHECK(row("maximum_step").range == "(0, inf]");
    CHECK(row("shrink_limit").range == "(0, 1)");
    CHECK(row("block_size").range == "0 or [32, 1024]");
    CHECK(row("chunk_size").range == "[0, inf)");
    CHECK(row("relative_tolerance").initial == "1e-08");
    CHECK(row("phase_time").choices == std::vector<std::string>{"restart", "carry_on"});
    CHECK(row("events.direction").initial == "either");
    CHECK(row("record.states").type == "components");
    CHECK(row("time_limit").effect == option_effect::call);
}

}  // namespace
