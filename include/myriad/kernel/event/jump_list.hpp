// SPDX-License-Identifier: MIT
// The list of jumps of a model with delays: where the solution, or a derivative of it, jumped, in the order of time,
// and for each lag the next of them to arrive. A jump is a step of length zero in the ring of the past.
#pragma once

#include "myriad/kernel/event/neighbour_jumps.hpp"
#include "myriad/kernel/model/recall.hpp"
#include "myriad/kernel/state/inside_step.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

template <class Model, class Method, class S>
struct jump_list {
    using R = real_of<S>;

    /// Whether the times at which jumps arrive are known in advance; and whether steps end there, which fixed ones do
    /// only then.
    static MYRIAD_FUNCTION bool knows_arrivals() { return detail::lags_are_constant<Model, R>(); }
    static MYRIAD_FUNCTION bool tracks() { return is_adaptive<Method> || knows_arrivals(); }
    static constexpr bool has_neighbours = jump_numbers<Model> != 0;
    static_assert(is_adaptive<Method> || has_constant_lags<Model, R> || !has_neighbours,
                  "tangents and sensitivities of a model whose lags depend on time or state need an adaptive method, "
                  "whose steps end where jumps of the past arrive");

    const kernel_arguments<Model, R>& args;
    integration_state<Model, Method, S>& s;

    /// The number of the next jump of lane i that arrives by lag g.
    MYRIAD_FUNCTION std::int32_t next(int i, int g) const { return s.breaks.next[i][g]; }
    MYRIAD_FUNCTION int level_at(int i, std::int32_t number) const { return static_cast<int>(entry(i, number) & 0xf); }
    /// Whether the next jump of lane i by lag g, which delayed value j has, has arrived.
    MYRIAD_FUNCTION bool has_arrived(int i, int g, int j) const {
        const R t = get_lane(s.data.t, i);
        if (knows_arrivals()) {
            return has_come(s.breaks.arrival[i][g], t);
        } else {
            if (s.breaks.next[i][g] >= s.breaks.listed[i]) return false;
            const R close = instant(s.data.past.last_length(i)) + resolved_roundings<R> * abs(t);
            return t - lag(i, j) >= time_of_jump(i, past(i).before[g]) - close;
        }
    }
    /// Whether a time has come, up to its rounding.
    static MYRIAD_FUNCTION bool has_come(R time, R t) { return time <= t + resolved_roundings<R> * abs(t); }
    /// How long ago delayed value j of lane i is now.
    MYRIAD_FUNCTION R lag(int i, int j) const {
        const auto& p = detail::inputs_of_lane(s.data, i);
        return detail::lag_of<Model>(j, get_lane(s.data.t, i), get_lanes<R>(s.data.y, i),
                                     static_cast<const inputs<Model, R>&>(p));
    }
    /// The time of the jump at step k; that of the beginning is known even when the ring no longer has the step.
    MYRIAD_FUNCTION R time_of_jump(int i, std::int32_t k) const {
        return k == 0 ? s.data.past.begin_of(i) : s.data.past.start_of(i, k);
    }

    /// How near to a jump the end of a step of length h is at it.
    template <class T>
    static MYRIAD_FUNCTION T instant(const T& h) {
        return T(std::is_same_v<R, float> ? R(1e-3) : R(1e-6)) * abs(h);
    }

