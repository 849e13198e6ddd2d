// SPDX-License-Identifier: MIT
// The breaking points of a model with delays: the times at which the solution is less smooth than elsewhere. It jumps,
// itself or in a derivative, at the beginning and at actions; each jump arrives again a lag later, one derivative
// higher, until the method's order does not see it any more. Steps end there, as at stop times. Bellen, Zennaro,
// Numerical Methods for Delay Differential Equations (2003), chapters 2 and 4.
#pragma once

#include "myriad/kernel/event/jump_list.hpp"
#include "myriad/kernel/model/recall.hpp"
#include "myriad/kernel/scalar/root_finder.hpp"
#include "myriad/kernel/state/inside_step.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// The most jumps that are followed for one that comes from elsewhere, and the most up to the second derivative.
inline constexpr std::int64_t most_jumps_of_one = 1024, most_jumps_to_second = 16 * most_jumps_of_one;
/// The highest order of a derivative whose jumps are followed, of a method of that order: this order or, where there
/// are so many lags that these would be too many, a lower one. One jump arrives by each of n lags, each time a
/// derivative higher: that makes binomial(n + k, k) of them up to k derivatives higher, all within k longest lags.
/// With an order of one, only the jump itself arrives, once by each lag.
template <class Model>
MYRIAD_FUNCTION int highest_jump(int order) {
    std::int64_t jumps = 1;
    for (int k = 1; k <= order; ++k) {
        jumps = jumps * (MYRIAD_LENGTH(n_lag<whole_of<Model>>) + k) / k;
        if (jumps > (k > 2 ? most_jumps_of_one : most_jumps_to_second) && k > 1) return k - 1;
    }
    return order;
}

template <class Model, class Method, class S>
struct breaking_points {
    using R = real_of<S>;
    using mask = mask_of<S>;

    using list_type = jump_list<Model, Method, S>;
    /// Whether it may be that steps have to be taken again up to where a jump arrives: `locate`.
    static constexpr bool may_locate = is_adaptive<Method> && !has_constant_lags<Model, R>;
    static MYRIAD_FUNCTION bool knows_arrivals() { return list_type::knows_arrivals(); }
    static MYRIAD_FUNCTION int highest() {
        if constexpr (gives_tables_of_past<Model>) {
            return detail::highest_jump<Model>(Method::order);
        } else {
            constexpr int known = detail::highest_jump<Model>(Method::order);
            return known;
        }
    }

    const kernel_arguments<Model, R>& args;
    integration_state<Model, Method, S>& s;

    MYRIAD_FUNCTION list_type list() const { return {args, s}; }

    /// Lane i has no instance: what it looks up in vain is a past without steps.
    MYRIAD_FUNCTION void clear(int i) const {
        detail::look_back<Method>(s.data.past, args, i, -1);
        set_lane(s.data.past.reached, i, R(0));
        set_lane(s.breaks.redone, i, false);
        s.breaks.listed[i] = 0;
        detail::for_each_lag<Model>([&](auto g, auto) MYRIAD_LAMBDA {
            s.breaks.next[i][g] = 0;
            s.breaks.arrival[i][g] = infinity_of<R>;
        });
    }

    /// What lane i keeps between phases and calls.
    MYRIAD_FUNCTION void load(int i) const {
        detail::look_back<Method>(s.data.past, args, i, s.instance[i]);
        s.breaks.listed[i] = place(i, 1);
        past(i).begins = list().ends_at_jump(i);
        set_lane(s.breaks.redone, i, false);
        detail::for_each_lag<Model>([&](auto g, auto) MYRIAD_LAMBDA { s.breaks.next[i][g] = -1; });
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
        neighbour_jumps<Model, Method, S>{s}.set_later(i, {});
        past(i).resumes = true;
        if (is_first) {
            past(i).steps = 0;
            past(i).begins = true;
            s.data.past.moved_of(i) = R(0);
            s.breaks.listed[i] = 0;
            s.data.past.start_of(i, 0) = s.data.past.begin_of(i) = t;
            R* const initial = s.data.past.initial_of(i);
            s.data.past.for_each_kept([&](auto at, int state) MYRIAD_LAMBDA {
                initial[at * s.data.past.stride] = get_lane(s.data.y[state], i);
            });
            const int level = gives_any_history<Model>() ? 0 : 1;
            list().mark(i, level, level);
        } else {
            if (moved != R(0)) move_past(i, moved);
            if (list().differs_from_past(i)) list().mark(i, 0);
        }
        list().find_next(i);
        return lags_are_valid(i) ? status::success : status::invalid_delay;
    }

