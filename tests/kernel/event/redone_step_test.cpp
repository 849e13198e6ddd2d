// SPDX-License-Identifier: MIT
// The lengths given to a redone step, for events at known times.
#include "myriad/kernel/event/redone_step.hpp"

#include <cmath>

#include "tests/catch.hpp"

namespace {

using step = myriad::detail::redone_step<double, 2>;

/// Redoes a step of length 1 until the event at `time` is bracketed by lengths equal up to rounding; the guesses are
/// useless.
int trials_to(double time, double guess) {
    step s;
    s.begin(1, guess, 0.25);
    int trials = 1;
    while (trials < 200 && !s.narrow) {
        if (s.length > time) {
            s.shorten(s.length, guess);
        } else {
            if (s.is_between(s.length)) break;
            s.lengthen(s.length, guess);
        }
        ++trials;
    }
    CHECK(s.length <= time);
    CHECK(std::abs(s.length - time) <= 1e-15);
    CHECK(s.resume == 0.25);
    return trials;
}

TEST_CASE("a step is redone to an event of which nothing is known but the side in at most eighty trials") {
    for (const double time : {1e-3, 0.3, 0.5, 0.999})
        for (const double guess : {0.2, 0.7, -1.0, std::nan("")}) CHECK(trials_to(time, guess) <= step::most_trials);
}

TEST_CASE("a step whose event is at its start has the length zero") {
    step s;
    s.begin(1, 0, 1);
    CHECK(s.length == 0);
}

TEST_CASE("a better guess is taken only inside the bracket, and where it is another time") {
    step s;
    s.begin(1, 0.5, 1);
    CHECK(s.improve(0.5, 0.6, true));
    CHECK(s.length == 0.6);
    CHECK(s.before == 0.5);
    CHECK_FALSE(s.improve(0.6, 0.4, false));
    CHECK_FALSE(s.improve(0.6, 1.5, true));
    CHECK_FALSE(s.improve(0.6, 0.6, true));
    CHECK_FALSE(s.improve(0.6, std::nan(""), true));
}

}  // namespace
