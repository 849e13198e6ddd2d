// SPDX-License-Identifier: MIT
// The step that is taken anew, shorter, until it ends at an event: its next length, from the trials so far.
#pragma once

#include <cstdint>

#include "myriad/kernel/core/vec.hpp"
#include "myriad/kernel/scalar/mask_set.hpp"
#include "myriad/kernel/scalar/math.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// The location of an event of one instance. Lengths are signed, like the step itself. It is needed in few steps, so it
/// lies in memory and not in the registers of a GPU thread.
template <class R, int events>
struct redone_step {
    /// Trials after which a guess that leads nowhere is left for bisection.
    static constexpr std::int32_t most_guesses = 10;
    /// A step halved that often is as long as the rounding of its ends.
    static constexpr std::int32_t most_trials = 80;

    R length;          // of the next trial; 0: the event is where the step begins
    R before, beyond;  // the longest known to end before the event, the shortest beyond it
    R resume;          // the step size to go on with afterwards
    std::int32_t tries;
    std::int32_t target;             // the event that the step is redone to
    bool narrow;                     // `before` and `beyond` are the same time up to rounding
    mask_set<bool, events> crossed;  // events that crossed in the trial in which the target was found

    /// The trial of a step of length h ended beyond an event.
    MYRIAD_FUNCTION void begin(R h, R guess, R h_next) {
        resume = h_next;
        before = R(0);
        beyond = h;
        tries = 0;
        narrow = false;
        length = guess == R(0) || is_inside(guess, h) ? guess : R(0.5) * h;
    }
    /// A redone step of length h ended beyond the event.
    MYRIAD_FUNCTION void shorten(R h, R guess) {
        ++tries;
        beyond = h;
        length = tries < most_guesses && is_inside(guess, h) ? guess : R(0.5) * (before + h);
        narrow = are_one(before, h);
        if (narrow || tries >= most_trials) length = before;
    }
    /// Whether the event is, up to rounding, where a redone step of length h ended before it.
    MYRIAD_FUNCTION bool is_between(R h) const { return are_one(h, beyond); }
    /// A redone step of length h ended before the event.
    MYRIAD_FUNCTION void lengthen(R h, R guess) {
        before = h;
        length = tries < most_guesses && is_inside(guess, beyond) ? guess : R(0.5) * (h + beyond);
        ++tries;
    }
    /// A redone step of length h ended within the tolerance of the event: whether a better guess is worth another
    /// trial.
    MYRIAD_FUNCTION bool improve(R h, R guess, bool before_event) {
        if (tries >= most_guesses || !is_inside(guess, beyond) || are_one(guess, h)) return false;
        ++tries;
        (before_event ? before : beyond) = h;
        length = guess;
        return true;
    }

private:
    /// Whether a guess is longer than what is known to end before the event and shorter than `end`.
    MYRIAD_FUNCTION bool is_inside(R guess, R end) const {
        return abs(guess) > abs(before) && abs(guess) < abs(end) && guess * end > R(0);
    }
    /// Lengths that differ by their rounding. The rounding of t is kept beside t, so it does not count here.
    static MYRIAD_FUNCTION bool are_one(R a, R b) { return abs(b - a) <= R(2) * epsilon_of<R> * abs(b); }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
