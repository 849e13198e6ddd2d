// SPDX-License-Identifier: MIT
// Actions that wait: in order of their times, by priorities, by chance, and as many as there is room for.
#include "myriad/kernel/model/action_queue.hpp"

#include <cmath>
#include <cstdint>
#include <vector>

#include <myriad/myriad.hpp>

#include "tests/catch.hpp"
#include "tests/kernel/model/queued.hpp"
#include "tests/support/compare.hpp"
#include "tests/support/device.hpp"

namespace {

using myriad::ensemble;
using myriad::options;
using myriad::solve;
using myriad::status;

struct setting {
    int seed = -1, by_number = 0, cancelled = 0;
    std::int64_t size = 1, phases = 1;
};

/// Actions put at t = 1 for these times, run until t = 5.
template <class Method>
ensemble<queued> run(const std::vector<double>& times, const setting& s = {}) {
    ensemble<queued> e(s.size);
    e.state(0) = 0.0;
    for (int k = 0; k < queued::n_parameter; ++k)
        e.parameter(k) = static_cast<std::size_t>(k) < times.size() ? times[static_cast<std::size_t>(k)] : 0.0;
    e.shared_integer(queued::count) = static_cast<std::int32_t>(times.size());
    e.shared_integer(queued::seed) = s.seed;
    e.shared_integer(queued::by_number) = s.by_number;
    e.shared_integer(queued::cancelled) = s.cancelled;
    e.time_domain(0, 5);
    options o = compare::with_tolerance(1e-9, 0.3);
    o.phases = s.phases;
    if (s.phases > 1) o.phase_length = 5.0 / static_cast<double>(s.phases);
    solve<Method>(tests::test_device(), e, o);
    return e;
}
std::int32_t code_of(const ensemble<queued>& e, std::int64_t i = 0) { return e.integer_accessory(queued::code)[i]; }

template <class Test>
void each(Test test) {
    test.template operator()<myriad::runge_kutta_4>();
    test.template operator()<myriad::tsitouras_5>();
}

}  // namespace

TEST_CASE("actions that wait run at their times, with what was put and what is there") {
    each([]<class Method>() {
        const auto e = run<Method>({4.1, 2.2, 3.3});
        CHECK(e.status(0) == status::success);
        CHECK(code_of(e) == 231);
        CHECK(e.accessory(queued::last_time)[0] == 4.1);
        CHECK(std::abs(e.accessory(queued::sum)[0] - (3 * 1.0 + 10 * (2.2 + 3.3 + 4.1))) < 1e-11);
    });
}
TEST_CASE("an action whose time is the present or has passed runs at once, and one beyond the end does not run") {
    each([]<class Method>() {
        const auto e = run<Method>({1, 0.5, 7});
        CHECK(code_of(e) == 12);
        CHECK(e.accessory(queued::last_time)[0] == 1.0);
    });
}
TEST_CASE("an action whose time is infinite never runs") {
    each([]<class Method>() { CHECK(code_of(run<Method>({2, 1000, 3})) == 13); });
}
TEST_CASE("the queue goes on from phase to phase") {
    each([]<class Method>() { CHECK(code_of(run<Method>({4.1, 2.2, 3.3}, {.phases = 7})) == 231); });
}
TEST_CASE("actions at one time run by priority, and in the order of put if they tie") {
    each([]<class Method>() {
        CHECK(code_of(run<Method>({2, 2, 2})) == 123);
        CHECK(code_of(run<Method>({2, 2, 2}, {.by_number = 1})) == 321);
        CHECK(code_of(run<Method>({3, 2, 2}, {.by_number = 1})) == 321);
    });
}
TEST_CASE("rounding of their times does not decide which of two actions comes first") {
    each([]<class Method>() {
        constexpr double less = 2 - 2e-15, more = 2 + 2e-15;  // a few roundings
        CHECK(code_of(run<Method>({more, 2, less}, {.by_number = 1})) == 321);
        CHECK(code_of(run<Method>({less, more, 2}, {.by_number = 1})) == 321);
    });
}
TEST_CASE("times that differ by more than their own rounding are not one, also where time is a large number") {
    each([]<class Method>() {
        CHECK(code_of(run<Method>({2 - 1e-13, 2 + 1e-13, 2}, {.by_number = 1})) == 132);
        CHECK(code_of(run<Method>({2 - 1e-6, 2 + 1e-6, 2}, {.by_number = 1})) == 132);
    });
}
TEST_CASE("with a seed, actions that tie run in an order of the instance's own, the same in every run") {
    each([]<class Method>() {
        constexpr std::int64_t size = 600;
        const auto e = run<Method>({2, 2, 2}, {.seed = 7, .size = size});
        const auto again = run<Method>({2, 2, 2}, {.seed = 7, .size = size});
        const auto other = run<Method>({2, 2, 2}, {.seed = 8, .size = size});
        bool differs = false;
        for (const int order : {123, 132, 213, 231, 312, 321}) {
            CAPTURE(order);
            int found = 0;
            for (std::int64_t i = 0; i < size; ++i) found += code_of(e, i) == order;
            CHECK(std::abs(found - 100) < 46);  // five standard deviations, sqrt(600 1/6 5/6) = 9.1
        }
        for (std::int64_t i = 0; i < size; ++i) {
            CHECK(code_of(e, i) == code_of(again, i));
            differs = differs || code_of(e, i) != code_of(other, i);
        }
        CHECK(differs);
        // priorities come first
        const auto ranked = run<Method>({2, 2, 2}, {.seed = 7, .by_number = 1, .size = size});
        for (std::int64_t i = 0; i < size; ++i) CHECK(code_of(ranked, i) == 321);
    });
}
TEST_CASE("an action that is cancelled does not run") {
    each([]<class Method>() { CHECK(code_of(run<Method>({2, 3, 4}, {.cancelled = 2})) == 13); });
}
TEST_CASE("an instance whose queue is full ends as queue_overflow") {
    each([]<class Method>() {
        const auto e = run<Method>({2, 3, 4, 4.5});
        CHECK(e.status(0) == status::queue_overflow);
        CHECK(e.t()[0] == 1.0);
        CHECK(code_of(e) == 0);
    });
}
