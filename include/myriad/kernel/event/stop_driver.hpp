// SPDX-License-Identifier: MIT
// The stop times of a model: finds the next, which no step passes, and calls actions there. No root is sought: a step
// that comes near ends at the very time, as at t_end. It works on one lane at a time, at the start of phases, at stops
// and after hooks.
#pragma once

#include <limits>

#include "myriad/kernel/core/static_for.hpp"
#include "myriad/kernel/event/breaking_points.hpp"
#include "myriad/kernel/model/hooks.hpp"
#include "myriad/kernel/state/integration_state.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

template <class Model, class Method, class S>
struct stop_driver {
    using R = real_of<S>;
    using mask = mask_of<S>;
    static constexpr auto kinds = n_stop<Model>;

    const kernel_arguments<Model, R>& args;
    integration_state<Model, Method, S>& s;

    /// Starts a phase of lane i at its time: finds the first stop of each kind from there on, or after it if the phase
    /// `continues` the last one, which has called the actions at its end.
    MYRIAD_FUNCTION void begin(int i, bool continues) const {
        const R t = get_lane(s.data.t, i);
        s.stops.backwards[i] = get_lane(s.data.t_end, i) < t;
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(kinds); ++j) {
            s.stops.number[i][j] = 0;
            s.stops.acted[i][j] = continues ? t : never;
        }
        find_next(i);
    }
    /// Finds the next stops of lane i again, after a hook. Returns whether steps now have to end elsewhere.
    MYRIAD_FUNCTION bool update(int i) const {
        const R t = get_lane(s.data.t, i), t_end = get_lane(s.data.t_end, i), before = get_lane(s.stops.next, i);
        if (t != t_end) s.stops.backwards[i] = t_end < t;
        find_next(i);
        return get_lane(s.stops.next, i) != before;
    }

    /// The lanes that may have reached a stop.
    MYRIAD_FUNCTION mask due() const { return s.running() & (s.data.t == s.stops.next); }

    /// Calls `action(kind, number)` for each stop of lane i at its time: the next of each kind in order of the kinds,
    /// again if more are due. Returns `event_accumulation` if there are more than `options::accumulation_limit`
    /// allows.
    template <class Action>
    [[nodiscard]] MYRIAD_FUNCTION status act(int i, Action&& action) const {
        const R t = get_lane(s.data.t, i);
        status ending = status::success;
        for (std::int32_t rounds = 0;; ++rounds) {
            bool acted = false;
            const auto act_on = [&](auto j) MYRIAD_LAMBDA {
                std::int32_t& next = s.stops.number[i][j];
                const std::int32_t number = next;
                if (time_of(detail::inputs_of_lane(s.data, i), j, number) != t) return;
                if (rounds >= detail::most_actions(args)) {
                    ending = status::event_accumulation;
                    return;
                }
                next = number < most ? number + 1 : most;
                s.stops.acted[i][j] = t;
                action(j, number);
                acted = true;
            };
            if constexpr (kinds > MYRIAD_MOST_COPIES) {
                for (int j = 0; j < MYRIAD_LENGTH(kinds); ++j) act_on(j);
            } else {
                static_for<0, kinds>(act_on);
            }
            update(i);
            if (!acted) return ending;
        }
    }

private:
    static constexpr std::int32_t most = std::numeric_limits<std::int32_t>::max();
    static constexpr R never = infinity_of<R>;  // at which no stop acts

    static MYRIAD_FUNCTION R time_of(const inputs<Model, R>& p, int j, std::int32_t number) {
        return Model::template stop_time<R>(j, number, p);
    }

    /// Passes over stops that are over, and sets the nearest of the others, up to t_end. A time that is not finite is
    /// the end of a kind's stops.
    MYRIAD_FUNCTION void find_next(int i) const {
        const R t = get_lane(s.data.t, i), t_end = get_lane(s.data.t_end, i);
        R nearest = t_end;
        if constexpr (has_stops<Model>) {
            const auto& p = detail::inputs_of_lane(s.data, i);
            MYRIAD_UNROLL
            for (int j = 0; j < MYRIAD_LENGTH(kinds); ++j) {
                pass_over(p, i, j, t);
                const R time = time_of(p, j, s.stops.number[i][j]);
                const bool nearer = t <= t_end ? time >= t && time < nearest : time <= t && time > nearest;
                if (is_finite(time) && nearer) nearest = time;
            }
        }
        if constexpr (has_delays<Model>) nearest = breaking_points<Model, Method, S>::nearest(s, i, nearest);
        set_lane(s.stops.next, i, nearest);
    }
    /// Sets the number of the next stop of kind j in lane i: the first, from that before it on, whose time is still to
    /// come. Where a hook has set the last one's time anew, the first of all is sought; of its times that are now,
    /// those at which the kind has acted are over.
    MYRIAD_FUNCTION void pass_over(const inputs<Model, R>& p, int i, int j, R t) const {
        std::int32_t& number = s.stops.number[i][j];
        R& acted = s.stops.acted[i][j];
        const bool backwards = s.stops.backwards[i], acted_now = acted == t;
        const auto has_passed = [&](R time) MYRIAD_LAMBDA { return backwards ? time > t : time < t; };
        const auto is_done = [&](R time) MYRIAD_LAMBDA { return has_passed(time) || (acted_now && time == t); };
        bool from_first = number == 0;
        if (number > 0) {
            const R last = time_of(p, j, number - 1);
            from_first = is_finite(last) && !is_done(last);
            if (last != t) acted = never;
        }
        if (from_first) {
            number = first_to_come(p, j, 0, is_done);
            acted = acted_now && number > 0 && time_of(p, j, number - 1) == t ? t : never;
        } else {
            number = first_to_come(p, j, number, has_passed);
        }
    }
    /// The number of the first stop of kind j, from `number` on, that is not over. Times do not decrease in the
    /// direction of the integration: strides that double, then bisection.
    template <class Over>
    static MYRIAD_FUNCTION std::int32_t first_to_come(const inputs<Model, R>& p, int j, std::int32_t number,
                                                      const Over& over) {
        const auto is_over = [&](std::int32_t k) MYRIAD_LAMBDA {
            const R time = time_of(p, j, k);
            return is_finite(time) && over(time);
        };
        if (!MYRIAD_UNLIKELY(is_over(number))) return number;
        std::int32_t low = number, high = most;
        for (std::int32_t stride = 1; stride < most - low; stride += stride) {
            if (!is_over(low + stride)) {
                high = low + stride;
                break;
            }
            low += stride;
            if (stride > most / 2) break;
        }
        while (high - low > 1) {
            const std::int32_t middle = low + (high - low) / 2;
            (is_over(middle) ? low : high) = middle;
        }
        return high;
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
