// SPDX-License-Identifier: MIT
// The life of an instance in a lane: it is loaded, integrated through its phases, recorded and stored, and the lane
// refilled. Values that the steps do not need (counters, phases done, the time at which the phase began) stay in the
// ensemble's arrays, as in the lane they would cost a GPU thread registers.
#pragma once

#include "myriad/kernel/controller/stepping.hpp"
#include "myriad/kernel/event/breaking_points.hpp"
#include "myriad/kernel/event/event_driver.hpp"
#include "myriad/kernel/event/stop_driver.hpp"
#include "myriad/kernel/integrator/consistent_state.hpp"
#include "myriad/kernel/output/observers.hpp"
#include "myriad/kernel/state/integration_state.hpp"
#include "myriad/kernel/stepper/component_loop.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

template <class Model, class Method, class S>
struct phase_driver {
    using R = real_of<S>;
    using arguments = kernel_arguments<Model, R>;
    using stepping_type = stepping<Model, Method, S>;
    static constexpr auto n = n_state<Model>;
    static constexpr auto m = n_event<Model>;

    const arguments& args;
    integration_state<Model, Method, S>& s;
    event_driver<Model, Method, S>& events;
    typename observers<Model, Method, S>::memories& observed;

    /// Ends the phase of lane i, if it holds an instance, and starts its next phase or the next instance that needs
    /// work. Returns false if there is none: the lane stays empty.
    template <class Source>
    MYRIAD_FUNCTION bool advance(int i, Source& source) {
        MYRIAD_OPTIMISATION_BARRIER(s.instance[i]);
        bool in_phase = s.instance[i] >= 0;
        if (in_phase && is_last(i, source)) {
            set_lane(s.active, i, false);
            return false;
        }
        for (;;) {
            if (in_phase) {
                end_phase(i);
                if constexpr (requires { source.gives_up_before(s.phases_left[i]); }) {
                    if (s.phases_left[i] > 0 && source.gives_up_before(s.phases_left[i])) leave(i);
                }
            }
            while (s.instance[i] < 0 || s.phases_left[i] == 0) {
                if (s.instance[i] >= 0) store(i);
                s.instance[i] = source.next();
                if (s.instance[i] < 0) {
                    set_lane(s.active, i, false);
                    return false;
                }
                if (is_over(source)) {
                    leave(i);
                    s.instance[i] = -1;  // not to be stored
                } else {
                    load(i);
                }
            }
            if (begin_phase(i)) return true;
            in_phase = true;
        }
    }

    /// Ends the phase and the instance that `advance` left open, together with the other threads of the warp.
    MYRIAD_FUNCTION void finish(int i) {
        if (s.instance[i] < 0) return;
        end_phase(i);
        store(i);
    }

private:
    /// Whether lane i is in the last phase of its only instance. The threads of a warp end theirs together, after the
    /// loop.
    template <class Source>
    MYRIAD_FUNCTION bool is_last(int i, const Source& source) const {
        if constexpr (requires { source.gives_only_one(); }) {
            return s.phases_left[i] == 1 && source.gives_only_one();
        } else {
            return false;
        }
    }

    /// Whether the call is over before the instance that the source has just given was begun.
    template <class Source>
    MYRIAD_FUNCTION bool is_over(const Source& source) const {
        if constexpr (requires { source.is_over(); }) {
            return source.is_over();
        } else {
            return false;
        }
    }
    /// Ends the instance of lane i before its next phase.
    MYRIAD_FUNCTION void leave(int i) {
        const std::int64_t index = s.instance[i];
        s.phases_left[i] = 0;
        if (args.ended[index] != 0) return;
        args.status[index] = status::interrupted;
        args.ended[index] = 1;
        if (args.phase[index] == 0) args.t[index] = args.t_begin != nullptr ? args.t_begin[index] : args.common_t_begin;
    }

    template <class T>
    MYRIAD_FUNCTION T& at(T* array, int component, int i) const {
        return array[static_cast<std::int64_t>(component) * args.size + s.instance[i]];
    }

