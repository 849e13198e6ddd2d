// SPDX-License-Identifier: MIT
// The past of an instance whose model has delays: the steps taken, in a ring, each as the polynomial of the method's
// own interpolant, and what of it the right-hand side reads. Where the solution jumps, itself or in a derivative, a
// step of length zero lies between the others. A value is looked for between two jumps, never across one: steps end
// where a jump arrives, and the one before it sees the polynomial before the jump.
#pragma once

#include <cstdint>

#include "myriad/kernel/core/vec.hpp"
#include "myriad/kernel/model/lane_past.hpp"
#include "myriad/kernel/scalar/dual.hpp"
#include "myriad/kernel/scalar/math.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// The past of all lanes.
template <class Model, class S>
struct past_view {
    using R = real_of<S>;
    static constexpr int lanes = lanes_of<S>;

    // Field f of slot s of instance i is at ring[(s * fields + f) * stride + i]; behind the slots are the initial
    // states, the time by which the past was moved, and that at which it began.
    R* ring;
    std::int64_t stride;
    std::int32_t slots, terms;  // slots: a power of two
    S reached;                  // the end of the last step
    std::int64_t row;           // numbers from one slot to the next
    lane_past<Model, R> lane[lanes];

    MYRIAD_FUNCTION R* step_of(int i, std::int32_t k) const {
        return ring + static_cast<std::uint32_t>(k & (slots - 1)) * row + lane[i].instance;
    }
    MYRIAD_FUNCTION R* initial_of(int i) const { return ring + slots * row + lane[i].instance; }
    /// How far the past was moved, by phases whose time begins again.
    MYRIAD_FUNCTION R& moved_of(int i) const { return initial_of(i)[MYRIAD_LENGTH(n_kept<Model>) * stride]; }
    /// The time at which it began, moved likewise.
    MYRIAD_FUNCTION R& begin_of(int i) const { return initial_of(i)[(MYRIAD_LENGTH(n_kept<Model>) + 1) * stride]; }
    /// Number c of an entry of the list of jumps: breaking_points.hpp.
    MYRIAD_FUNCTION R& jump_number(int i, std::int32_t number, int c) const {
        const std::int64_t place = MYRIAD_LENGTH(n_kept<Model>) + 2 + (number & (slots - 1)) * jump_numbers<Model> + c;
        return initial_of(i)[place * stride];
    }
    /// The time at which step k begins; that of the step after the last is written, too.
    MYRIAD_FUNCTION R& start_of(int i, std::int32_t k) const { return *step_of(i, k); }
    /// The numbers of a state in a step.
    MYRIAD_FUNCTION R* terms_of(R* step, int place) const {
        return step + (1 + static_cast<std::int64_t>(place) * terms) * stride;
    }
    /// The first step that is still there while the next one is written.
    MYRIAD_FUNCTION std::int32_t oldest(int i) const { return lane[i].steps + 2 - slots; }

    /// Where the state of delayed value j is among those kept.
    template <class J>
    MYRIAD_FUNCTION auto place_of(int i, J j) const {
        if constexpr (team_size<Model> == 1) {
            return place_of_kept<Model>(j);
        } else {
            return lane[i].delayed[j];
        }
    }
    /// Calls `visit(place, number of the state)` for each state that is kept; in a team for those of the thread.
    template <class Visit>
    MYRIAD_FUNCTION void for_each_kept(Visit&& visit) const {
        if constexpr (team_size<Model> == 1) {
            detail::for_each_kept_state<Model>(visit);
        } else {
            component_loop_of_part<Model>::template range<0, n_state<Model>>([&](auto c) MYRIAD_LAMBDA {
                if (lane[0].own[c] >= 0) visit(lane[0].own[c], static_cast<int>(c));
            });
        }
    }

    /// The length of the last step.
    MYRIAD_FUNCTION R last_length(int i) const {
        return lane[i].steps > 0 ? start_of(i, lane[i].steps) - start_of(i, lane[i].steps - 1) : R(0);
    }

    /// Whether functions at t have seen all delayed values last, if lags are constant, so that they are as they were.
    MYRIAD_FUNCTION bool has_recalled(const S& t) const {
        bool has = has_constant_lags<Model, S>;
        MYRIAD_UNROLL
        for (int i = 0; i < lanes; ++i) has = has && lane[i].recalled == get_lane(t, i);
        return has;
    }
    MYRIAD_FUNCTION void set_recalled(const S& t) const {
        MYRIAD_UNROLL
        for (int i = 0; i < lanes; ++i) lane[i].recalled = get_lane(t, i);
    }
    /// A hook may have changed what histories and lags depend on.
    MYRIAD_FUNCTION void forget_recalled() const {
        MYRIAD_UNROLL
        for (int i = 0; i < lanes; ++i) lane[i].recalled = nan_of<R>;
    }

