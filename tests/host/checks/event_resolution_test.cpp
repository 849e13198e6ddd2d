// SPDX-License-Identifier: MIT
// Event tolerances that a function never leaves: the report's notes, and cases without one.
#include "myriad/host/checks/event_resolution.hpp"

#include <string>
#include <vector>

#include "tests/catch.hpp"
#include "tests/kernel/event/watching.hpp"

using namespace watching;
using myriad::cash_karp;

namespace {

/// Remarks on event tolerances.
std::vector<std::string> remarks(const std::vector<std::string>& notes) {
    std::vector<std::string> found;
    for (const std::string& note : notes)
        if (note.find("within its tolerance") != std::string::npos) found.push_back(note);
    return found;
}

std::vector<std::string> remarks_on(myriad::ensemble<watch> e, double tolerance) {
    return remarks(solve<cash_karp>(e, options_for(tolerance, 0.1)).notes);
}

const std::vector<motion> some(20, sine);
constexpr function far{.c = -1000};

}  // namespace

TEST_CASE("an event tolerance larger than its function's values, of which no crossing is seen, is remarked") {
    const auto found = remarks_on(ensemble_of(some, {position(), far, far}, 0, 20), 10);
    REQUIRE(found.size() == 1);  // the other functions are far beyond their tolerances
    INFO(found[0]);
    CHECK(found[0].find(
              "the function of event 0 is within its tolerance, 10, at the start and at the end in all 20 instances") !=
          std::string::npos);
    CHECK(found[0].find("give a smaller tolerance") != std::string::npos);
}

TEST_CASE("event tolerances are not remarked where crossings are located, or the function is ever found beyond") {
    const double tolerance = 1e-6;
    // on the surface at the start and at the end, off it in between
    CHECK(remarks_on(ensemble_of(some, {position(), far, far}, 0, 2 * pi), tolerance).empty());
    // on the surface at the start, away from it at the end
    CHECK(remarks_on(ensemble_of(some, {position(), far, far}, 0, 1), tolerance).empty());
    // on the surface only at the end, like a decay
    CHECK(
        remarks_on(ensemble_of(std::vector<motion>(20, cosine), {position(), far, far}, 0, pi / 2), tolerance).empty());
    // in one instance of many it was beyond the tolerance
    std::vector<motion> most(20, motion{});
    most[7] = cosine;
    CHECK(remarks_on(ensemble_of(most, {position(), far, far}, 0, 1), tolerance).empty());
    // no steps were requested or counted
    CHECK(remarks_on(ensemble_of(some, {position(), far, far}, 1, 1), 10).empty());
    auto uncounted = ensemble_of(some, {position(), far, far}, 0, 20);
    auto o = options_for(10, 0.1);
    o.counting = myriad::counting::off;
    CHECK(remarks(solve<cash_karp>(uncounted, o).notes).empty());
}

TEST_CASE("event tolerances are not remarked where crossings fire at the ends of phases, which needs no step redone") {
    auto e = ensemble_of(some, {position(), far, far}, 0, 30 * pi);
    auto o = options_for(1e-6, 0.1);
    o.phases = 30;
    o.phase_length = pi;
    const auto report = solve<cash_karp>(e, o);
    REQUIRE(report.located_steps == 0);
    CHECK(count_of(e) == 30);
    CHECK(remarks(report.notes).empty());
    // Nor where the phase ends by the event.
    auto stopped = ensemble_of(some, {position(), far, far}, 0, pi);
    o.phases = 1;
    o.events[0].stop_after = 1;
    const auto once = solve<cash_karp>(stopped, o);
    REQUIRE(once.located_steps == 0);
    CHECK(once.count(myriad::status::stopped_by_event) == 20);
    CHECK(remarks(once.notes).empty());
}

TEST_CASE("a solver remarks an event tolerance larger than its function's values, too") {
    myriad::solver<watch, cash_karp> sweep(tests::test_device(1), 20, options_for(10, 0.1));
    auto& e = sweep.instances();
    auto from = ensemble_of(some, {position(), far, far}, 0, 20);
    for (int c = 0; c < watch::n_state; ++c) e.state(c) = from.state(c);
    for (int c = 0; c < watch::n_parameter; ++c) e.parameter(c) = from.parameter(c);
    for (int c = 0; c < watch::n_shared; ++c) e.shared(c) = from.shared(c);
    for (int c = 0; c < watch::n_accessory; ++c) e.accessory(c) = 0;
    e.time_domain(0, 20);
    sweep.upload();
    sweep.integrate();
    sweep.download();
    CHECK(remarks(sweep.report().notes).size() == 1);
}
