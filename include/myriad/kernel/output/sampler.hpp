// SPDX-License-Identifier: MIT
// Dense output inside the loop: stores chosen states at given times, from the interpolant of each committed step, or at
// every n-th step. Only in kernels of a method `dense<Method>`; other kernels contain none of it.
#pragma once

#include "myriad/kernel/state/inside_step.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// An observer: see observers.hpp.
template <class Model, class Method, class S>
struct sampler {
    using R = real_of<S>;
    using mask = mask_of<S>;
    using step_type = accepted_step<Model, Method, S>;
    static constexpr auto n = n_state<Model>;
    static constexpr bool watches = samples_trajectory<Method>;
    static constexpr bool changes_inputs = false;

    struct memory {
        S next;                           // time of the next sample; infinity: none
        S last;                           // when sampling by steps: time of the last sample
        S begin, end;                     // the domain of evenly spaced samples; a hook may move the end of the phase
        std::int32_t index[lanes_of<S>];  // index of the next given time in this phase
        std::int32_t steps[lanes_of<S>];  // accepted steps since the last sample; -1: this phase is not sampled
    };

    const kernel_arguments<Model, R>& args;
    integration_state<Model, Method, S>& s;
    memory& o;

    MYRIAD_FUNCTION void begin(int i) {
        const std::int32_t phase = args.phases - s.phases_left[i];  // of this call
        const R t = get_lane(s.data.t, i);
        o.index[i] = 0;
        o.steps[i] = -1;
        set_lane(o.next, i, never(i));
        if (args.sample.stored == nullptr || phase < args.sample.from_phase) return;
        if (args.sample.every > 0) {
            o.steps[i] = 0;
            store(i, t, get_lanes<R>(s.data.y, i));
            set_lane(o.last, i, t);
            return;
        }
        const R end = get_lane(s.data.t_end, i);
        set_lane(o.begin, i, get_lane(s.data.t_begin, i));
        set_lane(o.end, i, end);
        // If time continues from phase to phase, the previous phase stored the samples at its end.
        const R last = last_time(i), instant = same_instant(t);
        const bool has_start = args.carry_time && get_lane(s.data.phase, i) > 0 && abs(last - t) <= instant;
        const auto passed = [&](R time) MYRIAD_LAMBDA {
            return (has_start && (end < t ? time >= last : time <= last)) ||
                   (end < t ? time > t + instant : end > t && time < t - instant);
        };
        while (o.index[i] < args.sample.count && passed(sample_time(i))) ++o.index[i];
        set_next(i);
        const auto is_at_start = [&](R time) MYRIAD_LAMBDA {
            return end == t ? abs(time - t) <= instant : end < t ? time >= t : time <= t;
        };
        // A domain of length zero has one sample, however many it is divided into.
        for (R before = never(i); is_at_start(get_lane(o.next, i)) && get_lane(o.next, i) != before;) {
            before = get_lane(o.next, i);
            store_values(i, before, [&](int c) MYRIAD_LAMBDA { return get_lane(s.data.y[c], i); });
            ++o.index[i];
            set_next(i);
        }
    }

    /// Starts phase 0 of lane i again: actions at its start have changed the state.
    MYRIAD_FUNCTION void begin_again(int i) {
        if (args.sample.stored == nullptr) return;
        team_for<Model>::synchronise();
        if (team_for<Model>::leads()) args.sample.stored[s.instance[i]] = 0;
        team_for<Model>::synchronise();
        begin(i);
    }

    /// Stores the samples within the accepted steps. Where one ends at an event, at a stop or at the end of the phase,
    /// a sample at the same instant shows the state there, before any action.
    MYRIAD_FUNCTION void see(const step_type& seen) {
        if (args.sample.stored == nullptr) return;
        if (args.sample.every > 0) {
            save_steps(seen);
        } else {
            const S& t1 = seen.t1;
            const S later = select(s.h < S(R(0)), t1 - same_instant(t1), t1 + same_instant(t1));
            save_times(seen, select(seen.at_event | s.final_step, later, t1));
        }
    }

private:
    MYRIAD_FUNCTION void save_steps(const step_type& seen) {
        for_each_lane(seen.accepted, [&](int i) MYRIAD_LAMBDA {
            if (o.steps[i] < 0 || ++o.steps[i] < args.sample.every) return;
            const R t = get_lane(seen.t1, i);
            if (abs(t - get_lane(o.last, i)) < args.sample.minimum_spacing) return;
            store(i, t, get_lanes<R>(seen.trial.y, i));
            set_lane(o.last, i, t);
            o.steps[i] = 0;
        });
    }

    /// `last` is the end of the step or, where the phase ends there too, the last time that is the same instant.
    MYRIAD_FUNCTION void save_times(const step_type& seen, const S& last) {
        const S t0 = s.now();
        mask due = seen.accepted & falls_between(t0, last);
        if (!any(due)) return;
        const step_data<Method, S, n> step = seen.inside(due);
        while (any(due)) {
            const S theta = (o.next - step.t) / step.h;
            const auto y = sampled_state(step, theta, is_past(o.next, seen.t1));
            for_each_lane(due, [&](int i) MYRIAD_LAMBDA {
                store_values(i, get_lane(o.next, i), [&](int c) MYRIAD_LAMBDA { return get_lane(y(c), i); });
                ++o.index[i];
                set_next(i);
            });
            due = seen.accepted & falls_between(t0, last);
        }
    }

