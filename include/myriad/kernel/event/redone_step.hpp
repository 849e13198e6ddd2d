// SPDX-License-Identifier: MIT
// A step repeated with shorter lengths until it ends at an event: its next length, from the trials so far.
#pragma once

#include <cstdint>

#include "myriad/kernel/core/vec.hpp"
#include "myriad/kernel/scalar/mask_set.hpp"
#include "myriad/kernel/scalar/math.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// The largest part of an event function's change in the trial that found its crossing that a tolerance may be.
inline constexpr double largest_part = 1.0 / 64;

/// The location of one instance's event. Lengths are signed, like the step. Few steps need it, so it lies in memory,
/// not in a GPU thread's registers.
template <class R, extent events>
struct redone_step {
    /// Number of trials after which bisection replaces a guess that does not converge.
    static constexpr std::int32_t most_guesses = 10;
    /// Enough for a bracket of any two lengths: a factor of 1024 a trial until one ends before the event, then halves.
    static constexpr std::int32_t most_trials = 256;
    /// The target of a step that is redone to end where event functions turn.
    static constexpr std::int32_t none = -1;

    R length;          // of the next trial; 0: the event is at the start of the step
    R whole;           // of the trial that found the crossing
    R before, beyond;  // the bracket: longest length known to end before the event, shortest beyond it; or the start
    R resume;          // the step size to resume with afterwards
    std::int32_t tries;
    std::int32_t target;             // the event to which the step is redone
    bool narrow;                     // `before` and `beyond` are equal up to rounding
    mask_set<bool, events> crossed;  // the events that crossed in one of the trials, or nearly did
    mask_set<bool, events> changed;  // those of them whose function has another sign at the end of `beyond`
    vec<R, events> tolerance;        // of event functions in this step

    /// No location has been.
    MYRIAD_FUNCTION void clear() {
        before = beyond = R(0);
        tries = 0;
        narrow = false;
    }
    /// A trial of length h ended beyond an event.
    MYRIAD_FUNCTION void begin(R h, R guess, R h_next) {
        resume = h_next;
        whole = h;
        before = R(0);
        beyond = guess == R(0) ? R(0) : h;
        tries = 0;
        narrow = false;
        length = guess == R(0) || is_inside(guess, h) ? guess : R(0.5) * h;
    }
    /// A redone step of length h ended beyond the event.
    MYRIAD_FUNCTION void shorten(R h, R guess) {
        ++tries;
        beyond = h;
        // A function much steeper beyond the event than at it: 1024 times nearer to the start, until that is too near.
        const R middle = before == R(0) ? R(1.0 / 1024) * h : R(0.5) * (before + h);
        length = tries < most_guesses && is_inside(guess, h) ? guess : middle;
        narrow = are_one(before, h);
        if (narrow || tries >= most_trials) length = before;
    }
    /// The step of length h is to be redone with this length, to end where an event function turns.
    MYRIAD_FUNCTION void begin_turn(R turn, R h_next) {
        clear();
        resume = h_next;
        length = turn;
        target = none;
        crossed.clear(), changed.clear();
    }
    /// A bound on the distance in time of a jump from where it was located, but for the rounding of t.
    MYRIAD_FUNCTION R error() const {
        const bool bisected = narrow || tries >= most_guesses;
        return (bisected ? abs(beyond - before) : R(0)) + epsilon_of<R> * abs(beyond);
    }
    /// Whether signs alone decide where event j is, with this rounding error: guesses have not converged, as with a
    /// flat function, whose small values do not show that its event is near, and no tolerance was given.
    MYRIAD_FUNCTION bool goes_by_signs(int j, R rounding) const {
        return tries >= most_guesses && tolerance[j] <= rounding;
    }
    /// Whether guesses still choose the next length after a trial of length h.
    MYRIAD_FUNCTION bool trusts_guesses(R h) const { return tries < most_guesses && !is_between(h); }
    /// Whether the event, up to rounding, is where a redone step of length h ended before it.
    MYRIAD_FUNCTION bool is_between(R h) const { return are_one(h, beyond); }
    /// A redone step of length h ended before the event.
    MYRIAD_FUNCTION void lengthen(R h, R guess) {
        before = h;
        length = tries < most_guesses && is_inside(guess, beyond) ? guess : R(0.5) * (h + beyond);
        ++tries;
    }
    /// A redone step of length h ended within the tolerance of the event: whether a better guess deserves another
    /// trial.
    MYRIAD_FUNCTION bool improve(R h, R guess, bool before_event) {
        if (tries >= most_guesses || !is_inside(guess, beyond) || are_one(guess, h)) return false;
        ++tries;
        (before_event ? before : beyond) = h;
        length = guess;
        return true;
    }

private:
    /// Whether a guess lies inside the bracket between `before` and `end`.
    MYRIAD_FUNCTION bool is_inside(R guess, R end) const {
        return abs(guess) > abs(before) && abs(guess) < abs(end) && guess * end > R(0);
    }
    /// Whether two lengths agree up to rounding. The rounding of t is stored beside t and does not count here.
    static MYRIAD_FUNCTION bool are_one(R a, R b) { return abs(b - a) <= R(2) * epsilon_of<R> * abs(b); }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