    MYRIAD_FUNCTION void load(int i) {
        const std::int64_t index = s.instance[i];
        detail::each_component<Method, n>(
            [&](int c) MYRIAD_LAMBDA { set_lane(s.data.y[c], i, at(args.state, detail::whole_state<Model>(c), i)); });
        if constexpr (team_size < Model >> 1) as_part<Model>::load(args, index);
        MYRIAD_UNROLL
        for (int c = 0; c < MYRIAD_LENGTH(n_parameter<Model>); ++c)
            set_lane(s.data.parameter[c], i, at(args.parameter, c, i));
        MYRIAD_UNROLL
        for (int c = 0; c < MYRIAD_LENGTH(n_accessory<Model>); ++c)
            set_lane(s.data.accessory[c], i, at(args.accessory, c, i));
        MYRIAD_UNROLL
        for (int c = 0; c < MYRIAD_LENGTH(n_integer_accessory<Model>); ++c)
            set_lane(s.data.integer_accessory[c], i, at(args.integer_accessory, c, i));
        if constexpr (writes_time_domain<Model>) load_time_domain(i);
        stepping_type{args, s}.load(i);
        if constexpr (m > 0) events.load(i);
        if constexpr (has_delays<Model>) breaking_points<Model, Method, S>{args, s}.load(i);
        set_lane(s.data.index, i, args.first_index + index);
        s.phases_left[i] = args.ended[index] != 0 ? 0 : args.phases - args.first_phase;
    }

    MYRIAD_FUNCTION void load_time_domain(int i) {
        const bool own = args.t_begin != nullptr;
        set_lane(s.data.t_begin, i, own ? args.t_begin[s.instance[i]] : args.common_t_begin);
        set_lane(s.data.t_end, i, own ? args.t_end[s.instance[i]] : args.common_t_end);
    }

    MYRIAD_FUNCTION void store(int i) const {
        const std::int64_t index = s.instance[i];
        detail::each_component<Method, n>(
            [&](int c) MYRIAD_LAMBDA { at(args.state, detail::whole_state<Model>(c), i) = get_lane(s.data.y[c], i); });
        if constexpr (writes_parameters<Model>) {
            MYRIAD_UNROLL
            for (int c = 0; c < MYRIAD_LENGTH(n_parameter<Model>); ++c)
                at(args.parameter, c, i) = get_lane(s.data.parameter[c], i);
        }
        if constexpr (writes_time_domain<Model>) {
            args.t_begin[index] = get_lane(s.data.t_begin, i);
            args.t_end[index] = get_lane(s.data.t_end, i);
        }
        MYRIAD_UNROLL
        for (int c = 0; c < MYRIAD_LENGTH(n_accessory<Model>); ++c)
            at(args.accessory, c, i) = get_lane(s.data.accessory[c], i);
        MYRIAD_UNROLL
        for (int c = 0; c < MYRIAD_LENGTH(n_integer_accessory<Model>); ++c)
            at(args.integer_accessory, c, i) = static_cast<std::int32_t>(get_lane(s.data.integer_accessory[c], i));
        if constexpr (team_size < Model >> 1) as_part<Model>::store(args, index);
        stepping_type{args, s}.store(i);
        if constexpr (has_delays<Model>) breaking_points<Model, Method, S>{args, s}.store(i);
    }

    /// Adds the work of the phase to the instance's counters.
    MYRIAD_FUNCTION void count_work(int i) const {
        const std::int64_t index = s.instance[i];
        const auto trials = static_cast<std::int64_t>(s.iterations_of(args, i));
        const auto rejected = static_cast<std::int64_t>(get_lane(s.rejected, i));
        const auto located = static_cast<std::int64_t>(get_lane(s.located, i));
        args.accepted[index] += trials - rejected - located;
        if constexpr (is_adaptive<Method>) args.rejected[index] += rejected;
        if constexpr (m > 0) {
            if (MYRIAD_LENGTH(m) > 0) args.located[index] += located;
        }
        args.evaluations[index] +=
            trials * s.slopes.evaluations_per_trial + static_cast<std::int64_t>(get_lane(s.extra_evaluations, i));
    }

