// SPDX-License-Identifier: MIT
// The breaking points of a model with delays: the times at which the solution is less smooth than elsewhere. It jumps,
// itself or in a derivative, at the beginning and at actions; each jump arrives again a lag later, one derivative
// higher, until the method's order does not see it any more. Steps end there, as at stop times. Bellen, Zennaro,
// Numerical Methods for Delay Differential Equations (2003), chapters 2 and 4.
#pragma once

#include "myriad/kernel/model/recall.hpp"
#include "myriad/kernel/scalar/root_finder.hpp"
#include "myriad/kernel/state/inside_step.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

template <class Model, class Method, class S>
struct breaking_points {
    using R = real_of<S>;
    using mask = mask_of<S>;
    static constexpr int lags = n_delayed<Model>;

    /// Whether the times at which jumps arrive are known in advance; and whether steps end there, which fixed ones do
    /// only then.
    static constexpr bool knows_arrivals = has_constant_lags<Model, R>, tracks = knows_arrivals || is_adaptive<Method>;

    const kernel_arguments<Model, R>& args;
    integration_state<Model, Method, S>& s;

    /// Lane i has no instance: what it looks up in vain is a past without steps.
    MYRIAD_FUNCTION void clear(int i) const {
        detail::look_back(s.data.past, args, i, 0);
        past(i).steps = 0;
        set_lane(s.data.past.reached, i, R(0));
        set_lane(s.breaks.redone, i, false);
        s.breaks.listed[i] = 0;
        MYRIAD_UNROLL
        for (int j = 0; j < lags; ++j) {
            s.breaks.next[i][j] = 0;
            s.breaks.arrival[i][j] = infinity_of<R>;
        }
    }

    /// What lane i keeps between phases and calls.
    MYRIAD_FUNCTION void load(int i) const {
        detail::look_back(s.data.past, args, i, s.instance[i]);
        s.breaks.listed[i] = place(i, 1);
        past(i).begins = ends_at_jump(i);
        set_lane(s.breaks.redone, i, false);
        MYRIAD_UNROLL
        for (int j = 0; j < lags; ++j) s.breaks.next[i][j] = -1;
    }
    MYRIAD_FUNCTION void store(int i) const {
        place(i, 0) = past(i).steps;
        place(i, 1) = s.breaks.listed[i];
    }

    /// A phase of lane i begins at its time and state, `moved` from the time at which the last one ended: the past
    /// moves with it. Returns `invalid_delay` if a lag is none that steps can be taken with.
    [[nodiscard]] MYRIAD_FUNCTION status begin(int i, bool is_first, R moved) const {
        const R t = get_lane(s.data.t, i);
        set_lane(s.data.past.reached, i, t);
        past(i).resumes = true;
        if (is_first) {
            past(i).steps = 0;
            past(i).begins = true;
            s.data.past.moved_of(i) = R(0);
            s.breaks.listed[i] = 0;
            s.data.past.start_of(i, 0) = t;
            R* const initial = s.data.past.initial_of(i);
            detail::for_each_kept_state<Model>([&](auto at, int state) MYRIAD_LAMBDA {
                initial[at * s.data.past.stride] = get_lane(s.data.y[state], i);
            });
            mark(i, has_history<Model> ? 0 : 1);
        } else {
            if (moved != R(0)) move_past(i, moved);
            if (differs_from_past(i)) mark(i, 0);
        }
        find_next(i);
        return lags_are_valid(i) ? status::success : status::invalid_delay;
    }

    /// An action has changed lane i: its state jumps, or, at `level` 1, its slope.
    MYRIAD_FUNCTION void jump(int i, int level) const {
        mark(i, level);
        find_next(i);
    }

