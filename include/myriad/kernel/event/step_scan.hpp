// SPDX-License-Identifier: MIT
// Looks for crossings inside a step, on the cubic through its ends: at points of it, and where event functions turn
// back to their side. Only with options::sub_samples.
#pragma once

#include "myriad/kernel/controller/stepping.hpp"
#include "myriad/kernel/event/lane_sides.hpp"
#include "myriad/kernel/event/step_ends.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

template <class Model, class Method, class S>
struct step_scan {
    using R = real_of<S>;
    static constexpr auto m = n_event<Model>;
    using reals = vec<R, m>;         // of the event functions in one lane
    using moving = vec<dual<R>, m>;  // with their slopes per step
    using flags = mask_set<bool, m>;
    using ends_of_step = step_ends<Model, R>;
    using redone = redone_step<R, m>;

    lane_sides<Model, Method, S> sides;

    /// Checks `sub_samples` points of the step, and those between them where an event function turns back to its side,
    /// for the first crossing, updates the sides up to it, and sets `part` to the part of the step that contains it.
    /// Sets `part.turn` to the first place inside the step, if it has one, where a function turns: the step is to end
    /// there instead, as the cubic is less accurate than the step. Returns the functions that cross.
    MYRIAD_FUNCTION flags run(int i, const ends_of_step& step, reals& side, step_part<R>& part) const {
        auto* at = &sides.scratch().scanned;
        at->theta = R(0);
        at->points = 0;
        find_values(&step, R(0), &at->before);
        flags crossed;
        crossed.clear();
        MYRIAD_ROLLED
        while (at->points < sides.args.sub_samples) {
            MYRIAD_OPTIMISATION_BARRIER(at);  // else its values would take registers
            ++at->points;
            const bool last = at->points == sides.args.sub_samples;
            at->theta = last ? R(1) : static_cast<R>(at->points) / static_cast<R>(sides.args.sub_samples);
            find_values(&step, at->theta, &at->after);
            MYRIAD_UNROLL
            for (int j = 0; j < MYRIAD_LENGTH(m); ++j)
                if (at->theta == R(1)) at->after[j].value = step.g1[j];
            at->turns = 0;
            MYRIAD_ROLLED
            while (true) {
                MYRIAD_OPTIMISATION_BARRIER(at);
                at->place = at->theta;
                if (at->turns++ < MYRIAD_LENGTH(m)) find_turn(step, side, part.low, at);
                const R place = at->place;
                const bool turns_there = place > part.low && place < at->theta;
                if (turns_there) {
                    const bool shortens = is_adaptive<Method> && place > R(least_turn) && place < R(1) - R(least_turn);
                    if (shortens && !(sides.is_locating(i) && sides.memory_of(i).redo.target != redone::none)) {
                        part.turn = place;
                        return crossed;
                    }
                    find_values(&step, place, &at->before);
                } else {
                    at->place = at->theta;
                    at->before = at->after;
                }
                crossed = look(i, step, side, at->place, &at->before);
                if (crossed.any_of()) {
                    part.high = at->place;
                    return crossed;
                }
                if (at->place < R(1)) part.low = at->place;
                if (!(at->place < at->theta)) break;
            }
        }
        return crossed;
    }

private:
    /// A turn closer to an end of the step is looked at on the cubic, which is accurate there.
    static constexpr double least_turn = 1.0 / 4096;
    static constexpr double far_turn = 8;

    // A call with its results in memory: inlined, it would take registers of the whole loop.
    static MYRIAD_RARE_FUNCTION void find_values(const ends_of_step* step, R theta, moving* values) {
        *values = step->moving_values_at(theta);
    }

    /// Sets `place` to the first place between `from` and itself at which a function that moves towards zero at the
    /// first and away from it at the second turns, if there is one: by bisection, since such a function may be flat.
    /// One that stays so much farther from zero there than it moves from there to both ends of the step is left out:
    /// only a true turn some seventeen times as deep as that of the cubic would cross.
    MYRIAD_FUNCTION void find_turn(const ends_of_step& step, const reals& side, R from, scanned_part<R, m>* at) const {
        MYRIAD_ROLLED
        for (at->function = 0; at->function < MYRIAD_LENGTH(m); ++at->function) {
            MYRIAD_OPTIMISATION_BARRIER(at);
            const int j = at->function;
            const dual<R> before = at->before[j], after = at->after[j];
            const R falls = -side[j] * before.derivative, rises = side[j] * after.derivative;
            const R least = epsilon_of<R> * max(abs(before.value), abs(after.value));  // less changes no value
            if (!(falls > least && rises > least && side[j] * before.value > R(0))) continue;
            at->low = from, at->high = at->theta;
            MYRIAD_ROLLED
            while (at->high - at->low > R(4) * epsilon_of<R> * max(at->high, R(epsilon_of<R>))) {
                MYRIAD_OPTIMISATION_BARRIER(at);
                find_values(&step, R(0.5) * (at->low + at->high), &at->inside);
                const int k = at->function;
                (side[k] * at->inside[k].derivative < R(0) ? at->low : at->high) = R(0.5) * (at->low + at->high);
            }
            find_values(&step, at->high, &at->inside);
            const int k = at->function;
            const R value = at->inside[k].value, moves = abs(step.g[k] - value) + abs(step.g1[k] - value);
            if (side[k] * value > R(far_turn) * moves) continue;
            at->place = min(at->place, at->high);
        }
    }
    /// Compares the values g of the event functions at a point of the step with their sides. Returns the functions that
    /// have crossed; if there are none, the sides become those at this point.
    MYRIAD_FUNCTION flags look(int i, const ends_of_step& step, reals& side, R theta, const moving* g) const {
        const auto& own = sides.memory_of(i);
        const R length = theta * step.h;
        auto& place = sides.scratch().place;
        place.rounding = own.near.roundings;
        if (theta < R(1))
            detail::event_roundings<Model>(fma(theta, step.h, step.t), step.state_at(theta), step.p, &place);
        flags crossed;
        crossed.clear();
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) {
            const R past = max(own.near.allowance(j), place.rounding[j]);
            crossed.set(j, sides.crosses(j, side[j], (*g)[j].value, past) && !sides.is_at_jump(j, i, length));
        }
        if (crossed.any_of()) return crossed;
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) {
            const R value = (*g)[j].value, past = max(own.near.allowance(j), place.rounding[j]);
            if (!(abs(value) > past) || sides.is_at_jump(j, i, length)) continue;
            side[j] = sign_of(value);
            if (!sides.is_timeless(i, length) && !own.on_jump[j]) sides.e.left.set(j, i, true);
        }
        return crossed;
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
