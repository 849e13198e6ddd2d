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
    // The event function whose change of side has made a pending trigger's condition hold; -1: an action has.
    vec<std::int32_t, triggers_know_their_function<Model> ? n_trigger<Model> : 0> function[lanes_of<S>];
    // The functions whose crossings were located at this instant.
    mask_set<mask_of<S>, triggers_know_their_function<Model> ? n_event<Model> : 0> located;
};

/// The conditions of one lane's triggers.
template <class Model, class Method, class S>
struct trigger_conditions {
    using R = real_of<S>;
    static constexpr auto m = n_event<Model>;
    static constexpr auto triggers = n_trigger<Model>;

    lane_sides<Model, Method, S> sides;
    trigger_state<Model, S>& t;

    /// Starts a phase of lane i. In the first, conditions that count as false before it come to hold, if they do.
    MYRIAD_FUNCTION void begin(int i) const {
        look(i);
        if constexpr (triggers_know_their_function<Model>) t.located.set_of_lane(i, mask_set<bool, m>{});
        const auto now = conditions(i);
        t.holds[i] = now;
        t.pending[i].clear();
        if (get_lane(sides.s.data.phase, i) > 0) return;
        for (int j = 0; j < MYRIAD_LENGTH(triggers); ++j) {
            t.pending[i].set(j, now[j] && !holds_before_start(j));
            if constexpr (triggers_know_their_function<Model>) t.function[i][j] = -1;
        }
    }
    /// Looks at the functions of lane i again.
    MYRIAD_FUNCTION void update(int i) const {
        const auto before = t.seen.of_lane(i);
        look(i);
        const auto now = conditions(i);
        if constexpr (triggers_know_their_function<Model>) {
            for (int j = 0; j < MYRIAD_LENGTH(triggers); ++j)
                if (now[j] && !t.holds[i][j])
                    t.function[i][j] = turning(i, j, t.located.of_lane(i) & (before ^ t.seen.of_lane(i)));
        }
        t.pending[i] = t.pending[i] | (now & ~t.holds[i]);
        for (int j = 0; j < MYRIAD_LENGTH(triggers); ++j)
            if (!now[j] && !persists(j)) t.pending[i].set(j, false);
        t.holds[i] = now;
    }
    /// The lanes in which a function may have changed sides. In a lane that redoes its step nothing has happened yet.
    MYRIAD_FUNCTION mask_of<S> turned() const {
        const auto& e = sides.e;
        return sides.s.running() & ((e.above ^ t.seen).any_of() | e.flags[e.in_question]) & !e.flags[e.locating];
    }
    /// Gives functions of lane i that are on their surface the sides to which they go. Returns whether there were any.
    MYRIAD_FUNCTION bool settle(int i) const {
        if (!unknown(i).any_of()) return false;
        auto& s = sides.s;
        const R now = get_lane(s.now(), i), sense = sign_of(get_lane(s.data.t_end, i) - now);
        const auto& p = sides.inputs_of(i);
        const vec<R, m> slope = detail::event_slopes<Model>(now, get_lanes<R>(s.data.y, i), s.slope_of(i), p);
        bool any = false;
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) {
            if (!unknown(i)[j] || !detail::tells_heading(slope[j])) continue;
            sides.put_side(j, i, sign_of(slope[j]) * sense);
            any = true;
        }
        sides.update_in_question(i);
        return any;
    }

private:
    /// The functions of lane i on their surface, at the start or where a hook put them, whose side is not yet known.
    MYRIAD_FUNCTION auto unknown(int i) const {
        const auto& own = sides.memory_of(i);
        return own.open & ~own.held;
    }
    /// Notes which functions of lane i are positive; zero counts as positive.
    MYRIAD_FUNCTION void look(int i) const {
        const auto on_surface = unknown(i);
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) t.seen.set(j, i, on_surface[j] || sides.e.above.get(j, i));
    }
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
    /// The function among these that has made a condition hold, which would not without it; else any; else -1.
    MYRIAD_FUNCTION std::int32_t turning(int i, int trigger, const mask_set<bool, m>& turned) const {
        std::int32_t found = -1;
        for (int f = 0; f < MYRIAD_LENGTH(m); ++f) {
            if (!turned[f]) continue;
            auto without = t.seen.of_lane(i);
            without.set(f, !without[f]);
            if (!Model::condition(trigger, event_signs<m>(without))) return f;
            found = f;
        }
        return found;
    }
    MYRIAD_FUNCTION mask_set<bool, triggers> conditions(int i) const {
        const event_signs<m> positive(t.seen.of_lane(i));
        mask_set<bool, triggers> now;
        now.clear();
        if constexpr (triggers > MYRIAD_MOST_COPIES) {
            for (int j = 0; j < MYRIAD_LENGTH(triggers); ++j) now.set(j, Model::condition(j, positive));
        } else {
            static_for<0, triggers>([&](auto j) MYRIAD_LAMBDA { now.set(j, Model::condition(j, positive)); });
        }
        return now;
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
