// SPDX-License-Identifier: MIT
// What is known of the conditions of triggers. Only in kernels of models with triggers.
#pragma once

#include "myriad/kernel/event/lane_sides.hpp"
#include "myriad/kernel/model/event_signs.hpp"
#include "myriad/kernel/model/hooks.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// Empty for a model without triggers.
template <class Model, class S, bool triggers = has_triggers<Model>>
struct trigger_state {};
template <class Model, class S>
struct trigger_state<Model, S, true> {
    mask_set<mask_of<S>, n_event<Model>> seen;              // functions that were positive when it was last looked at
    mask_set<bool, n_trigger<Model>> holds[lanes_of<S>];    // conditions that held then
    mask_set<bool, n_trigger<Model>> pending[lanes_of<S>];  // that have come to hold and whose actions are to be called
};

/// The conditions of one lane's triggers.
template <class Model, class Method, class S>
struct trigger_conditions {
    using R = real_of<S>;
    static constexpr int m = n_event<Model>;
    static constexpr int triggers = n_trigger<Model>;

    lane_sides<Model, Method, S> sides;
    trigger_state<Model, S>& t;

    /// Starts a phase of lane i. In the first, conditions that count as false before it come to hold, if they do.
    MYRIAD_FUNCTION void begin(int i) const {
        const auto& own = sides.memory_of(i);
        const vec<R, m> g = detail::evaluate_events<Model>(get_lane(sides.s.now(), i), get_lanes<R>(sides.s.data.y, i),
                                                           sides.inputs_of(i));
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            const bool unknown = own.open[j] && !own.held[j];
            t.seen.set(j, i, unknown ? !(g[j] < R(0)) : sides.e.above.get(j, i));
        }
        const auto now = conditions(i);
        t.holds[i] = now;
        t.pending[i].clear();
        if (get_lane(sides.s.data.phase, i) > 0) return;
        for (int j = 0; j < triggers; ++j) t.pending[i].set(j, now[j] && !holds_before_start(j));
    }
    /// Looks at the functions of lane i again. One on its surface whose side is not yet known keeps the last.
    MYRIAD_FUNCTION void update(int i) const {
        const auto& own = sides.memory_of(i);
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j)
            if (!own.open[j]) t.seen.set(j, i, sides.e.above.get(j, i));
        const auto now = conditions(i);
        t.pending[i] = t.pending[i] | (now & ~t.holds[i]);
        for (int j = 0; j < triggers; ++j)
            if (!now[j] && !persists(j)) t.pending[i].set(j, false);
        t.holds[i] = now;
    }
    /// The lanes in which a function may have changed sides. In a lane that redoes its step nothing has happened yet.
    MYRIAD_FUNCTION mask_of<S> turned() const {
        const auto& e = sides.e;
        return sides.s.running() & (e.above ^ t.seen).any_of() & !e.flags[e.locating];
    }

private:
    // Not in lambdas, where nvcc takes every such branch.
    static MYRIAD_FUNCTION bool holds_before_start(int trigger) {
        if constexpr (requires { Model::initial_value(0); }) {
            return Model::initial_value(trigger);
        } else {
            return true;
        }
    }
    static MYRIAD_FUNCTION bool persists(int trigger) {
        if constexpr (requires { Model::persistent(0); }) {
            return Model::persistent(trigger);
        } else {
            return true;
        }
    }
    MYRIAD_FUNCTION mask_set<bool, triggers> conditions(int i) const {
        const event_signs<m> positive(t.seen.of_lane(i));
        mask_set<bool, triggers> now;
        now.clear();
        static_for<0, triggers>([&](auto j) MYRIAD_LAMBDA { now.set(j, Model::condition(j, positive)); });
        return now;
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
