// SPDX-License-Identifier: MIT
// The past of an instance whose model has delays: the steps taken, in a ring, each as the polynomial of the method's
// own interpolant, and what of it the right-hand side reads. Where the solution jumps, itself or in a derivative, a
// step of length zero lies between the others. A value is looked for between two jumps, never across one: steps end
// where a jump arrives, and the one before it sees the polynomial before the jump.
#pragma once

#include <cstdint>
#include <limits>

#include "myriad/kernel/core/vec.hpp"
#include "myriad/kernel/model/concepts.hpp"
#include "myriad/kernel/model/past_layout.hpp"
#include "myriad/kernel/scalar/math.hpp"
#include "myriad/kernel/scalar/select.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// Why a lookup of a trial step is not to be believed.
struct past_trouble {
    static constexpr std::uint8_t none = 0;
    static constexpr std::uint8_t not_yet = 1;  // a time that the steps have not reached
    static constexpr std::uint8_t lost = 2;     // one that the ring no longer has
    static constexpr std::uint8_t invalid = 4;  // the lag is negative or not a number
};

/// The step that a delayed value saw last, so that the next lookup in it reads little or nothing of the ring.
template <class R>
struct seen_step {
    std::int32_t number;         // -1: what was before the beginning
    R start, end, per_length;    // its times; none lies between them before the beginning, and once it is forgotten
    R linear, quadratic, cubic;  // and the value at the start: of the cubic polynomial
    R value;

    MYRIAD_FUNCTION void forget() {
        start = infinity_of<R>;
        end = -infinity_of<R>;
    }
    MYRIAD_FUNCTION bool has(R time) const { return (time >= start) & (time < end); }
};

/// The past of one lane. Steps are numbered from the beginning; step k is in slot k modulo their number.
template <class Model, class R>
struct lane_past {
    static constexpr int lags = n_delayed<Model>;
    static constexpr std::int32_t none = std::numeric_limits<std::int32_t>::max();

    std::int64_t instance;
    std::int32_t steps;         // stored so far
    bool begins;                // the next begins anew: what it begins with is not the end of the one before
    bool resumes;               // it may: a phase has begun, or a hook has changed something
    bool has_trial;             // the one after them holds the trial that is iterated
    std::int32_t from[lags];    // of each delayed value: the first step it may see now; -1: what was before
    std::int32_t before[lags];  // and the first that it must not see yet, a jump; or none
    mutable seen_step<R> seen[lags];
    mutable std::uint8_t trouble;

    /// What may be seen has changed.
    MYRIAD_FUNCTION void forget() const {
        MYRIAD_UNROLL
        for (int j = 0; j < lags; ++j) seen[j].forget();
    }
};

/// The past of all lanes.
template <class Model, class S>
struct past_view {
    using R = real_of<S>;
    static constexpr int lanes = lanes_of<S>;

    // Field f of slot s of instance i is at ring[(s * fields + f) * stride + i]; behind the slots are the initial
    // states and the time by which the past was moved.
    R* ring;
    std::int64_t stride;
    std::int32_t slots, terms;  // slots: a power of two
    S reached;                  // the end of the last step
    std::int64_t row;           // numbers from one slot to the next
    lane_past<Model, R> lane[lanes];

    MYRIAD_FUNCTION R* step_of(int i, std::int32_t k) const {
        return ring + (k & (slots - 1)) * row + lane[i].instance;
    }
    MYRIAD_FUNCTION R* initial_of(int i) const { return ring + slots * row + lane[i].instance; }
    /// How far the past was moved, by phases whose time begins again.
    MYRIAD_FUNCTION R& moved_of(int i) const { return initial_of(i)[n_kept<Model> * stride]; }
    /// The time at which step k begins; that of the step after the last is written, too.
    MYRIAD_FUNCTION R& start_of(int i, std::int32_t k) const { return *step_of(i, k); }
    /// The numbers of a state in a step.
    MYRIAD_FUNCTION R* terms_of(R* step, int place) const {
        return step + (1 + static_cast<std::int64_t>(place) * terms) * stride;
    }
    /// The first step that is still there while the next one is written.
    MYRIAD_FUNCTION std::int32_t oldest(int i) const { return lane[i].steps + 2 - slots; }

    /// The length of the last step.
    MYRIAD_FUNCTION R last_length(int i) const {
        return lane[i].steps > 0 ? start_of(i, lane[i].steps) - start_of(i, lane[i].steps - 1) : R(0);
    }

