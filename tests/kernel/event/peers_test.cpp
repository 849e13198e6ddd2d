// SPDX-License-Identifier: MIT
// Problems that users of other packages have with events (peers.md, "Events"), each as a test named after it.
#include <atomic>
#include <cstdlib>
#include <new>
#include <string>

#include "tests/catch.hpp"
#include "tests/kernel/event/logged_motions.hpp"

namespace {
std::atomic<std::int64_t> allocations{0};
}

// Counted, so that a test can see whether handling events allocates memory.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"  // inlined, they look like malloc and delete
#endif
void* operator new(std::size_t size) {
    ++allocations;
    if (void* p = std::malloc(size == 0 ? 1 : size)) return p;
    throw std::bad_alloc();
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }

using namespace logged_motions;

TEMPLATE_TEST_CASE(
    "peers: crossings that start inside the tolerance zone are not lost, and nothing falls through the wall", "",
    ALL_METHODS) {
    std::vector<motion> starts;
    for (int i = 0; i < 64; ++i) starts.push_back({.x = 1e-3 * (i + 1), .v = 0, .a = -9.81});
    auto e = ensemble_of(starts, {position(0, logged_motion::bounce), never(), never()}, 0, 5, 0.6);
    solve<TestType>(e, options_for(1e-6, 0.01));
    for (Eigen::Index i = 0; i < e.size(); ++i) {
        CHECK(e.status(i) == myriad::status::event_accumulation);  // never success at the bottom of the well
        CHECK(e.accessory(logged_motion::smallest_x)[i] >= -1e-6);
    }
}

TEMPLATE_TEST_CASE("peers: two crossings in one step are both found", "", ALL_METHODS) {
    auto e = ensemble_of(motion{}, {function{.Q = 1, .c = 0.01}, never(), never()}, 0, 2.3);
    auto o = options_for(1e-12, 2.2);
    o.sub_samples = 16;
    solve<TestType>(e, o);
    CHECK(agree(times_of(e), {0.9, 1.1}, 1e-11));  // the slope is 0.2
}

TEMPLATE_TEST_CASE("peers: with several events the action of the one that fired is run", "", ALL_METHODS) {
    auto e = ensemble_of(motion{.v = 1},
                         {position(10, logged_motion::zero_x), position(0.5, logged_motion::jump_v), never()}, 0, 1);
    solve<TestType>(e, options_for(1e-12, 0.1));
    CHECK(e.state(logged_motion::v)[0] == 2);
    CHECK(std::abs(e.state(logged_motion::x)[0] - 1.5) <= 2e-12);
}

TEMPLATE_TEST_CASE("peers: when two events fire in one step the earlier one is first", "", ALL_METHODS) {
    auto e = ensemble_of(motion{.v = 1},
                         {position(0.6, logged_motion::zero_x), position(0.5, logged_motion::jump_v), never()}, 0, 0.7);
    solve<TestType>(e, options_for(1e-12, 1));
    // v doubles at t = 0.5, x = 0.6 follows at 0.55 and is set to 0; then 0.15 at speed 2
    CHECK(agree(times_of(e, 1), {0.5}, 1e-11));
    CHECK(agree(times_of(e, 0), {0.55}, 1e-11));
    CHECK(std::abs(e.state(logged_motion::x)[0] - 0.3) <= 1e-11);
}

TEMPLATE_TEST_CASE("peers: directions are not swapped", "", ALL_METHODS) {
    auto e = ensemble_of(motion{.x = -1, .v = 1}, {position(), position(), position()}, 0, 2);
    auto o = options_for(1e-12, 0.1);
    o.events[0].direction = myriad::direction::rising;
    o.events[1].direction = myriad::direction::falling;
    solve<TestType>(e, o);
    CHECK(times_of(e, 0).size() == 1);
    CHECK(times_of(e, 1).empty());
    CHECK(times_of(e, 2).size() == 1);
}

TEMPLATE_TEST_CASE("peers: an event quantity reset to zero does not fire again at once", "", ALL_METHODS) {
    auto e = ensemble_of(motion{.x = -0.5, .v = 1}, {position(0, logged_motion::zero_x), never(), never()}, 0, 10);
    solve<TestType>(e, options_for(1e-6, 0.1));
    CHECK(count_of(e) == 1);
    CHECK(e.status(0) == myriad::status::success);
}

TEMPLATE_TEST_CASE("peers: handling events takes no memory", "", ALL_METHODS) {
    const auto allocated_by = [](double t_end) {
        auto e =
            ensemble_of(motion{.x = 0.5, .v = 1}, {position(1, logged_motion::lower_x), never(), never()}, 0, t_end);
        auto o = options_for(1e-9, 0.07);
        o.advice = myriad::advice::off;  // which looks for stiffness after many steps
        solve<TestType>(e, o);           // counters exist from the first call on
        e.restart();
        const std::int64_t before = allocations;
        solve<TestType>(e, o);
        return allocations - before;
    };
    CHECK(allocated_by(5000) == allocated_by(1.2));  // 5000 events and one
}

TEMPLATE_TEST_CASE("peers: a phase stops after n detections", "", ALL_METHODS) {
    auto e = ensemble_of(motion{.x = 0.5, .v = 1}, {position(1, logged_motion::lower_x), never(), never()}, 0, 50);
    auto o = options_for(1e-9, 0.1);
    o.events[0].stop_after = 7;
    solve<TestType>(e, o);
    CHECK(count_of(e) == 7);
    CHECK(e.status(0) == myriad::status::stopped_by_event);
}

TEMPLATE_TEST_CASE("peers: integration continues after an event", "", ALL_METHODS) {
    auto e = ensemble_of(motion{.x = 0.5, .v = 1}, {position(1), never(), never()}, 0, 50);
    solve<TestType>(e, options_for(1e-9, 0.1));
    CHECK(count_of(e) == 1);
    CHECK(e.status(0) == myriad::status::success);
    CHECK(e.t()[0] == 50);
}

TEMPLATE_TEST_CASE("peers: a trigger at a given time needs one redone step", "", ALL_METHODS) {
    auto e = ensemble_of(sine, {time(1.2345, logged_motion::jump_v), time(2.5), never()}, 0, 3);
    solve<TestType>(e, options_for(1e-14, 0.01));
    CHECK(agree(times_of(e, 0), {1.2345}, 4e-16));  // to the rounding of t
    CHECK(agree(times_of(e, 1), {2.5}, 5e-16));
    CHECK(e.located_steps()[0] <= 2);
}

TEMPLATE_TEST_CASE("peers: event options are counted against the events and not the states", "", ALL_METHODS) {
    static_assert(logged_motion::n_state == 2 && logged_motion::n_event == 3);
    auto e = ensemble_of(sine, {never(), never(), position()}, 0, 7);
    auto o = options_for(1e-3, 1e-3);
    o.events[2].tolerance = 1e-10;
    o.events[2].direction = myriad::direction::falling;
    solve<TestType>(e, o);
    CHECK(agree(times_of(e, 2), {pi}, 1e-9));
    for (const std::size_t count : {std::size_t{1}, std::size_t{2}, std::size_t{4}}) {
        o.events.resize(count);
        std::string what;
        try {
            solve<TestType>(e, o);
        } catch (const myriad::error& problem) {
            what = problem.what();
        }
        CHECK(what.find("events has " + std::to_string(count)) != std::string::npos);
        CHECK(what.find("3 event functions") != std::string::npos);
    }
}