    /// An action has changed lane i: its state jumps, or, at `level` 1, its slope.
    MYRIAD_FUNCTION void jump(int i, int level) const {
        list().mark(i, level);
        if constexpr (list_type::has_neighbours) {
            // What has come arrives after actions.
            detail::for_each_lag<Model>([&](auto g, auto j)
                                            MYRIAD_LAMBDA { list().look_at(i, g, j, list().next(i, g)); });
        } else {
            list().find_next(i);
        }
    }

    /// Lanes in which a jump of the past may have arrived.
    MYRIAD_FUNCTION mask due(const mask& accepted) const {
        if (knows_arrivals()) {
            mask come = mask(false);
            for_each_lane(accepted, [&](int i) MYRIAD_LAMBDA {
                const R t = get_lane(s.data.t, i);
                bool one = false;
                detail::for_each_lag<Model>(
                    [&](auto g, auto) MYRIAD_LAMBDA { one = one || list_type::has_come(s.breaks.arrival[i][g], t); });
                set_lane(come, i, team_of_lags<Model>::any(one));
            });
            return come;
        } else {
            return accepted;
        }
    }
    /// Lets the jumps that are due in lane i arrive. Returns the lowest order of a derivative of the solution that
    /// jumps there, `no_jump` if none does: at 1 or below delayed values jump themselves.
    MYRIAD_FUNCTION int arrive(int i) const {
        int level = no_jump, own = unknown_jump;
        if constexpr (list_type::has_neighbours) {
            const auto lowest = neighbour_jumps<Model, Method, S>{s}.arrive(i, list());
            level = lowest.all, own = lowest.own;
        } else {
            detail::for_each_lag<Model>([&](auto g, auto j) MYRIAD_LAMBDA {
                while (list().has_arrived(i, g, j)) {
                    const std::int32_t number = list().next(i, g);
                    level = min(level, level_of_arrival<Model>(j, list().level_at(i, number)));
                    list().look_at(i, g, j, number + 1);
                }
            });
        }
        level = team_of_lags<Model>::smallest(level);
        if (level <= highest()) list().mark(i, level, own);
        return level;
    }

    /// Of lags that depend on time or state: has the accepted trials, in which a jump arrives before the end, be taken
    /// again up to there. They have looked at what was before the jump, continued beyond it, so that their interpolant
    /// shows when it arrives. Returns the lanes; fixed steps are never taken again.
    MYRIAD_FUNCTION mask locate(const accepted_step<Model, Method, S>& seen) const {
        const auto& y1 = seen.trial.y;
        mask crossed = mask(false);
        if (knows_arrivals()) return crossed;
        detail::for_each_lag<Model>([&](auto g, auto j) MYRIAD_LAMBDA {
            const S beyond = seen_beyond_jump(g, j, seen.t1, y1);
            crossed = crossed | (seen.accepted & (beyond > list_type::instant(s.h)));
        });
        if (!MYRIAD_UNLIKELY(any(crossed))) return crossed;
        const auto step = seen.inside(crossed);
        const auto beyond_at = [&](const S& theta) MYRIAD_LAMBDA {
            const auto y = detail::interpolate(step, theta);
            S most = S(-infinity_of<R>);
            detail::for_each_lag<Model>([&](auto g, auto j) MYRIAD_LAMBDA {
                most = larger(most, seen_beyond_jump(g, j, fma(theta, step.h, step.t), y));
            });
            return most;
        };
        const S at_start = beyond_at(S(R(0))), at_end = beyond_at(S(R(1)));
        // The time that is seen is known to a rounding of t, times how much faster than t it runs.
        const S rounding = S(epsilon_of<R>) * abs(seen.t1) * (S(R(1)) + abs(at_end - at_start) / s.h);
        crossed = crossed & (at_end > S(R(4)) * rounding);
        // The step ends a little beyond the jump, so that the next one does not begin before it.
        const S target = larger(S(R(0.02)) * list_type::instant(s.h), S(R(2)) * rounding);
        const auto before_target = [&](const S& theta, mask& close) MYRIAD_LAMBDA {
            const S before = target - beyond_at(theta);
            close = abs(before) <= S(R(0.5)) * target;
            return before;
        };
        bracket<S> between{S(R(0)), S(R(1)), target - at_start, target - at_end};
        // One that is not before its jump at the start has just seen it arrive.
        between.f_low = larger(between.f_low, S(R(1e-3)) * list_type::instant(s.h));
        const S theta = detail::find_root(between, crossed, before_target);
        const S least = S(resolved_roundings<R>) * abs(s.data.t);
        const S length = larger(theta * s.h, least);
        // The rest of a step that ends there already, as far as t is resolved, is none.
        crossed = crossed & ((s.data.t + length) - s.data.t < s.h - list_type::instant(s.h));
        s.data.h_next = select(crossed, length, s.data.h_next);
        s.breaks.redone = crossed;
        return crossed;
    }
    /// The nearest time, before `end`, at which steps of lane i have to end.
    static MYRIAD_FUNCTION R nearest(const integration_state<Model, Method, S>& s, int i, R end) {
        const R t = get_lane(s.data.t, i);
        detail::for_each_lag<Model>([&](auto g, auto) MYRIAD_LAMBDA {
            const R time = s.breaks.arrival[i][g];
            if (time > t && time < end) end = time;
        });
        return team_of_lags<Model>::smallest(end);
    }