    /// Lanes in which a jump of the past may have arrived.
    MYRIAD_FUNCTION mask due(const mask& accepted) const {
        if constexpr (knows_arrivals) {
            mask come = mask(false);
            for_each_lane(accepted, [&](int i) MYRIAD_LAMBDA {
                const R t = get_lane(s.data.t, i);
                bool one = false;
                MYRIAD_UNROLL
                for (int j = 0; j < lags; ++j) one = one || has_come(s.breaks.arrival[i][j], t);
                set_lane(come, i, one);
            });
            return come;
        } else {
            return accepted;
        }
    }
    /// Lets the jumps that are due in lane i arrive. Returns the lowest order of a derivative of the solution that
    /// jumps there, `never` if none does: at 1 delayed values jump themselves.
    MYRIAD_FUNCTION int arrive(int i) const {
        int level = never;
        MYRIAD_UNROLL
        for (int j = 0; j < lags; ++j) {
            while (has_arrived(i, j)) {
                level = min(level, level_at(i, s.breaks.next[i][j]) + 1);
                look_at(i, j, s.breaks.next[i][j] + 1);
            }
        }
        if (level <= Method::order) mark(i, level);
        return level;
    }
    static constexpr int never = 100;

    /// Of lags that depend on time or state: has the accepted trials, in which a jump arrives before the end, be taken
    /// again up to there. They have looked at what was before the jump, continued beyond it, so that their interpolant
    /// shows when it arrives. Returns the lanes; fixed steps are never taken again.
    MYRIAD_FUNCTION mask locate(const accepted_step<Model, Method, S>& seen) const {
        const auto& y1 = seen.trial.y;
        mask crossed = mask(false);
        MYRIAD_UNROLL
        for (int j = 0; j < lags; ++j) {
            const S beyond = seen_beyond_jump(j, seen.t1, y1);
            crossed = crossed | (seen.accepted & (beyond > instant(s.h)));
        }
        if (!MYRIAD_UNLIKELY(any(crossed))) return crossed;
        const auto step = seen.inside(crossed);
        // The step ends a little beyond the jump, so that the next one does not begin before it.
        const S target = S(R(0.02)) * instant(s.h), near = S(R(0.01)) * instant(s.h);
        const auto nearest = [&](const S& theta, mask& close) MYRIAD_LAMBDA {
            const auto y = detail::interpolate(step, theta);
            S most = S(-infinity_of<R>);
            MYRIAD_UNROLL
            for (int j = 0; j < lags; ++j) most = larger(most, seen_beyond_jump(j, fma(theta, step.h, step.t), y));
            close = abs(most - target) <= near;
            return target - most;
        };
        mask unused = mask(false);
        bracket<S> between{S(R(0)), S(R(1)), nearest(S(R(0)), unused), nearest(S(R(1)), unused)};
        // One that is not before its jump at the start has just seen it arrive.
        between.f_low = larger(between.f_low, S(R(1e-3)) * instant(s.h));
        const S theta = detail::find_root(between, crossed, nearest);
        const S least = S(resolved_roundings<R>) * abs(s.data.t);
        const S length = larger(theta * s.h, least);
        // The rest of a step that ends there already is none.
        crossed = crossed & (length < s.h - instant(s.h));
        s.data.h_next = select(crossed, length, s.data.h_next);
        s.breaks.redone = crossed;
        return crossed;
    }
    /// How near to a jump the end of a step of length h is at it.
    template <class T>
    static MYRIAD_FUNCTION T instant(const T& h) {
        return T(std::is_same_v<R, float> ? R(1e-3) : R(1e-6)) * abs(h);
    }

    /// The nearest time, before `end`, at which steps of lane i have to end.
    static MYRIAD_FUNCTION R nearest(const integration_state<Model, Method, S>& s, int i, R end) {
        const R t = get_lane(s.data.t, i);
        MYRIAD_UNROLL
        for (int j = 0; j < lags; ++j) {
            const R time = s.breaks.arrival[i][j];
            if (time > t && time < end) end = time;
        }
        return end;
    }

