// SPDX-License-Identifier: MIT
// The events of a pack: owns the sides of the event functions and the events that fired, and offers the loop, the hooks
// and the phases all that they need of events.
#pragma once

#include <cstdint>

#include "myriad/kernel/event/bridge_driver.hpp"
#include "myriad/kernel/event/detector.hpp"
#include "myriad/kernel/event/event_detection.hpp"
#include "myriad/kernel/event/fired_events.hpp"
#include "myriad/kernel/event/locator.hpp"
#include "myriad/kernel/event/side_tracker.hpp"
#include "myriad/kernel/event/trigger_state.hpp"
#include "myriad/kernel/stepper/step.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

template <class Model, class Method, class S>
class event_driver {
public:
    using R = real_of<S>;
    using mask = mask_of<S>;
    static constexpr auto m = n_event<Model>;
    using values = vec<S, m>;  // of the event functions in all lanes
    using masks = mask_set<mask, m>;
    using trial_type = trial_step<Method, S, n_state<Model>>;
    using detection = event_detection<S, m>;
    using locator = event_locator<Model, Method, S>;
    using detector = event_detector<Model, Method, S>;
    using tracker = side_tracker<Model, Method, S>;

    /// `memory` is outside the loop's own state, which is in registers.
    MYRIAD_FUNCTION event_driver(const kernel_arguments<Model, R>& args, integration_state<Model, Method, S>& s,
                                 event_memories<Model, R, lanes_of<S>>* memory)
        : args_(args), s_(s), memory_(memory), e_{}, fired_{}, triggers_{} {}

    /// For lanes that are still empty.
    MYRIAD_FUNCTION void clear() {
        if constexpr (m > 0) {
            fired_.clear();
            e_.clear();
        }
    }

    // Phases
    /// Takes the sides of an instance that is new in lane i from where an earlier call has kept them.
    MYRIAD_FUNCTION void load(int i) { tracker{sides()}.load(i); }
    /// Starts phases with the sides that the previous ones left.
    MYRIAD_FUNCTION void begin(const mask& lanes) {
        for_each_lane(lanes, [&](int i) MYRIAD_LAMBDA { tracker{sides()}.begin(i); });
    }
    /// Stores the sides of lane i for its next phase.
    MYRIAD_FUNCTION void store(int i) {
        if (e_.flags.get(e_.locating, i)) event_location<Model, Method, S>{sides()}.end(i);
        tracker{sides()}.store(i);
    }
    /// Makes the next phase of lane i begin with all sides unknown.
    MYRIAD_FUNCTION void reset(int i) { tracker{sides()}.reset(i); }