    /// Looks at the step that delayed value j sees at that time: the last that begins there or before.
    template <int j>
    MYRIAD_FUNCTION const seen_step<R>& look(int i, R time) const {
        const lane_past<Model, R>& past = lane[i];
        seen_step<R>& seen = past.seen[j];
        if (seen.has(time)) return seen;
        const std::int32_t known = past.steps + (past.has_trial ? 1 : 0);
        const std::int32_t last = (past.before[j] < known ? past.before[j] : known) - 1;
        const std::int32_t first = past.from[j] > oldest(i) ? past.from[j] : oldest(i);
        std::int32_t k = seen.number;
        if (k > last) k = last;
        if (k < first) k = first;
        MYRIAD_ROLLED
        while (k < last && start_of(i, k + 1) <= time) ++k;
        MYRIAD_ROLLED
        while (k > first && start_of(i, k) > time) --k;
        seen.number = k;
        seen.forget();
        if (k < 0) return seen;
        R *const step = step_of(i, k), *const next = step_of(i, k + 1);
        if (MYRIAD_UNLIKELY(k > past.from[j] && k == first && step[0] > time)) past.trouble |= past_trouble::lost;
        const R length = next[0] - step[0];
        seen.start = step[0];
        seen.end = next[0];
        // In one without length, at a jump, all times are its end.
        seen.per_length = length != R(0) ? R(1) / length : R(0);
        if (terms == 2) {
            const R* const here = terms_of(step, place_of_kept<Model, j>);
            const R* const there = terms_of(next, place_of_kept<Model, j>);
            const R difference = there[0] - here[0], begin = length * here[stride], end = length * there[stride];
            seen.value = length != R(0) ? here[0] : there[0];
            seen.linear = begin;
            seen.quadratic = R(3) * difference - begin - begin - end;
            seen.cubic = begin + end - difference - difference;
        }
        return seen;
    }
    /// The polynomial of a step for the state of delayed value j at that time.
    template <int j>
    MYRIAD_FUNCTION R value_in(int i, const seen_step<R>& seen, R time) const {
        const R theta = (time - seen.start) * seen.per_length;
        if (terms == 2) return fma(theta, fma(theta, fma(theta, seen.cubic, seen.quadratic), seen.linear), seen.value);
        const R* const here = terms_of(step_of(i, seen.number), place_of_kept<Model, j>);
        R value = here[(terms - 1) * stride];
        MYRIAD_ROLLED
        for (int power = terms - 2; power >= 0; --power) value = fma(theta, value, here[power * stride]);
        return value;
    }
    /// And its derivative.
    template <int j>
    MYRIAD_FUNCTION R slope_in(int i, const seen_step<R>& seen, R time) const {
        const R theta = (time - seen.start) * seen.per_length;
        if (terms == 2)
            return fma(theta, fma(R(3) * theta, seen.cubic, seen.quadratic + seen.quadratic), seen.linear) *
                   seen.per_length;
        const R* const here = terms_of(step_of(i, seen.number), place_of_kept<Model, j>);
        R slope = static_cast<R>(terms - 1) * here[(terms - 1) * stride];
        MYRIAD_ROLLED
        for (int power = terms - 2; power > 0; --power)
            slope = fma(theta, slope, static_cast<R>(power) * here[power * stride]);
        return slope * seen.per_length;
    }
    /// The same before the beginning, without a history function.
    template <int j>
    MYRIAD_FUNCTION R initial_value(int i) const {
        return initial_of(i)[place_of_kept<Model, j> * stride];
    }
};

/// The past of instance `index` in lane i.
template <class Model, class S, class Arguments>
MYRIAD_FUNCTION void look_back(past_view<Model, S>& past, const Arguments& args, int i, std::int64_t index) {
    past.ring = args.history.ring;
    past.stride = args.size;
    past.slots = args.history.slots;
    past.terms = args.history.terms;
    past.row = history_fields(n_kept<Model>, args.history.terms) * args.size;
    past.lane[i].instance = index;
    past.lane[i].steps = args.history.place[index];
    past.lane[i].begins = false;
    past.lane[i].resumes = true;
    past.lane[i].has_trial = false;
    past.lane[i].trouble = past_trouble::none;
    MYRIAD_UNROLL
    for (int j = 0; j < n_delayed<Model>; ++j) {
        past.lane[i].from[j] = -1;
        past.lane[i].before[j] = past.lane[i].none;
        past.lane[i].seen[j].number = past.lane[i].steps - 1;
    }
    past.lane[i].forget();
}

/// Lane i of them.
template <class Model, class S>
MYRIAD_FUNCTION void copy_lane(past_view<Model, real_of<S>>& to, const past_view<Model, S>& from, int i) {
    to.ring = from.ring;
    to.stride = from.stride;
    to.slots = from.slots;
    to.terms = from.terms;
    to.row = from.row;
    to.reached = static_cast<real_of<S>>(get_lane(from.reached, i));
    to.lane[0] = from.lane[i];
}

}  // namespace myriad::detail::inline MYRIAD_TARGET

namespace myriad::inline MYRIAD_TARGET {

/// The values of the past, in a model that has delays.
template <class Model, class S, bool there>
struct values_of_past {};
template <class Model, class S>
struct values_of_past<Model, S, true> {
    /// `p.delayed[d]`: delayed value d.
    mutable vec<S, detail::n_delayed<Model>> delayed;
    detail::past_view<Model, S> past;
};

/// The same for hooks, at the state that they see.
template <class Model, class S, bool there>
struct past_of_hook {
    template <class Data>
    MYRIAD_FUNCTION explicit past_of_hook(const Data&) {}
};
template <class Model, class S>
struct past_of_hook<Model, S, true> {
    const vec<S, detail::n_delayed<Model>>& delayed;  ///< the values of the past
    template <class Data>
    MYRIAD_FUNCTION explicit past_of_hook(const Data& d) : delayed(d.delayed) {}
};

}  // namespace myriad::inline MYRIAD_TARGET
