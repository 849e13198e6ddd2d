// SPDX-License-Identifier: MIT
// Jumps of the past for neighbouring solutions: of models with tangents or sensitivities, the list of jumps also has
// how much later each of them is for each neighbour, from which the jumps of their distances follow.
#pragma once

#include "myriad/kernel/model/recall.hpp"
#include "myriad/kernel/state/inside_step.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// The order of the derivative of a solution that does not jump, and of one that is to be found out.
inline constexpr int no_jump = 100, unknown_jump = -1;
/// The order of the derivative that jumps where delayed value j sees one of that order jump.
template <class Model>
MYRIAD_FUNCTION int level_of_arrival(int j, int jumped) {
    return is_delayed_slope<Model>(j) ? max(jumped, 1) : jumped + 1;
}

template <class Model, class Method, class S>
struct neighbour_jumps {
    using R = real_of<S>;

    /// How many neighbouring solutions the model follows.
    static constexpr int neighbours = jump_numbers<Model> != 0 ? jump_numbers<Model> - 1 : 0;

    integration_state<Model, Method, S>& s;

    /// Sets how much later neighbouring solutions have the jump of lane i that is marked next.
    MYRIAD_FUNCTION void set_later(int i, const vec<R, neighbours>& later) const {
        MYRIAD_UNROLL
        for (int c = 0; c < jump_numbers<Model>; ++c) set_lane(s.data.later[c], i, c > 0 ? later[c - 1] : R(0));
    }
    /// Notes those of the jump of lane i that is marked. Of two jumps at one instant, `merges`, the lower one counts;
    /// if the states themselves jump twice, at times that move differently, there are no derivatives.
    MYRIAD_FUNCTION void put(int i, std::int32_t number, int own, bool merges) const {
        const int before = merges ? static_cast<int>(jump_number(i, number, 0)) : no_jump;
        for (int c = 1; c < jump_numbers<Model>; ++c) {
            const R later = get_lane(s.data.later[c], i);
            R& kept = jump_number(i, number, c);
            if (own < before) {
                kept = later;
            } else if (own == 0 && before == 0 && kept != later) {
                kept = nan_of<R>;
            }
        }
        jump_number(i, number, 0) = static_cast<R>(min(own, before));
        set_later(i, {});
    }
    /// Lets the jumps that are due in lane i arrive, as `breaking_points::arrive`: where the slope of the model's own
    /// states jumps, the distances of neighbours do, and what is observed there has no derivatives. Returns the lowest
    /// orders of derivatives that jump, of all states and of the model's own.
    template <class List>
    MYRIAD_FUNCTION auto arrive(int i, const List& list) const {
        struct levels {
            int all = no_jump, own = no_jump;
        } lowest;
        using original = typename Model::original;
        constexpr int n = n_state<original>;
        const R t = get_lane(s.data.t, i);
        vec<R, n_state<Model>> y = get_lanes<R>(s.data.y, i);
        const auto evaluate = [&](inputs<Model, R>& p) MYRIAD_LAMBDA {
            p = detail::inputs_of_lane(s.data, i);
            detail::recall<Model>(t, y, p);
            return Model::own_slopes(t, y, p);
        };
        detail::for_each_lag<Model>([&](auto g, auto k) MYRIAD_LAMBDA {
            while (list.has_arrived(i, g, k)) {
                const std::int32_t number = list.next(i, g);
                const int arriving = level_of_arrival<Model>(k, static_cast<int>(jump_number(i, number, 0)));
                lowest.all = min(lowest.all, level_of_arrival<Model>(k, list.level_at(i, number)));
                lowest.own = min(lowest.own, arriving);
                inputs<Model, R> p;
                const vec<R, n> before = evaluate(p);
                vec<R, neighbours> later;
                static_for<0, neighbours>([&](auto d) MYRIAD_LAMBDA {
                    const R then = jump_number(i, number, 1 + d);
                    later[d] = Model::template later_arrival<decltype(d)::value>(k, t, y, p, before, then);
                });
                list.look_at(i, g, k, number + 1);
                if (arriving > 1) continue;
                [[maybe_unused]] vec<R, n_observed<original>> observed;
                if constexpr (has_summaries<Model>) observed = Model::own_quantities(t, y, p);
                const vec<R, n> after = evaluate(p);
                if constexpr (has_summaries<Model>) lose_summaries(i, observed, Model::own_quantities(t, y, p));
                for (int d = 0; d < neighbours; ++d)
                    for (int c = 0; c < n; ++c)
                        y[n * (1 + d) + c] = fma(before[c] - after[c], later[d], y[n * (1 + d) + c]);
                set_later(i, later);
                lowest.all = 0;
            }
        });
        set_lanes(s.data.y, i, y);
        return lowest;
    }

private:
    /// Of a jump in the list: the order of the derivative of the model's own states that jumps, then how much later the
    /// jump is in each neighbouring solution.
    MYRIAD_FUNCTION R& jump_number(int i, std::int32_t number, int c) const {
        return s.data.past.jump_number(i, number, c);
    }
    /// Derivatives of summaries of quantities that jump there are not known.
    MYRIAD_FUNCTION void lose_summaries(int i, const auto& before, const auto& after) const {
        using original = typename Model::original;
        static_for<0, n_summary<original>>([&](auto r) MYRIAD_LAMBDA {
            constexpr auto what = summary_at<original, decltype(r)::value>;
            if (before[what.quantity] == after[what.quantity]) return;
            for (int d = 0; d < neighbours; ++d)
                set_lane(s.data.accessory[(1 + d) * n_accessory<original> + what.accessory], i, nan_of<R>);
        });
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