    /// Looks at the step that delayed value j of functions at t sees at that time: the last that begins there or
    /// before.
    template <class J>
    MYRIAD_FUNCTION const seen_step<R>& look(J j, int i, R time, R t) const {
        seen_step<R>& seen = lane[i].seen[j];
        // It ends where the last step does or before, so that a time in it is known and no lag negative.
        if (!seen.has(time)) find(j, i, time, t, seen);
        return seen;
    }
    /// The polynomial of a step, not before the beginning, for the state of delayed value j at that time, or its
    /// derivative of that order.
    template <int order = 0, class J>
    MYRIAD_FUNCTION R value_in(J j, int i, const seen_step<R>& seen, R time) const {
        static_assert(order <= 2);
        const R theta = (time - seen.start) * seen.per_length;
        R value;
        if (terms == 2) {
            if constexpr (order == 0)
                return fma(theta, fma(theta, fma(theta, seen.cubic, seen.quadratic), seen.linear), seen.value);
            if constexpr (order == 1)
                value = fma(theta, fma(R(3) * theta, seen.cubic, seen.quadratic + seen.quadratic), seen.linear);
            if constexpr (order == 2) value = R(2) * fma(R(3) * theta, seen.cubic, seen.quadratic);
        } else {
            const R* const here = terms_of(step_of(i, seen.number), place_of(i, j));
            const auto term = [&](int power) MYRIAD_LAMBDA {
                R factor = here[power * stride];
                for (int k = 0; k < order; ++k) factor = static_cast<R>(power - k) * factor;
                return factor;
            };
            value = term(terms - 1);
            MYRIAD_ROLLED
            for (int power = terms - 2; power >= order; --power) value = fma(theta, value, term(power));
        }
        MYRIAD_UNROLL
        for (int k = 0; k < order; ++k) value = value * seen.per_length;
        return value;
    }

private:
    /// What the ring has of a step: its times and, for `terms` = 2, the state and its slope at both.
    struct kept_step {
        R start, end, here, slope_here, there, slope_there;
    };
    /// Reads step k of the state of delayed value j, all at once: on a GPU, one read waits as long as several.
    template <class J>
    MYRIAD_FUNCTION kept_step read(J j, int i, std::int32_t k) const {
        R *const step = step_of(i, k), *const next = step_of(i, k + 1);
        kept_step at{step[0], next[0], R(0), R(0), R(0), R(0)};
        if (terms == 2) {
            const R* const here = terms_of(step, place_of(i, j));
            const R* const there = terms_of(next, place_of(i, j));
            at.here = here[0], at.slope_here = here[stride];
            at.there = there[0], at.slope_there = there[stride];
        }
        MYRIAD_MEMORY_BARRIER;  // else the compiler reads some of them later
        if (k < 0) at.start = -infinity_of<R>;
        return at;
    }
    /// The first and the last step that delayed value j may see now.
    struct visible_steps {
        std::int32_t first, last;
    };
    template <class J>
    MYRIAD_FUNCTION visible_steps visible(J j, int i) const {
        const lane_past<Model, R>& past = lane[i];
        const auto lag = number_of_lag<Model>(j);
        const std::int32_t known = past.steps + (past.has_trial ? 1 : 0);
        return {past.from[lag] > oldest(i) ? past.from[lag] : oldest(i),
                (past.before[lag] < known ? past.before[lag] : known) - 1};
    }
    /// The same where it is none of those that are likely.
    template <class J>
    MYRIAD_FUNCTION void search(J j, int i, R time, R t, std::int32_t& k, kept_step& at) const {
        const lane_past<Model, R>& past = lane[i];
        const auto lag = number_of_lag<Model>(j);
        const R end = get_lane(reached, i);
        if (!(time <= t + R(16) * epsilon_of<R> * abs(t))) past.trouble |= past_trouble::invalid;
        if (time > end + R(64) * epsilon_of<R> * max(abs(end), abs(t))) past.trouble |= past_trouble::not_yet;
        const auto [first, last] = visible(j, i);
        if (last < 0) {
            k = -1;
            return;
        }
        MYRIAD_ROLLED
        while (k < last && at.end <= time) at = read(j, i, ++k);
        MYRIAD_ROLLED
        while (k > first && at.start > time) at = read(j, i, --k);
        if (MYRIAD_UNLIKELY(k > past.from[lag] && k == first && at.start > time)) {
            if (past.from[lag] < 0 && time < begin_of(i)) {
                k = -1;
            } else {
                past.trouble |= past_trouble::lost;
            }
        }
        if (is_delayed_slope<Model>(j)) {  // a jump that is now, behind which there is no slope yet
            if (MYRIAD_UNLIKELY(k >= 0 && at.start == at.end)) at = read(j, i, --k);
        }
    }
    /// Finds the step that contains a time that is not in the one seen last.
    template <class J>
    MYRIAD_LARGE_FUNCTION void find(J j, int i, R time, R t, seen_step<R>& seen) const {
        const lane_past<Model, R>& past = lane[i];
        const auto [first, last] = visible(j, i);
        std::int32_t k = seen.number + (time < seen.end ? 0 : 1);  // time goes on, mostly
        if (k > last) k = last;
        if (k < first) k = first;
        kept_step at = read(j, i, k);
        // One that ends where the last step does or before: a time in it is known, and no lag negative.
        const bool is_there = (at.start <= time) & (time < at.end) & (k < past.steps) & (k <= last);
        if (MYRIAD_UNLIKELY(!is_there)) {
            search(j, i, time, t, k, at);
        }
        if (k < 0) return see_initial(j, i, seen);
        R length = at.end - at.start, reach = length;
        bool is_short = false;
        if (!detail::lags_are_constant<Model, R>()) {
            // Before a jump a step is continued beyond its end: the last that is not short, as the polynomial of a
            // short one is, farther away, one of roundings. Jumps lie in steps without length.
            const auto find_short = [&]() MYRIAD_LAMBDA {
                length = at.end - at.start;
                reach = R(0.125) * (time - at.start);
                is_short = reach > length;
            };
            find_short();
            MYRIAD_ROLLED
            while (MYRIAD_UNLIKELY(is_short) && length > R(0) && k > first && k > 0) {
                const kept_step earlier = read(j, i, k - 1);
                if (!(earlier.end > earlier.start)) break;
                at = earlier;
                --k;
                find_short();
            }
            reach = max(length, reach);
        }
        seen.number = k;
        seen.start = at.start;
        // A trial is looked at anew each time, as the next one replaces it.
        seen.end = k < past.steps && !is_short ? at.end : -infinity_of<R>;
        // In one without length, at a jump, all times are its end.
        seen.per_length = length != R(0) ? reciprocal(reach) : R(0);
        if (terms == 2) {
            const R difference = at.there - at.here;
            const R rise_here = length * at.slope_here, rise_there = length * at.slope_there;
            seen.value = length != R(0) ? at.here : at.there;
            seen.linear = rise_here;
            seen.quadratic = R(3) * difference - rise_here - rise_here - rise_there;
            seen.cubic = rise_here + rise_there - difference - difference;
            // Time goes on: the next steps are likely to be looked at next. Runge and Kutta's steps of Lorenz with a
            // delay on an NVIDIA H200, ms: 38.3 where the end of the one after the next is prefetched, 40.0 by that of
            // the next, 48.8 without.
            R* const later = step_of(i, k + 3);
            const R* const there = terms_of(later, place_of(i, j));
            MYRIAD_PREFETCH(later), MYRIAD_PREFETCH(there), MYRIAD_PREFETCH(there + stride);
        }
    }
    /// Before the beginning, without a history function, the states were what they were there.
    template <class J>
    MYRIAD_FUNCTION void see_initial(J j, int i, seen_step<R>& seen) const {
        seen.number = -1;
        seen.start = -infinity_of<R>;
        if (lanes > 1 && lane[i].instance < 0) {  // which other threads may be writing
            seen.end = infinity_of<R>;
            seen.value = R(0);
            return;
        }
        seen.end = begin_of(i);
        seen.value = initial_of(i)[place_of(i, j) * stride];
    }
};