    /// The longest step for which all times that it sees lie in the past.
    MYRIAD_FUNCTION S longest_step() const {
        S longest = S(infinity_of<R>);
        MYRIAD_UNROLL
        for (int j = 0; j < lags; ++j) {
            const S lag = detail::lag_of<Model>(j, s.data.t, s.data.y, static_cast<const inputs<Model, S>&>(s.data));
            longest = select(lag > S(R(0)), smaller(longest, lag), longest);
        }
        return longest;
    }

private:
    MYRIAD_FUNCTION lane_past<Model, R>& past(int i) const { return s.data.past.lane[i]; }
    MYRIAD_FUNCTION std::int32_t& place(int i, int c) const {
        return args.history.place[static_cast<std::int64_t>(c) * args.size + s.instance[i]];
    }
    /// An entry of the list of jumps, a ring too: the number of the step of length zero there, and the order of the
    /// derivative that jumps.
    MYRIAD_FUNCTION std::uint32_t& entry(int i, std::int32_t number) const {
        const auto row = static_cast<std::int64_t>(number & (args.history.slots - 1));
        return args.history.jumps[row * args.size + s.instance[i]];
    }
    static constexpr int level_bits = 4;  // the highest order of a method is 9
    /// The last step of that number, of which the entry has 28 bits.
    MYRIAD_FUNCTION std::int32_t step_of(int i, std::int32_t number) const {
        const auto steps = static_cast<std::uint32_t>(past(i).steps);
        const std::uint32_t ago = ((steps << level_bits) - (entry(i, number) & ~0xfu)) >> level_bits;
        return static_cast<std::int32_t>(steps - ago);
    }
    MYRIAD_FUNCTION int level_at(int i, std::int32_t number) const { return static_cast<int>(entry(i, number) & 0xf); }
    MYRIAD_FUNCTION void put_entry(int i, std::int32_t number, std::int32_t step, int level) const {
        entry(i, number) = static_cast<std::uint32_t>(step) << level_bits | static_cast<std::uint32_t>(level);
    }

    /// How far beyond its next jump delayed value j sees at (t, y); before it the number is negative.
    MYRIAD_FUNCTION S seen_beyond_jump(int j, const S& t, const vec<S, n_state<Model>>& y) const {
        const S time = t - detail::lag_of<Model>(j, t, y, static_cast<const inputs<Model, S>&>(s.data));
        S beyond = S(-infinity_of<R>);
        MYRIAD_UNROLL
        for (int i = 0; i < lanes_of<S>; ++i)
            if (past(i).before[j] != lane_past<Model, R>::none)
                set_lane(beyond, i, get_lane(time, i) - s.data.past.start_of(i, past(i).before[j]));
        return beyond;
    }
    MYRIAD_FUNCTION bool has_arrived(int i, int j) const {
        const R t = get_lane(s.data.t, i);
        if constexpr (knows_arrivals) {
            return has_come(s.breaks.arrival[i][j], t);
        } else {
            if (s.breaks.next[i][j] >= s.breaks.listed[i]) return false;
            const R close = instant(s.data.past.last_length(i)) + resolved_roundings<R> * abs(t);
            return t - lag(i, j) >= s.data.past.start_of(i, past(i).before[j]) - close;
        }
    }
    /// Whether a time has come, up to its rounding.
    static MYRIAD_FUNCTION bool has_come(R time, R t) { return time <= t + resolved_roundings<R> * abs(t); }
    MYRIAD_FUNCTION R lag(int i, int j) const {
        const auto& p = detail::inputs_of_lane(s.data, i);
        return detail::lag_of<Model>(j, get_lane(s.data.t, i), get_lanes<R>(s.data.y, i),
                                     static_cast<const inputs<Model, R>&>(p));
    }
    MYRIAD_FUNCTION R arrival_of(int i, int j, std::int32_t number) const {
        return s.data.past.start_of(i, step_of(i, number)) + lag(i, j);
    }

