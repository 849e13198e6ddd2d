// SPDX-License-Identifier: MIT
// The parts of errors and notes: what they are about, the problem and the cure, for front ends with words of their own.
#include "myriad/host/core/error.hpp"

#include <string>

#include "myriad/host/model/numbering.hpp"
#include "tests/catch.hpp"

using myriad::part_kind;
using myriad::statement;
using myriad::statement_of;
using myriad::statement_part;
using namespace myriad::host;

namespace {

template <class... Parts>
myriad::error error_of(const Parts&... parts) {
    try {
        myriad::require(false, parts...);
    } catch (const myriad::error& e) {
        return e;
    }
    throw 0;
}

/// A front end that says everything in its own words.
std::string by_keys(const statement& s) {
    return s.text([](const statement_part& p) {
        if (p.kind == part_kind::text || p.kind == part_kind::separator) return p.words;
        return '<' + p.key + (p.number < 0 ? ">" : "#" + std::to_string(p.number) + '>');
    });
}

}  // namespace

TEST_CASE("an error has a subject, a problem and a cure, and what() joins them in C++'s words") {
    const auto e = error_of(named_option("samples.capacity"), " is ", -3, ", but ", named_component("state.x"),
                            " needs ", 0.5, cure, "raise it, or ", cures::give_step, '.');
    CHECK(std::string(e.what()) == "samples.capacity is -3, but state.x needs 0.5: raise it, or give options::step.");
    REQUIRE(e.said().subject() != nullptr);
    CHECK(*e.said().subject() == statement_part{part_kind::option, "samples.capacity", "samples.capacity"});
    REQUIRE(e.said().problem().size() == 4);
    CHECK(e.said().problem()[1].words == " is -3, but ");
    CHECK(e.said().problem()[2] == statement_part{part_kind::component, "state.x", "state.x"});
    REQUIRE(e.said().cure().size() == 3);
    CHECK(e.said().cure()[0].words == "raise it, or ");
    CHECK(e.said().cure()[1] == statement_part{part_kind::cure, "give options::step", "give_step"});
}

TEST_CASE("a front end finds all names and cures by their keys, also where C++ calls them otherwise") {
    const auto e =
        error_of("the ", named_option("events.tolerance", "tolerance"), " of ",
                 message_part(part_kind::event, "event 2", {}, 2), " is too small", cure,
                 message_part(cures::fewer_instances, "give a capacity of 30", 10), " or ", cures::use_doubles);
    CHECK(std::string(e.what()) ==
          "the tolerance of event 2 is too small: give a capacity of 30 or use an ensemble of doubles");
    CHECK(by_keys(e.said()) == "the <events.tolerance> of <#2> is too small: <fewer_instances#10> or <use_doubles>");
}

TEST_CASE("components are parts of messages without further ado") {
    const auto e = error_of(component_label{"state", 1, "v"}, " is NaN");
    CHECK(std::string(e.what()) == "state 1 (v) is NaN");
    CHECK(*e.said().subject() == statement_part{part_kind::component, "state 1 (v)", "state", 1});
}

TEST_CASE("a message in a message keeps its parts, its cure and what a copy has") {
    const auto inner = statement_of("naïve ", named_option("step", "étape"), " here", cure, cures::give_step);
    const auto e = error_of("größer: ", inner);
    CHECK(std::string(e.what()) == "größer: naïve étape here: give options::step");
    const myriad::error copy = e;
    CHECK(by_keys(copy.said()) == "größer: naïve <step> here: <give_step>");
    CHECK(copy.said().cure().size() == 1);
}

TEST_CASE("an error of plain text is its problem alone") {
    for (const auto& e : {myriad::error("a 1"), error_of("a ", 1)}) {
        CHECK(e.said() == statement("a 1"));
        CHECK(e.said().subject() == nullptr);
        CHECK(e.said().problem().size() == 1);
        CHECK(e.said().cure().empty());
    }
}
