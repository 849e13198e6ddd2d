// SPDX-License-Identifier: MIT
// Intervals of phases of a given length: from their ends, from inside, backwards, and the last one.
#include "myriad/kernel/state/phase_interval.hpp"

#include "tests/catch.hpp"
#include "tests/support/problems.hpp"

namespace {

using arguments = myriad::detail::kernel_arguments<problems::decay, double>;

arguments with_length(double length) {
    arguments a{};
    a.phase_length = length;
    a.phases_per_time = 1 / length;
    return a;
}
struct interval {
    double begin, end;
    bool operator==(const interval&) const = default;
};
interval from(double length, double t, double t_begin, double t_end) {
    const auto found = myriad::detail::interval_from(with_length(length), t, t_begin, t_end);
    return {found.begin, found.end};
}

TEST_CASE("a phase begins where the last one ended") {
    CHECK(from(0.5, 1, 1, 9) == interval{1, 1.5});
    CHECK(from(0.5, 2.5, 1, 9) == interval{2.5, 3});
}

TEST_CASE("a phase that ended early leaves the rest of its interval to the next") {
    CHECK(from(0.5, 2.6, 1, 9) == interval{2.5, 3});
    CHECK(from(0.5, 2.9, 1, 9) == interval{2.5, 3});
}

TEST_CASE("a time that only rounding keeps from an end counts as on it") {
    const double length = 0.1, t_begin = 0;
    double t = t_begin;
    for (int k = 0; k < 10; ++k) t += length;  // 0.9999999999999999
    CHECK(t != 1);
    CHECK(from(length, t, t_begin, 9).end == 11 * length);
}

TEST_CASE("ends are computed from the first begin, so that no rounding adds up") {
    CHECK(from(0.1, 1e6 * 0.1, 0, 1e9).end == 1000001 * 0.1);
}

TEST_CASE("phases run backwards where the end is before the begin") {
    CHECK(from(0.5, 1, 1, -9) == interval{1, 0.5});
    CHECK(from(0.5, 0.3, 1, -9) == interval{0.5, 0});
}

TEST_CASE("the last phase ends at the end of the time domain, however short it is") {
    CHECK(from(0.5, 2, 1, 2.2) == interval{2, 2.2});
    CHECK(from(0.5, 2, 1, 2.5) == interval{2, 2.5});
}

}  // namespace