    /// Whether the last step of lane i is one of length zero, at a jump that is listed.
    MYRIAD_FUNCTION bool ends_at_jump(int i) const {
        const std::int32_t listed = s.breaks.listed[i];
        return listed > 0 && step_of(i, listed - 1) == past(i).steps - 1;
    }
    /// The next step begins at a jump of the derivative of that order: a step of length zero lies before it.
    MYRIAD_FUNCTION void mark(int i, int level) const {
        past(i).resumes = true;
        if constexpr (!tracks) return;
        std::int32_t& listed = s.breaks.listed[i];
        if (ends_at_jump(i)) {
            level = min(level, level_at(i, listed - 1));
            --listed;
        } else {
            ++past(i).steps;
            s.data.past.start_of(i, past(i).steps) = get_lane(s.data.past.reached, i);
            past(i).begins = true;
        }
        put_state(i);
        put_entry(i, listed, past(i).steps - 1, level);
        ++listed;
        MYRIAD_UNROLL
        for (int j = 0; j < lags; ++j)
            if (s.breaks.next[i][j] == listed - 1) look_at(i, j, listed - 1);
    }
    /// The step of length zero before the next one has the state of lane i as it is: what is seen of the present.
    MYRIAD_FUNCTION void put_state(int i) const {
        past_view<Model, S>& all = s.data.past;
        R* const step = all.step_of(i, past(i).steps - (all.terms == 2 ? 0 : 1));
        detail::for_each_kept_state<Model>([&](auto place, int state) MYRIAD_LAMBDA {
            R* const to = all.terms_of(step, place);
            to[0] = get_lane(s.data.y[state], i);
            for (int power = 1; power < all.terms; ++power) to[power * all.stride] = R(0);
        });
    }
    /// Delayed value j of lane i sees what lies before the jump of that number, and not before the one before it.
    MYRIAD_FUNCTION void look_at(int i, int j, std::int32_t number) const {
        const bool there = number < s.breaks.listed[i];
        const bool one_before = number > 0 && s.breaks.listed[i] - number < args.history.slots;
        s.breaks.next[i][j] = number;
        past(i).seen[j].forget();
        s.breaks.arrival[i][j] = knows_arrivals && there ? arrival_of(i, j, number) : infinity_of<R>;
        past(i).before[j] = there ? step_of(i, number) : lane_past<Model, R>::none;
        past(i).from[j] = knows_arrivals && one_before ? step_of(i, number - 1) + 1 : -1;
    }
    /// Finds the next jump of each delayed value of lane i.
    MYRIAD_FUNCTION void find_next(int i) const {
        const R t = get_lane(s.data.t, i);
        MYRIAD_UNROLL
        for (int j = 0; j < lags; ++j) {
            past(i).seen[j].number = past(i).steps - 1;
            past(i).seen[j].forget();
            if constexpr (tracks) {
                const std::int32_t listed = s.breaks.listed[i], oldest = listed - args.history.slots;
                std::int32_t number = oldest > 0 ? oldest : 0;
                const auto is_over = [&](std::int32_t at) MYRIAD_LAMBDA {
                    const bool kept = step_of(i, at) >= s.data.past.oldest(i);
                    return !kept || has_come(arrival_of(i, j, at), t);
                };
                while (number < listed && is_over(number)) ++number;
                look_at(i, j, number);
            } else {
                s.breaks.arrival[i][j] = infinity_of<R>;
                past(i).before[j] = lane_past<Model, R>::none;
                past(i).from[j] = -1;
            }
        }
    }

    MYRIAD_FUNCTION void move_past(int i, R by) const {
        s.data.past.moved_of(i) += by;
        const std::int32_t oldest = s.data.past.oldest(i);
        for (std::int32_t k = oldest > 0 ? oldest : 0; k <= past(i).steps; ++k) s.data.past.start_of(i, k) += by;
    }
    /// Whether the state is not that at the end of the last step.
    MYRIAD_FUNCTION bool differs_from_past(int i) const {
        past_view<Model, S>& all = s.data.past;
        const bool by_slopes = all.terms == 2;
        R* const step = all.step_of(i, past(i).steps - (by_slopes ? 0 : 1));
        bool differs = false;
        detail::for_each_kept_state<Model>([&](auto place, int state) MYRIAD_LAMBDA {
            R end = R(0), size = R(0);
            for (int power = 0; power < (by_slopes ? 1 : all.terms); ++power) {
                const R term = all.terms_of(step, place)[power * all.stride];
                end += term;
                size += abs(term);
            }
            differs = differs || !(abs(end - get_lane(s.data.y[state], i)) <= R(64) * epsilon_of<R> * size);
        });
        return differs;
    }
    /// Time runs forwards, lags are numbers from zero on, and no fixed step is longer than one that is constant.
    MYRIAD_FUNCTION bool lags_are_valid(int i) const {
        bool valid = get_lane(s.data.t_end, i) >= get_lane(s.data.t, i);
        const R least = is_adaptive<Method> || !knows_arrivals ? R(0) : args.step * R(1 - 1e-6);
        MYRIAD_UNROLL
        for (int j = 0; j < lags; ++j) {
            const R ago = lag(i, j);
            valid = valid && ago >= least && (ago > R(0) || !knows_arrivals);
        }
        return valid;
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
