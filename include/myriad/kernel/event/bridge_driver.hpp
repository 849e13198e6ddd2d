// SPDX-License-Identifier: MIT
// The events of a pack on noisy paths, behind the interface of `event_driver`. A path is too rough for signs at the
// ends of a step to tell what happened in between, and after an event it is at zero again at once: what decides are the
// laws of the Brownian bridge, and sides are not remembered.
#pragma once

#include <cstdint>

#include "myriad/kernel/event/bridge_locator.hpp"
#include "myriad/kernel/event/fired_events.hpp"
#include "myriad/kernel/state/integration_state.hpp"
#include "myriad/kernel/stepper/step.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

template <class Model, class Method, class S>
class event_driver;

template <class Model, class Method, class S>
requires(stochastic_method<Method>&& has_events<Model>) class event_driver<Model, Method, S> {
public:
    using R = real_of<S>;
    using mask = mask_of<S>;
    static constexpr auto n = n_state<Model>;
    static constexpr auto m = n_event<Model>;
    using values = vec<S, m>;  // of the event functions in all lanes
    using masks = mask_set<mask, m>;
    using flags = mask_set<bool, m>;  // in one lane
    using trial_type = trial_step<Method, S, n>;
    using memories = event_memories<Model, R, lanes_of<S>>;

    /// The event functions at the ends of a trial.
    struct detection {
        values g0, g1, rate;
        masks crossed;  // they have been at zero in between
    };

    MYRIAD_FUNCTION event_driver(const kernel_arguments<Model, R>& args, integration_state<Model, Method, S>& s,
                                 memories* memory)
        : args_(args), s_(s), memory_(memory), open_{}, left_{}, undefined_{}, stuck_{}, fired_{} {}

    MYRIAD_FUNCTION void clear() {
        open_.clear();
        left_.clear();
        undefined_ = stuck_ = mask(false);
        fired_.clear();
    }

    // Phases. None of them leaves anything to the next.
    MYRIAD_FUNCTION void load(int) {}
    MYRIAD_FUNCTION void store(int) {}
    MYRIAD_FUNCTION void reset(int) {}
    MYRIAD_FUNCTION void begin(const mask& lanes) {
        for_each_lane(lanes, [&](int i) MYRIAD_LAMBDA {
            memory_->lingered[i] = {};
            set_lane(undefined_, i, false);
            left_.set_of_lane(i, flags::all_in(true));
            look(i, flags::all_in(true), vec<R, m>{});
        });
    }

    // Trial steps
    /// No step is redone.
    MYRIAD_FUNCTION mask locating() const { return mask(false); }
    /// Which event functions have been at zero in the trial, from the side that is asked for.
    MYRIAD_FUNCTION detection detect(const values& g1) const {
        const moved_events<Model, S> start = detail::events_with_noise<Model>(s_.now(), s_.data.y, s_.data);
        detection found{start.g, g1, start.rate, {}};
        const masks falling = masks::from_bits(args_.falling), rising = masks::from_bits(args_.rising);
        const S zero = S(R(0)), length = abs(s_.h);
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) {
            const S variance = start.rate[j] * length;
            const mask below = start.g[j]<zero, above = start.g[j]> zero;
            const mask asked = ((falling[j] & above) | (rising[j] & below)) & !open_[j];
            mask crossed = asked & detail::bridge_crosses(start.g[j], g1[j], variance, S(R(most_squares<R>)));
            const mask same_side = crossed & (start.g[j] * g1[j] > zero);
            if (MYRIAD_UNLIKELY(any(same_side))) {  // as near as it may have crossed
                const auto z = detail::bridge_normals<S>(s_.steps.interval(args_.noise), bridge_draw::crossing, j);
                const S squares = fma(z[0], z[0], z[1] * z[1]);
                crossed = crossed & detail::bridge_crosses(start.g[j], g1[j], variance, squares);
            }
            found.crossed.set(j, crossed);
        }
        return found;
    }
    /// The lanes in which all event functions are defined at both ends of the trial, with their derivatives along the
    /// noise, and that may go on.
    MYRIAD_FUNCTION mask defined(const detection& detected) const {
        mask lanes = !(undefined_ | stuck_);
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j)
            lanes = lanes & (detected.g1[j] == detected.g1[j]) & is_finite(detected.rate[j]);
        return lanes;
    }
    /// Whether an event function of lane i is at zero, where noise makes it cross again at once, and so without end.
    MYRIAD_FUNCTION bool is_stuck(int i) const { return get_lane(stuck_, i); }

    /// Lets accepted trials end at their first event, if they have one.
    MYRIAD_FUNCTION void locate(trial_type& trial, const S&, const detection& detected, const mask& accepted) {
        fired_.clear();
        const mask candidates = s_.running() & accepted & (detected.crossed | open_).any_of();
        if (MYRIAD_UNLIKELY(any(candidates)))
            for_each_lane(candidates, [&](int i) MYRIAD_LAMBDA { locate_lane(i, trial, detected); });
        const masks gone_on = masks::all_in(accepted & !fired_lanes());
        open_ = open_ & ~gone_on;
        left_ = left_ | gone_on;
    }
    /// The lanes in which an event fired in this turn of the loop.
    MYRIAD_FUNCTION mask fired_lanes() const { return fired_.which.any_of(); }
    /// Whether event j fired in lane i in this turn of the loop.
    MYRIAD_FUNCTION bool has_fired(int j, int i) const { return fired_.which.get(j, i); }

    // Hooks
    /// Counts an action of event j in lane i; returns how many in a row have not moved its function off its surface.
    MYRIAD_FUNCTION std::int32_t count_action(int j, int i) {
        auto& lingered = memory_->lingered[i][j];
        lingered = left_.get(j, i) ? 1 : lingered + 1;
        return lingered;
    }
    /// A hook has changed inputs of event functions, whose values were `before`.
    MYRIAD_FUNCTION void update_after_hook(const mask& lanes, const values& before) {
        const values g = detail::evaluate_events<Model>(s_.now(), s_.data.y, s_.data);
        for_each_lane(lanes, [&](int i) MYRIAD_LAMBDA {
            flags moved;
            moved.clear();
            bool undefined = false;
            MYRIAD_UNROLL
            for (int j = 0; j < MYRIAD_LENGTH(m); ++j) {
                const R now = get_lane(g[j], i);
                undefined = undefined || now != now;
                moved.set(j, !fired_.which.get(j, i) && now != get_lane(before[j], i));
            }
            set_lane(undefined_, i, undefined);
            if (moved.any_of()) look(i, moved, vec<R, m>{});
        });
    }
    /// The same of a hook that was called at events.
    MYRIAD_FUNCTION void update_after_hook(const mask& lanes) { update_after_hook(lanes, fired_.value); }
    /// The actions of the events of lane i are done: their functions may be where they were, or have been moved.
    MYRIAD_FUNCTION void update_after_events(int i, const lane_data<Model, S>&) {
        const flags which = fired_.which.of_lane(i);
        left_.set_of_lane(i, left_.of_lane(i) & ~which);
        look(i, which, get_lanes<R>(fired_.value, i));
    }
    /// The actions of the events that fired are done.
    MYRIAD_FUNCTION void forget_fired() { fired_.clear(); }

