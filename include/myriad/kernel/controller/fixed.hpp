// SPDX-License-Identifier: MIT
// Fixed steps: their number in a domain, and the last one.
#pragma once

#include <limits>

#include "myriad/kernel/controller/step_decision.hpp"
#include "myriad/kernel/state/integration_state.hpp"
#include "myriad/kernel/state/phase_interval.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// base + done * step - t, without the rounding error of base - t, which is added back (Knuth, The Art of Computer
/// Programming 2, 4.2.2, theorem B).
template <class R>
MYRIAD_FUNCTION R elapsed_beyond(R base, R t, R done, R step) {
    const R difference = base - t;
    const R subtracted = base - difference;
    const R rounding = (base - (difference + subtracted)) + (subtracted - t);
    return fma(done, step, difference) + rounding;
}

/// Stepping (see stepping.hpp) with one step size for all lanes, except for the last step and those to events.
template <class Model, class Method, class S>
struct fixed_stepping {
    using R = real_of<S>;
    using mask = mask_of<S>;
    using count = count_of<S>;
    static constexpr auto n = n_state<Model>;
    static constexpr bool keeps_low = keeps_time_low<Model, Method, R>;
    static constexpr std::int32_t stagnation_interval = 0;

    const kernel_arguments<Model, R>& args;
    integration_state<Model, Method, S>& s;

    MYRIAD_FUNCTION void load(int) {}
    MYRIAD_FUNCTION void store(int) const {}

    MYRIAD_FUNCTION void choose_step(int i, std::int32_t) { set_lane(s.data.h_next, i, args.step); }
    MYRIAD_FUNCTION void begin(int i, R t) {
        set_lane(s.steps.time_low, i, R(0));
        if constexpr (on_path) begin_path(i, t);
        lay(i, t);
        set_lane(s.data.h_next, i, get_lane(s.steps.step, i));
    }
    /// Lays out the steps of lane i again from t, its time after `done` steps up to rounding, which time_low keeps, or
    /// after the last step.
    MYRIAD_FUNCTION void move(int i, R t) {
        const R taken = detail::elapsed_beyond(get_lane(s.steps.base, i), t, static_cast<R>(get_lane(s.steps.done, i)),
                                               get_lane(s.steps.step, i));
        set_lane(s.steps.time_low, i, get_lane(s.steps.left, i) == 0 ? R(0) : get_lane(s.steps.time_low, i) + taken);
        lay(i, t);
    }

    MYRIAD_FUNCTION void resume(int i, R) { set_lane(s.data.h_next, i, get_lane(s.steps.step, i)); }
    /// Time of lane i's committed state, exactly t_end after the last step. For rare use: it reads the ensemble's
    /// array, so that models whose right-hand side does not depend on time keep no time in registers.
    MYRIAD_FUNCTION R time(int i) const {
        if (get_lane(s.steps.left, i) == 0) return stop_of(i);
        return fma(static_cast<R>(get_lane(s.steps.done, i)), get_lane(s.steps.step, i), args.t[s.instance[i]]);
    }

    /// The next step of every lane: the fixed one, or the rest of the way to the next stop. In lanes that are
    /// `locating`, the step that event location has set.
    MYRIAD_FUNCTION void propose(const mask& locating) {
        s.final_step = (s.steps.left <= count(1)) & !locating;
        s.h = has_events<Model> ? select(locating, s.data.h_next, s.steps.step) : s.steps.step;
        if constexpr (on_path) s.steps.to = detail::moved(s.steps.from, s.steps.per_step);
        if (MYRIAD_UNLIKELY(any(s.final_step))) {
            for_each_lane(s.running() & s.final_step, [&](int i) MYRIAD_LAMBDA {
                R beyond = detail::elapsed_beyond(args.t[s.instance[i]], stop_of(i),
                                                  static_cast<R>(get_lane(s.steps.done, i)), get_lane(s.steps.step, i));
                if constexpr (keeps_low) beyond += get_lane(s.steps.time_low, i);
                set_lane(s.h, i, -beyond);
                if constexpr (on_path) detail::set_place(s.steps.to, i, place_of_stop(i, -beyond));
            });
        }
    }

    /// The end of a whole step: bit for bit the time at which the next one begins, so that it can reuse the slope.
    MYRIAD_FUNCTION S next_time() const { return fma(S(s.steps.done + count(1)), s.steps.step, s.steps.base); }
    MYRIAD_FUNCTION S end_time() const {
        S t1 = next_time();
        if constexpr (has_events<Model>) {
            const S redone = s.now() + (s.h + s.steps.time_low);  // a step redone to an event
            t1 = select(s.h == s.steps.step, t1, redone);
        }
        return select(s.final_step, s.t_stop(), t1);
    }

    template <class EndStuck>
    MYRIAD_FUNCTION step_decision<S> judge(const trial_step<Method, S, n>& trial, const S&, const mask& valid,
                                           EndStuck&& end_stuck) const {
        const mask finite = valid & team_for<Model>::all(all_finite(trial.y)), failed = s.running() & !finite;
        if (MYRIAD_UNLIKELY(any(failed))) end_stuck(failed, mask(false));
        const mask accepted = s.running() & finite;
        return {accepted, s.data.h_next};
    }
    MYRIAD_FUNCTION status failure_of(int) const { return status::not_finite; }