    /// Starts the next phase of lane i at (t_begin, y), or at t where time is carried on. Returns false if the phase is
    /// over without a step: its domain is empty, or `initialise` left a value that is not finite.
    MYRIAD_FUNCTION bool begin_phase(int i) {
        s.ending[i] = status::success;
        // Loaded again for each phase, so that t_begin need not stay in a register.
        if constexpr (!writes_time_domain<Model>) load_time_domain(i);
        const std::int64_t index = s.instance[i];
        const std::int32_t phase = args.phase[index];
        const bool carry_on = args.carry_time && phase > 0;
        set_lane(s.data.t, i, carry_on ? args.t[index] : get_lane(s.data.t_begin, i));
        [[maybe_unused]] const R t_end_of_all = get_lane(s.data.t_end, i);
        if constexpr (!writes_time_domain<Model>) {  // else its hooks set the ends of phases
            if (args.phase_length != R(0)) {
                const R t_begin = get_lane(s.data.t_begin, i), t_end = get_lane(s.data.t_end, i);
                const auto part = detail::interval_from(args, get_lane(s.data.t, i), t_begin, t_end);
                set_lane(s.data.t_begin, i, part.begin);
                set_lane(s.data.t_end, i, part.end);
            }
        }
        if constexpr (moves_time_domain<Model>) {
            set_lane(s.data.accessory[phase_marks_of<Model>::carries_on], i, carry_on ? R(1) : R(0));
            set_lane(s.data.accessory[phase_marks_of<Model>::goes_to_t_end], i,
                     get_lane(s.data.t_end, i) == t_end_of_all ? R(1) : R(0));
        }
        set_lane(s.data.phase, i, phase);
        set_lane(s.data.h, i, R(0));
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) set_lane(s.data.event_count[j], i, 0);
        stepping_type steps{args, s};
        steps.choose_step(i, phase);
        [[maybe_unused]] R past_until = args.t[index];
        if constexpr (has_initialise<Model>) {
            if constexpr (has_delays<Model>) static_cast<void>(begin_past(i, past_until));  // which it may read
            // What has acted at this time is told by the times of stops that were its own then.
            if constexpr (has_stops<Model>) {
                if (carry_on) stop_driver<Model, Method, S>{args, s}.begin(i, true);
            }
            place(i, [](auto& lane) MYRIAD_LAMBDA { Model::initialise(lane); });
            if constexpr (writes_time_domain<Model>) {
                if (!carry_on) set_lane(s.data.t, i, get_lane(s.data.t_begin, i));
            }
        }
        if constexpr (n_algebraic < Model >> 0) {
            if (has_initialise<Model> || phase > 0) make_consistent(i);  // other initial values the host has checked
        }
        const R t = get_lane(s.data.t, i);
        if constexpr (has_delays<Model>) s.end_lane(i, begin_past(i, past_until));
        args.t[index] = t;
        observers<Model, Method, S>{args, s, observed}.begin(i);  // stop times may read what they write
        if constexpr (has_known_stops<Model>) {
            const stop_driver<Model, Method, S> stops{args, s};
            if (has_stops<Model> && has_initialise<Model> && carry_on) {
                stops.update(i);
            } else {
                stops.begin(i, carry_on);
            }
        }
        steps.begin(i, t);
        if constexpr (m > 0) {
            if (phase == 0) events.reset(i);
        }
        set_lane(s.active, i, true);
        s.slopes.reset(i);
        s.instance_over[i] = false;
        set_count(s.rejected, i, 0);
        set_count(s.located, i, 0);
        set_count(s.extra_evaluations, i, 0);
        s.begin_iterations(args, i);
        if constexpr (has_stops<Model>) {
            if (s.ending[i] == status::success) act_on_stops(i);
        }
        return s.ending[i] == status::success && t != get_lane(s.data.t_end, i);
    }

    /// The past of lane i begins, or moves to where the phase does, from where it ended or was moved to before.
    [[nodiscard]] MYRIAD_FUNCTION status begin_past(int i, R& until) {
        const R now = get_lane(s.data.t, i), moved = now - until;
        until = now;
        return breaking_points<Model, Method, S>{args, s}.begin(i, get_lane(s.data.phase, i) == 0, moved);
    }

    /// Calls after_stop where a phase begins at a stop time, after its first sample.
    MYRIAD_FUNCTION void act_on_stops(int i) {
        const stop_driver<Model, Method, S> stops{args, s};
        const R t = get_lane(s.data.t, i);
        bool acted = false;
        const status ending = stops.act(i, [&](auto j, std::int32_t number) MYRIAD_LAMBDA {
            acted = true;
            if constexpr (has_after_stop<Model>) {
                s.carry_out(i, place(i, [&](auto& lane) MYRIAD_LAMBDA { return Model::after_stop(j, number, lane); }));
                stops.update(i);
            }
        });
        s.end_lane(i, ending);
        if (!acted) return;
        if constexpr (has_delays<Model>) {
            breaking_points<Model, Method, S>{args, s}.jump(i, 0);
            stops.update(i);
        }
        if constexpr (n_algebraic < Model >> 0) make_consistent(i);
        stepping_type{args, s}.begin(i, t);
    }
    /// Algebraic states follow what the hooks before the first step have set. Functions of events have no side then, as
    /// after these hooks.
    MYRIAD_FUNCTION void make_consistent(int i) {
        if (s.ending[i] != status::success) return;
        const state_correction made = detail::make_state_consistent(args, s, i);
        s.end_lane(i, made.ending);
        if constexpr (m > 0) {
            if (made.changed) events.reset(i);
        }
    }

    /// Runs `initialise`, `finalise` or an action before the first step, and returns what it requests. A state or step
    /// that is not finite is refused. A state that the hook changed was set, not integrated: functions then within
    /// their tolerance have no side.
    template <class Hook>
    MYRIAD_FUNCTION action place(int i, Hook&& hook) {
        const auto before = get_lanes<R>(s.data.y, i);
        const R h_next = get_lane(s.data.h_next, i);
        const action wanted = detail::run_on_lane(s.data, i, hook);
        const auto after = get_lanes<R>(s.data.y, i);
        bool finite = all_finite(after) && get_lane(s.data.h_next, i) == get_lane(s.data.h_next, i);
        if constexpr (writes_time_domain<Model>)
            finite = finite && get_lane(s.data.t_begin, i) == get_lane(s.data.t_begin, i) &&
                     get_lane(s.data.t_end, i) == get_lane(s.data.t_end, i);
        if (!team_for<Model>::all(finite)) {
            set_lanes(s.data.y, i, before);
            set_lane(s.data.h_next, i, h_next);
            s.ending[i] = status::not_finite;
        } else if (!team_for<Model>::all(
                       same_values(before, after, MYRIAD_LENGTH(n) - MYRIAD_LENGTH(n_tangent<Model>)))) {
            if constexpr (m > 0) events.reset(i);
        }
        return wanted;
    }

    /// Ends the phase of lane i: `finalise`, record, count; if it failed, ends the instance.
    MYRIAD_FUNCTION void end_phase(int i) {
        const std::int64_t index = s.instance[i];
        if (args.accepted != nullptr && team_for<Model>::leads()) count_work(i);
        set_lane(s.data.t, i, stepping_type{args, s}.time(i));
        team_for<Model>::synchronise();  // all have read time and number of the phase from the ensemble
        if constexpr (m > 0) events.store(i);
        args.t[index] = get_lane(s.data.t, i);
        if constexpr (has_finalise<Model>) {
            if (!is_failure(s.ending[i])) place(i, [](auto& lane) MYRIAD_LAMBDA { Model::finalise(lane); });
        }
        const bool failed = is_failure(s.ending[i]);
        args.status[index] = s.ending[i];
        if (!failed) {
            record(i, args.phases - s.phases_left[i] - args.record.from_phase);
            if (team_for<Model>::leads()) args.phase[index] += 1;
        }
        --s.phases_left[i];
        if (args.cost != nullptr) args.cost[index] = static_cast<std::uint32_t>(s.iterations_of(args, i));
        if (failed || s.instance_over[i]) {
            args.ended[index] = 1;
            s.phases_left[i] = 0;
            if (args.cost != nullptr) args.cost[index] = 0;
        }
        team_for<Model>::synchronise();  // all see what the leading thread has written
    }

    MYRIAD_FUNCTION void record(int i, std::int32_t row) const {
        const auto& r = args.record;
        if (row < 0 || row >= r.phases) return;
        const auto to = [&](auto* array, int column) MYRIAD_LAMBDA -> auto& {
            return array[(static_cast<std::int64_t>(column) * r.phases + row) * args.size + s.instance[i]];
        };
        if (r.time_column >= 0) to(r.values, r.time_column) = get_lane(s.data.t, i);
        detail::each_component<Method, n>([&](int c) MYRIAD_LAMBDA {
            const int column = args.state_column[detail::whole_state<Model>(c)];
            if (column >= 0) to(r.values, column) = get_lane(s.data.y[c], i);
        });
        if constexpr (team_size < Model >> 1) as_part<Model>::record(args, to);
        MYRIAD_UNROLL
        for (int c = 0; c < MYRIAD_LENGTH(n_accessory<Model>); ++c)
            if (args.accessory_column[c] >= 0)
                to(r.values, args.accessory_column[c]) = get_lane(s.data.accessory[c], i);
        MYRIAD_UNROLL
        for (int c = 0; c < MYRIAD_LENGTH(n_integer_accessory<Model>); ++c)
            if (args.integer_accessory_column[c] >= 0)
                to(r.integers, args.integer_accessory_column[c]) =
                    static_cast<std::int32_t>(get_lane(s.data.integer_accessory[c], i));
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