    // Trial steps
    /// The lanes that redo their step, to end at an event.
    MYRIAD_FUNCTION mask locating() const {
        if constexpr (m > 0) {
            return e_.flags[e_.locating];
        } else {
            return mask(false);
        }
    }
    /// What the event functions g1 at the end of a trial show, whether it will be accepted or not.
    MYRIAD_FUNCTION detection detect(const values& g1) { return detector{sides()}.detect(g1); }
    /// Whether the location of an event begins with this trial, rather than goes on.
    MYRIAD_FUNCTION mask begins(const detection& detected) const {
        return detected.to_locate & !e_.flags[e_.in_question];
    }
    /// How many turns of the loop a thread has waited for events of its warp's other threads. The loop counts them.
    MYRIAD_FUNCTION std::int32_t& turns_waited() { return memory_->lane[0].waited; }
    /// The lanes in which all event functions are defined at both ends of the trial.
    MYRIAD_FUNCTION mask defined(const detection& detected) const {
        mask lanes = !e_.flags[e_.undefined];
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) lanes = lanes & (detected.g1[j] == detected.g1[j]);
        return lanes;
    }

    /// Locates events in accepted trials that end at t1. Lanes that crossed, or stopped short of their target, are set
    /// up for a redone step and removed from `accepted`. Events that fired did so at the end of the trial or, in lanes
    /// removed from `accepted`, at its start.
    MYRIAD_FUNCTION void locate(const trial_type& trial, const S& t1, const detection& detected, mask& accepted) {
        if constexpr (is_pack<S>) {
            fired_.which.clear();  // a pack's values lie in memory
            fired_.changed = mask(false);
        } else {
            fired_.clear();
        }
        const mask candidates = s_.running() & detected.to_locate;
        mask follow = accepted & !candidates;
        if (is_pack<S> || MYRIAD_UNLIKELY(any(candidates | detected.crossed.any_of()))) {
            if (MYRIAD_UNLIKELY(any(candidates))) {
                const trial_ends<Model, S> ends = ends_of(trial, t1, detected.g1);
                if constexpr (is_pack<S>) {
                    // Copies, so that only these need an address and the caller's variables stay in registers.
                    mask still_accepted = accepted;
                    locator{sides()}.locate_lanes(candidates, ends, detected, still_accepted, fired_);
                    accepted = still_accepted;
                } else {
                    if (accepted) {
                        const trial_outcome outcome = locator{sides()}.locate(0, ends, detected, fired_);
                        accepted = outcome != trial_outcome::is_redone;
                        follow = outcome == trial_outcome::stands_before_sides;
                    } else {
                        locator{sides()}.stop_locating(0);
                    }
                }
            }
            detector{sides()}.change_sides(follow, detected, fired_.which);
        }
        e_.left = e_.left | masks::all_in(follow);
        if constexpr (triggers_know_their_function<Model>) triggers_.located = fired_.which;
    }
    /// The lanes in which an event fired in this turn of the loop.
    MYRIAD_FUNCTION mask fired_lanes() const {
        if constexpr (m > 0) {
            return fired_.which.any_of();
        } else {
            return mask(false);
        }
    }
    /// Whether event j fired in lane i in this turn of the loop.
    MYRIAD_FUNCTION bool has_fired(int j, int i) const { return fired_.which.get(j, i); }

    // Hooks
    /// Counts an action of event j in lane i; returns how many in a row have not moved its function off its surface.
    MYRIAD_FUNCTION std::int32_t count_action(int j, int i) {
        auto& lingered = sides().memory_of(i).lingered[j];
        lingered = e_.left.get(j, i) ? 1 : lingered + 1;
        return lingered;
    }
    /// A hook has changed inputs of event functions, whose values were `before`.
    MYRIAD_FUNCTION void update_after_hook(const mask& lanes, const values& before) {
        fired_.changed = fired_.changed | lanes;
        tracker{sides()}.update_after_hook(lanes, before, fired_);
    }
    /// The same of a hook that was called at events.
    MYRIAD_FUNCTION void update_after_hook(const mask& lanes) { update_after_hook(lanes, fired_.value); }
    /// The actions of the events of lane i are done; `before` is the data before them.
    MYRIAD_FUNCTION void update_after_events(int i, const lane_data<Model, S>& before) {
        tracker{sides()}.update_after_events(i, fired_, before);
    }

    /// The actions of the events that fired are done.
    MYRIAD_FUNCTION void forget_fired() { fired_.clear(); }

    /// The triggers of lane i whose actions are to run.
    MYRIAD_FUNCTION auto& pending_triggers(int i) { return triggers_.pending[i]; }
    /// The event function that made a pending trigger of lane i fire, or -1.
    MYRIAD_FUNCTION int function_of(int trigger, int i) const { return triggers_.function[i][trigger]; }
    /// The conditions of the model's triggers.
    MYRIAD_FUNCTION trigger_conditions<Model, Method, S> conditions() { return {sides(), triggers_}; }

private:
    MYRIAD_FUNCTION lane_sides<Model, Method, S> sides() { return {args_, s_, e_, memory_}; }

    MYRIAD_FUNCTION trial_ends<Model, S> ends_of(const trial_type& trial, const S& t1, const values& g1) const {
        trial_ends<Model, S> ends{t1, trial.y, trial.slope_start(), {}, g1};
        if constexpr (Method::first_same_as_last) ends.slope_end = trial.slope_end();
        return ends;
    }

    const kernel_arguments<Model, R>& args_;
    integration_state<Model, Method, S>& s_;
    event_memories<Model, R, lanes_of<S>>* memory_;
    event_sides<Model, S> e_;
    fired_events<Model, S> fired_;
    trigger_state<Model, S> triggers_;
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
