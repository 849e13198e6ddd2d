// SPDX-License-Identifier: MIT
// What an error's message marks: its subject, and the words that other front ends say differently.
#include "myriad/host/core/error.hpp"

#include <string>

#include "tests/catch.hpp"

using myriad::mark_role;
using myriad::marked_message;
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

std::string stretch(const myriad::error& e, std::size_t number) {
    const myriad::mark& m = e.marks().at(number);
    return std::string(e.what()).substr(m.begin, m.size);
}

}  // namespace

TEST_CASE("an error has the text that it would have without marks, and says where they are") {
    const auto e = error_of(named_option("samples.capacity"), " is ", -3, ", but ", named_component("x"), " needs ",
                            0.5, ": ", phrase("give_step", "give options::step"), '.');
    CHECK(std::string(e.what()) == "samples.capacity is -3, but x needs 0.5: give options::step.");
    REQUIRE(e.marks().size() == 3);
    CHECK(e.marks()[0].what == mark_role::option);
    CHECK(e.marks()[0].key == "samples.capacity");
    CHECK(stretch(e, 0) == "samples.capacity");
    CHECK(e.marks()[1].what == mark_role::component);
    CHECK(stretch(e, 1) == "x");
    CHECK(e.marks()[2].what == mark_role::phrase);
    CHECK(e.marks()[2].key == "give_step");
    CHECK(stretch(e, 2) == "give options::step");
}

TEST_CASE("a message in a message keeps its marks, also after letters of several bytes") {
    const auto inner = marked_message("naïve ", named_option("events.tolerance", "event tolerance"), " here");
    const auto e = error_of("größer: ", inner, ", or ", phrase("other", "ähnlich"));
    REQUIRE(e.marks().size() == 2);
    CHECK(stretch(e, 0) == "event tolerance");
    CHECK(e.marks()[0].key == "events.tolerance");
    CHECK(stretch(e, 1) == "ähnlich");
    const myriad::error copy = e;
    CHECK(stretch(copy, 1) == "ähnlich");
}

TEST_CASE("an error of plain text has no marks") {
    CHECK(myriad::error("text").marks().empty());
    CHECK(error_of("a ", 1).marks().empty());
}