private:
    MYRIAD_FUNCTION bridge_step<Model, R>& scratch() const {
        auto* step = &memory_->step;
        MYRIAD_OPTIMISATION_BARRIER(step);  // else nvcc keeps the values it points to in registers
        return *step;
    }
    /// Finds out whether these functions of lane i are at zero: up to rounding, twice what their events were located
    /// to, or so little that noise takes them there at once.
    MYRIAD_FUNCTION void look(int i, const flags& which, const vec<R, m>& located) {
        auto& b = scratch();
        b.p = detail::inputs_of_lane(s_.data, i);
        b.t = get_lane(s_.now(), i);
        b.y = get_lanes<R>(s_.data.y, i);
        const moved_events<Model, R> here = detail::events_with_noise<Model>(b.t, b.y, b.p);
        const auto roundings = detail::event_roundings<Model>(b.t, b.y, b.p, &b.place);
        flags open = open_.of_lane(i), stuck;
        stuck.clear();
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) {
            const R rate = here.rate[j] < infinity_of<R> ? here.rate[j] : R(0);  // others end the instance
            const R variance = rate * abs(get_lane(s_.steps.step, i));
            const R near =
                max(max(roundings[j], args_.event[j].tolerance), max(R(2) * abs(located[j]), at_once * sqrt(variance)));
            if (which[j]) open.set(j, abs(here.g[j]) <= near);
            const bool is_asked = (((args_.falling[j / 32] | args_.rising[j / 32]) >> (j % 32)) & 1u) != 0;
            stuck.set(j, open[j] && is_asked && rate > R(0));
        }
        open_.set_of_lane(i, open);
        set_lane(stuck_, i, stuck.any_of());
    }
    /// Of the standard deviation over a step.
    static constexpr R at_once = sizeof(R) == sizeof(double) ? R(0x1p-26) : R(0x1p-12);

    /// Ends the trial of lane i at its first event.
    MYRIAD_FUNCTION void locate_lane(int i, trial_type& trial, const detection& detected) {
        auto& b = scratch();
        b.p = detail::inputs_of_lane(s_.data, i);
        b.t = get_lane(s_.now(), i);
        b.h = get_lane(s_.h, i);
        b.y = get_lanes<R>(s_.data.y, i);
        b.g0 = get_lanes<R>(detected.g0, i);
        b.g1 = get_lanes<R>(detected.g1, i);
        b.rate = get_lanes<R>(detected.rate, i);
        b.crossed = detected.crossed.of_lane(i);
        b.open = open_.of_lane(i);
        s_.steps.set_interval(b.over, i, args_.noise);
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) b.tolerance[j] = args_.event[j].tolerance;
        for (int k = 0; k < b.words; ++k) b.falling[k] = args_.falling[k], b.rising[k] = args_.rising[k];
        detail::step_to_event<Model, Method>(&b);
        s_.extra_evaluations = count_where(lane_alone(i), s_.extra_evaluations, b.evaluations);
        if (b.event < 0) return;
        detail::set_lanes(trial.y, i, b.y1);
        set_lane(s_.h, i, b.theta * b.h);
        set_lane(s_.final_step, i, false);
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) {
            // With the first event comes another one whose function is past zero then: closer together they are not
            // told.
            const bool passed = b.g0[j] > R(0) ? b.g[j] < R(0) : b.g[j] > R(0);
            const bool too = !b.open[j] && b.is_asked(j, b.g0[j] > R(0)) && passed;
            fired_.put(j, i, j == b.event || too, b.g[j]);
        }
    }
    static MYRIAD_FUNCTION mask lane_alone(int i) {
        mask lane = mask(false);
        set_lane(lane, i, true);
        return lane;
    }

    const kernel_arguments<Model, R>& args_;
    integration_state<Model, Method, S>& s_;
    memories* memory_;
    masks open_;  // at zero at the committed state
    masks left_;  // away from zero since the event last fired
    mask undefined_, stuck_;
    fired_events<Model, S> fired_;
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