    /// The longest step for which all times that it sees lie in the past.
    MYRIAD_FUNCTION S longest_step() const {
        S longest = S(infinity_of<R>);
        detail::for_each_lag<Model>([&](auto, auto j) MYRIAD_LAMBDA {
            const S lag = detail::lag_of<Model>(j, s.data.t, s.data.y, static_cast<const inputs<Model, S>&>(s.data));
            longest = select(lag > S(R(0)), smaller(longest, lag), longest);
        });
        return team_of_lags<Model>::smallest(longest);
    }

private:
    MYRIAD_FUNCTION lane_past<Model, R>& past(int i) const { return s.data.past.lane[i]; }
    MYRIAD_FUNCTION std::int32_t& place(int i, int c) const {
        return args.history.place[static_cast<std::int64_t>(c) * args.size + s.instance[i]];
    }
    /// How far beyond its next jump delayed value j, of lag g, sees at (t, y); before it the number is negative.
    MYRIAD_FUNCTION S seen_beyond_jump(int g, int j, const S& t, const vec<S, n_state<Model>>& y) const {
        const S time = t - detail::lag_of<Model>(j, t, y, static_cast<const inputs<Model, S>&>(s.data));
        S beyond = S(-infinity_of<R>);
        MYRIAD_UNROLL
        for (int i = 0; i < lanes_of<S>; ++i)
            if (past(i).before[g] != lane_past<Model, R>::none)
                set_lane(beyond, i, get_lane(time, i) - list().time_of_jump(i, past(i).before[g]));
        return beyond;
    }
    MYRIAD_FUNCTION void move_past(int i, R by) const {
        const std::int32_t oldest = s.data.past.oldest(i);
        if (team_for<Model>::leads()) {
            s.data.past.moved_of(i) += by;
            s.data.past.begin_of(i) += by;
            for (std::int32_t k = oldest > 0 ? oldest : 0; k <= past(i).steps; ++k) s.data.past.start_of(i, k) += by;
        }
        team_for<Model>::synchronise();  // all see it
    }
    /// Time runs forwards, lags are numbers from zero on, and no fixed step is longer than one that is constant.
    MYRIAD_FUNCTION bool lags_are_valid(int i) const {
        bool valid = get_lane(s.data.t_end, i) >= get_lane(s.data.t, i);
        const R least = is_adaptive<Method> || !knows_arrivals() ? R(0) : args.step * R(1 - 1e-6);
        detail::for_each_lag<Model>([&](auto, auto j) MYRIAD_LAMBDA {
            const R ago = list().lag(i, j);
            valid = valid && ago >= least && (ago > R(0) || !knows_arrivals());
        });
        return team_of_lags<Model>::all(valid);
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