    /// The state at that part of a step, or at its end, as a function of the component. Stages in shared memory are
    /// read there, and only for components that are stored.
    MYRIAD_FUNCTION auto sampled_state(const step_data<Method, S, n>& step, const S& theta, const mask& at_end) const {
        if constexpr (shares_stages<Method, Model, S>) {
            return [&step, theta, at_end](int c) MYRIAD_LAMBDA {
                const auto& stages = detail::stages_of_thread<Method, Model, S>();
                const S inside = detail::rosenbrock_interpolation<Method>(step.y, stages, theta, c);
                return select(at_end, stages.y[c], inside);
            };
        } else {
            vec<S, n> y = detail::interpolate(step, theta);
            MYRIAD_UNROLL
            for (int c = 0; c < MYRIAD_LENGTH(n); ++c) y[c] = select(at_end, step.trial.y[c], y[c]);
            return [y](int c) MYRIAD_LAMBDA { return y[c]; };
        }
    }

    /// Lanes whose next sample falls into the step from t0 to t1. Excluded is a sample left behind by a hook that
    /// reversed the phase; included is one that rounding of t put between the end of the last step and t0.
    MYRIAD_FUNCTION mask falls_between(const S& t0, const S& t1) const {
        const S slack = time_rounding(t0);
        const S ahead = select(s.h < S(R(0)), t0 - o.next, o.next - t0);
        return is_past(t1, o.next) & (ahead >= -slack);
    }
    /// Whether t is at or past the other time, in the direction of the step.
    MYRIAD_FUNCTION mask is_past(const S& t, const S& other) const {
        const mask backwards = s.h < S(R(0)), forwards = !backwards;
        return (backwards & (t <= other)) | (forwards & (t >= other));
    }
    /// Times that differ by less are one instant: sixteen roundings.
    template <class T>
    static MYRIAD_FUNCTION T same_instant(const T& t) {
        return T(resolved_roundings<R>) * abs(t);
    }
    static MYRIAD_FUNCTION S time_rounding(const S& t) { return S(R(4) * epsilon_of<R>) * abs(t); }

    MYRIAD_FUNCTION R never(int i) const {
        constexpr R far = infinity_of<R>;
        return copysign(far, get_lane(s.data.t_end, i) - get_lane(s.data.t, i));
    }
    MYRIAD_FUNCTION void set_next(int i) {
        set_lane(o.next, i, o.index[i] < args.sample.count ? sample_time(i) : never(i));
    }
    /// Given times, or evenly spaced ones over the domain at the start of the phase, both ends included.
    MYRIAD_FUNCTION R sample_time(int i) const {
        const std::int32_t k = o.index[i];
        if (args.sample.times != nullptr) return args.sample.times[k];
        if (args.sample.own_times != nullptr)
            return args.sample.own_times[static_cast<std::int64_t>(k) * args.size + s.instance[i]];
        const R begin = get_lane(o.begin, i), end = get_lane(o.end, i);
        if (k == args.sample.count - 1) return end;
        return fma(rounded_quotient(static_cast<R>(k), static_cast<R>(args.sample.count - 1)), end - begin, begin);
    }

    /// The time of the last sample, infinite if there is none.
    MYRIAD_FUNCTION R last_time(int i) const {
        const std::int32_t stored = args.sample.stored[s.instance[i]];
        return stored > 0 ? args.sample.time[static_cast<std::int64_t>(stored - 1) * args.size + s.instance[i]]
                          : infinity_of<R>;
    }

    MYRIAD_FUNCTION void store(int i, R t, const vec<R, n>& y) const {
        store_values(i, t, [&](int c) MYRIAD_LAMBDA { return y[c]; });
    }
    /// Stores a sample with the components y(c).
    template <class State>
    MYRIAD_FUNCTION void store_values(int i, R t, State&& y) const {
        std::int32_t& stored = args.sample.stored[s.instance[i]];
        if (stored >= args.sample.capacity) return;
        const std::int64_t cell = static_cast<std::int64_t>(stored) * args.size + s.instance[i];
        args.sample.time[cell] = t;
        std::int64_t apart = args.size * args.sample.capacity;
        MYRIAD_OPTIMISATION_BARRIER(apart);  // else registers hold each column's place throughout the loop over steps
        MYRIAD_UNROLL
        for (int c = 0; c < MYRIAD_LENGTH(n); ++c) {
            const int column = args.sample_column[detail::whole_state<Model>(c)];
            if (column >= 0) args.sample.values[column * apart + cell] = y(c);
        }
        team_for<Model>::synchronise();  // all have read the number
        if (team_for<Model>::leads()) ++stored;
        team_for<Model>::synchronise();
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