    MYRIAD_FUNCTION mask advance(const mask& accepted, const S& t1, const mask& at_event) {
        s.steps.done = count_where(accepted, s.steps.done);
        s.steps.left = select(accepted, s.steps.left - count(1), s.steps.left);
        if constexpr (on_path) {
            s.steps.from.cell = select(accepted, s.steps.to.cell, s.steps.from.cell);
            s.steps.from.part = select(accepted, s.steps.to.part, s.steps.from.part);
        }
        if constexpr (has_events<Model>) {
            for_each_lane(accepted & at_event & !s.final_step, [&](int i) MYRIAD_LAMBDA {
                // the last step taken was shorter than the others
                set_lane(s.steps.time_low, i,
                         get_lane(s.steps.time_low, i) + (get_lane(s.h, i) - get_lane(s.steps.step, i)));
                move(i, get_lane(t1, i));
                if constexpr (on_path) s.steps.begin_again(i, args.noise);
            });
        }
        if constexpr (shows_time) {
            s.data.t = s.now();
            for_each_lane(accepted & s.final_step, [&](int i) MYRIAD_LAMBDA { set_lane(s.data.t, i, stop_of(i)); });
        }
        mask over = accepted & s.final_step;
        if constexpr (has_known_stops<Model>) over = over & (s.data.t == s.data.t_end);
        if constexpr (has_events<Model>) over = over | (accepted & at_event & (s.data.t == s.data.t_end));
        return over;
    }

    MYRIAD_FUNCTION bool stagnates(int) { return false; }

    /// All lanes have taken so many steps more.
    MYRIAD_FUNCTION void count_steps(const count& taken) {
        s.steps.left = s.steps.left - taken;
        s.steps.done = s.steps.done + taken;
    }

private:
    static constexpr bool on_path = stochastic_method<Method>;

    /// Where lane i begins on its path. Where phases go back to t_begin, each has a path of its own; with events too.
    MYRIAD_FUNCTION void begin_path(int i, R t) {
        const std::int64_t index = s.instance[i];
        const bool goes_on = args.carry_time && !has_events<Model>;  // an event may end a phase anywhere
        s.steps.path.set(i, args.first_index + index, goes_on ? 0 : args.phase[index]);
        detail::set_place(s.steps.from, i, has_events<Model> ? path_place<R>{0, 0} : place_at(i, t));
    }
    /// The place of a time on the path of lane i, which counts from the instance's t_begin.
    MYRIAD_FUNCTION path_place<R> place_at(int i, R t) const {
        const R t_begin = args.t_begin != nullptr ? args.t_begin[s.instance[i]] : args.common_t_begin;
        return detail::place_of_length(t - t_begin, args.noise.cell);
    }
    /// The place at the end of a last step of that length. Counted from t_begin, so that roundings to a place do not
    /// add up; in single precision, where t tells fewer cells apart than steps are counted, and where events have
    /// begun the path anew, from the beginning of the step.
    MYRIAD_FUNCTION path_place<R> place_of_stop(int i, R length) const {
        if constexpr (sizeof(R) == sizeof(double) && !has_events<Model>) return place_at(i, stop_of(i));
        return detail::moved(detail::get_place(s.steps.from, i), detail::place_of_length(length, args.noise.cell));
    }

    /// The number of steps gives the time; it is only stored if something reads it.
    static constexpr bool shows_time = has_after_step<Model> || has_events<Model> || has_known_stops<Model>;

    /// Divides the way of lane i from t to the next stop into steps, the last ending exactly there. A way that is a
    /// whole number of steps up to rounding gets that number, without a sliver at the end.
    MYRIAD_FUNCTION void lay(int i, R t) {
        // Beyond this, counts are inexact; options::max_steps, which is checked to be smaller, ends the phase before.
        constexpr R most = std::numeric_limits<R>::digits > 31 ? R(2147483647) : R(16777216);
        const R t_stop = get_lane(s.t_stop(), i);
        const R signed_step = copysign(args.step, t_stop - t);
        const R ratio = abs(t_stop - t) / args.step;
        constexpr R sliver = R(1e-6);  // of a step: added to the last one
        const R steps = -floor(sliver - ratio * (R(1) - R(4) * epsilon_of<R>));
        const R bounded = min(max(steps, R(1)), most);
        args.t[s.instance[i]] = t;
        set_lane(s.steps.base, i, t);
        set_lane(s.steps.step, i, signed_step);
        if constexpr (on_path)
            detail::set_place(s.steps.per_step, i, detail::place_of_length(signed_step, args.noise.cell));
        set_count(s.steps.done, i, 0);
        set_count(s.steps.left, i, bounded);
    }

    /// The time at which lane i's steps end, for rare use: without stop times it is read from the ensemble, so that it
    /// need not stay in a register. With events, which compare it with t at every step, it stays there.
    MYRIAD_FUNCTION R stop_of(int i) const {
        if constexpr (writes_time_domain<Model> || has_events<Model> || has_known_stops<Model>) {
            return get_lane(s.t_stop(), i);
        } else {
            const bool own = args.t_end != nullptr;
            const auto t_end = own ? args.t_end[s.instance[i]] : args.common_t_end;
            if (args.phase_length == R(0)) return t_end;
            const auto t_begin = own ? args.t_begin[s.instance[i]] : args.common_t_begin;
            return detail::interval_from(args, args.t[s.instance[i]], t_begin, t_end).end;  // where the steps begin
        }
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