/// The past of instance `index` in lane i, by that method; without an index, one without steps.
template <class Method, class Model, class S, class Arguments>
MYRIAD_FUNCTION void look_back(past_view<Model, S>& past, const Arguments& args, int i, std::int64_t index) {
    past.ring = args.history.ring;
    past.stride = args.size;
    past.slots = args.history.slots;
    past.terms = history_terms<Method>;
    past.row = history_fields(MYRIAD_LENGTH(n_kept<Model>), history_terms<Method>) * args.size;
    past.lane[i].instance = index;
    past.lane[i].steps = index >= 0 ? args.history.place[index] : 0;
    past.lane[i].begins = false;
    past.lane[i].resumes = true;
    past.lane[i].has_trial = false;
    past.lane[i].trouble = past_trouble::none;
    detail::for_each_lag<Model>([&](auto g, auto) MYRIAD_LAMBDA {
        past.lane[i].from[g] = -1;
        past.lane[i].before[g] = past.lane[i].none;
    });
    detail::for_each_delayed<Model>([&](auto j)
                                        MYRIAD_LAMBDA { past.lane[i].seen[j].number = past.lane[i].steps - 1; });
    past.lane[i].forget();
    if constexpr (team_size<Model> != 1) past.lane[i].find();
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
    to.lane[0].recalled = nan_of<real_of<S>>;  // values are copied elsewhere
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
    /// Of a model with neighbouring solutions, until a jump is in the list of jumps: whether there is one, and how much
    /// later it is in each of them.
    vec<S, detail::jump_numbers<Model>> later;
};
/// With derivatives, without the past itself.
template <class Model, class S, class Derivative>
struct values_of_past<Model, dual<S, Derivative>, true> {
    mutable vec<dual<S, Derivative>, detail::n_delayed<Model>> delayed;
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
/// Of a model with neighbouring solutions, for the library's own hooks.
template <class Model, class S>
requires(detail::jump_numbers<Model> > 0 && !detail::is_dual<S>) struct past_of_hook<Model, S, true> {
    const vec<S, detail::n_delayed<Model>>& delayed;
    const detail::past_view<Model, S>& past;
    vec<S, detail::jump_numbers<Model>>& later;
    template <class Data>
    MYRIAD_FUNCTION explicit past_of_hook(Data& d) : delayed(d.delayed), past(d.past), later(d.later) {}
};

}  // namespace myriad::inline MYRIAD_TARGET