    /// Whether the last step of lane i is one of length zero, at a jump that is listed.
    MYRIAD_FUNCTION bool ends_at_jump(int i) const {
        const std::int32_t listed = s.breaks.listed[i];
        return listed > 0 && step_of(i, listed - 1) == past(i).steps - 1;
    }
    /// The next step begins at a jump of the derivative of that order: a step of length zero lies before it.
    MYRIAD_FUNCTION void mark(int i, int level, [[maybe_unused]] int own = unknown_jump) const {
        past(i).resumes = true;
        if (!tracks()) return;
        std::int32_t& listed = s.breaks.listed[i];
        if constexpr (has_neighbours) {
            if (own == unknown_jump) own = level > 0 ? level : differs_from_past(i, Model::n_original) ? 0 : 1;
        }
        const bool merges = ends_at_jump(i);
        if (merges) {
            level = min(level, level_at(i, listed - 1));
            --listed;
        } else {
            ++past(i).steps;
            s.data.past.start_of(i, past(i).steps) = get_lane(s.data.past.reached, i);
            past(i).begins = true;
        }
        put_state(i);
        put_entry(i, listed, past(i).steps - 1, level);
        if constexpr (has_neighbours) neighbour_jumps<Model, Method, S>{s}.put(i, listed, own, merges);
        ++listed;
        detail::for_each_lag<Model>([&](auto g, auto j) MYRIAD_LAMBDA {
            if (s.breaks.next[i][g] == listed - 1) look_at(i, g, j, listed - 1);
        });
        team_for<Model>::synchronise();  // all see the state that the others have put there
    }
    /// What lane i sees by lag g, as delayed value j, lies before the jump of that number, and not before the one
    /// before it.
    template <class G>
    MYRIAD_FUNCTION void look_at(int i, G g, int j, std::int32_t number) const {
        const bool there = number < s.breaks.listed[i];
        const bool one_before = number > 0 && s.breaks.listed[i] - number < args.history.slots;
        s.breaks.next[i][g] = number;
        past(i).forget_lag(g);
        s.breaks.arrival[i][g] = knows_arrivals() && there ? arrival_of(i, j, number) : infinity_of<R>;
        past(i).before[g] = there ? step_of(i, number) : lane_past<Model, R>::none;
        past(i).from[g] = knows_arrivals() && one_before ? step_of(i, number - 1) + 1 : -1;
    }
    /// Finds the next jump of each lag in lane i.
    MYRIAD_FUNCTION void find_next(int i) const {
        const R t = get_lane(s.data.t, i);
        detail::for_each_delayed<Model>([&](auto j) MYRIAD_LAMBDA { past(i).seen[j].number = past(i).steps - 1; });
        past(i).forget();
        detail::for_each_lag<Model>([&](auto g, auto j) MYRIAD_LAMBDA {
            if (tracks()) {
                const std::int32_t listed = s.breaks.listed[i], oldest = listed - args.history.slots;
                std::int32_t number = oldest > 0 ? oldest : 0;
                const auto is_over = [&](std::int32_t at) MYRIAD_LAMBDA {
                    const bool kept = step_of(i, at) == 0 || step_of(i, at) >= s.data.past.oldest(i);
                    return !kept || has_come(arrival_of(i, j, at), t);
                };
                while (number < listed && is_over(number)) ++number;
                look_at(i, g, j, number);
            } else {
                s.breaks.arrival[i][g] = infinity_of<R>;
                past(i).before[g] = lane_past<Model, R>::none;
                past(i).from[g] = -1;
            }
        });
    }
    /// Whether the state, or the first so many states, are not those at the end of the last step.
    MYRIAD_FUNCTION bool differs_from_past(int i, int first = MYRIAD_LENGTH(n_state<Model>)) const {
        past_view<Model, S>& all = s.data.past;
        const bool by_slopes = all.terms == 2;
        R* const step = all.step_of(i, past(i).steps - (by_slopes ? 0 : 1));
        bool differs = false;
        all.for_each_kept([&](auto place, int state) MYRIAD_LAMBDA {
            R end = R(0), size = R(0);
            for (int power = 0; power < (by_slopes ? 1 : all.terms); ++power) {
                const R term = all.terms_of(step, place)[power * all.stride];
                end += term;
                size += abs(term);
            }
            const R moved = abs(end - get_lane(s.data.y[state], i));
            differs = differs || (state < first && !(moved <= R(64) * epsilon_of<R> * size));
        });
        return team_for<Model>::any(differs);
    }

private:
    MYRIAD_FUNCTION lane_past<Model, R>& past(int i) const { return s.data.past.lane[i]; }
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
    MYRIAD_FUNCTION void put_entry(int i, std::int32_t number, std::int32_t step, int level) const {
        entry(i, number) = static_cast<std::uint32_t>(step) << level_bits | static_cast<std::uint32_t>(level);
    }
    MYRIAD_FUNCTION R arrival_of(int i, int j, std::int32_t number) const {
        return time_of_jump(i, step_of(i, number)) + lag(i, j);
    }
    /// The step of length zero before the next one has the state of lane i as it is: what is seen of the present.
    MYRIAD_FUNCTION void put_state(int i) const {
        past_view<Model, S>& all = s.data.past;
        R* const step = all.step_of(i, past(i).steps - (all.terms == 2 ? 0 : 1));
        all.for_each_kept([&](auto place, int state) MYRIAD_LAMBDA {
            R* const to = all.terms_of(step, place);
            to[0] = get_lane(s.data.y[state], i);
            for (int power = 1; power < all.terms; ++power) to[power * all.stride] = R(0);
        });
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
