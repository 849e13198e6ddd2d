// SPDX-License-Identifier: MIT
// The model that runs a tape, with as many components as that has.
#pragma once

// clang-format off
#include "tape_run.hpp"  // before the kernel body
// clang-format on

#include <type_traits>

#include "tape_factors.hpp"

namespace myriad::python {

template <bool one_by_one>
struct tape_model {
    static constexpr bool writes_parameters = true;
    static constexpr bool rare_events = true;
    static constexpr bool large_rhs = true;
    static constexpr bool scalar_only = one_by_one;
    static constexpr int pack_batches = tape_batches;
    static constexpr extent n_state = tape_extent::state, n_parameter = tape_extent::parameter,
                            n_accessory = tape_extent::accessory, n_event = tape_extent::event,
                            n_integer_accessory = tape_extent::integer_accessory;
    enum shared { n_shared = 1 };
    enum shared_integer { n_shared_integer = 1 };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        myriad::vec<R, n_state> slopes;
        if constexpr (is_dual<R>) {  // the derivative by the time, which the tape does not read
            if (current_tape->autonomous && detail::any(R(t).derivative != decltype(R::derivative)(0))) return slopes;
        }
        run(current_tape->rhs, t, y, p, &slopes[0]);
        return slopes;
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        myriad::vec<R, n_event> values;
        run(current_tape->events, t, y, p, &values[0]);
        return values;
    }
    /// The entries of the Jacobian.
    template <class S>
    static void derivatives(const S& t, const myriad::vec<S, n_state>& y, const auto& p, S* entries) {
        run(current_tape->jacobian, t, y, p, entries);
    }

    MYRIAD_FUNCTION static void initialise(auto& lane) { hook(current_tape->initialise, lane); }
    template <class R>
    MYRIAD_FUNCTION static auto after_step(auto& lane) {
        tape_wishes<R> wishes;
        wishes.end_phase = R(0) != R(0);
        if (!current_tape->after_step.empty())
            run_tape<R>(current_tape->after_step,
                        hook_source<R, std::remove_reference_t<decltype(lane)>>{lane, wishes});
        return wishes.end_phase;
    }
    MYRIAD_FUNCTION static myriad::action after_event(int event, auto& lane) {
        return hook(current_tape->after_event[event], lane);
    }
    MYRIAD_FUNCTION static void finalise(auto& lane) { hook(current_tape->finalise, lane); }
    MYRIAD_FUNCTION static void generate(auto& instance) {
        using source = generate_source<std::remove_reference_t<decltype(instance)>>;
        run_tape<typename std::remove_cvref_t<decltype(instance)>::real>(current_tape->generate, source{instance});
    }

protected:
    template <class R>
    MYRIAD_FUNCTION static void run(const tape_function& f, const auto& t, const myriad::vec<R, n_state>& y,
                                    const auto& p, R* results) {
        if (f.empty()) return;
        const R time(t);
        run_tape<R>(f,
                    function_source<R, myriad::vec<R, n_state>, std::remove_cvref_t<decltype(p)>>{time, y, p, results});
    }
    /// A hook of one instance.
    MYRIAD_FUNCTION static myriad::action hook(const tape_function& f, auto& lane, tape_action* waiting = nullptr) {
        using R = std::remove_cvref_t<decltype(lane.h_next)>;
        tape_wishes<R> wishes;
        if (f.empty()) return myriad::action::proceed;
        run_tape<R>(f, hook_source<R, std::remove_reference_t<decltype(lane)>>{lane, wishes, waiting});
        if (wishes.end_instance) return myriad::action::end_instance;
        return wishes.end_phase ? myriad::action::end_phase : myriad::action::proceed;
    }
};

/// The places of the queue of the tape.
struct tape_layout : tape_queue {
    static constexpr int most_values = tape_values;
    tape_layout() : tape_queue(current_tape->queue) {}
};
/// The sides of event functions, as the states that a condition reads.
template <class Sides>
struct states_of_sides {
    const Sides& positive;
    double operator[](int j) const { return positive[j] ? 1.0 : 0.0; }
};
/// The inputs of a function that reads none.
struct no_inputs {
    const double *parameter = nullptr, *accessory = nullptr, *shared = nullptr;
    const std::int32_t *integer_accessory = nullptr, *shared_integer = nullptr;
};

/// The same with stops and triggers.
struct triggered_tape_model : tape_model<true> {
    using queue = basic_action_queue<tape_layout>;
    static constexpr extent n_stop = tape_extent::stop, n_trigger = tape_extent::trigger;

    template <class R>
    [[gnu::noinline]] static R stop_time(int stop, int number, const auto& p) {
        if (stop == current_tape->due) return queue::next_time(p);
        R time = infinity_of<R>;
        read(current_tape->stop_time[stop], R(number), &time, p, time);
        return time;
    }
    [[gnu::noinline]] static myriad::action after_stop(int stop, int number, auto& lane) {
        tape_action waiting;
        if (stop != current_tape->due) {
            waiting.value[0] = number;
            return hook(current_tape->after_stop[stop], lane, &waiting);
        }
        const auto priority = [&](int action) {
            tape_action one;
            hook(current_tape->priority[action], lane, &one);
            return one.priority;
        };
        const auto taken = queue::take(lane, priority, current_tape->seed);
        if (taken.action < 0) return myriad::action::proceed;
        waiting.value = taken.value;
        return hook(current_tape->late_action[taken.action], lane, &waiting);
    }
    [[gnu::noinline]] static bool condition(int trigger, const auto& positive) {
        double holds = 0.0;
        read(current_tape->condition[trigger], 0.0, states_of_sides<std::remove_cvref_t<decltype(positive)>>{positive},
             no_inputs{}, holds);
        return holds != 0.0;
    }
    static bool initial_value(int trigger) { return !current_tape->false_at_first[trigger]; }
    static bool persistent(int trigger) { return !current_tape->lapsing[trigger]; }
    [[gnu::noinline]] static myriad::action after_trigger(int trigger, auto& lane) {
        tape_action waiting;
        const myriad::action wanted = hook(current_tape->after_trigger[trigger], lane, &waiting);
        if (waiting.drop >= 0) queue::cancel(lane, waiting.drop);
        const bool fits = waiting.put < 0 || queue::put(lane, waiting.put, waiting.time, waiting.value);
        return fits ? wanted : myriad::action::overflow;
    }

protected:
    /// The one result of a function.
    template <class R, class States, class Inputs>
    static void read(const tape_function& f, const R& t, const States& y, const Inputs& p, R& result) {
        if (!f.empty()) run_tape<R>(f, function_source<R, States, Inputs>{t, y, p, &result});
    }
};

/// The same with values of the past.
struct delayed_tape_model : triggered_tape_model {
    static constexpr extent n_delayed = tape_extent::delayed, n_kept = tape_extent::kept, n_lag = tape_extent::lag;

    static const tape_past& tables_of_past() { return current_tape->past; }
    static bool lags_are_constant() { return current_tape->past.constant_lags; }
    static int delayed_state(int j) { return current_tape->past.delayed_state[j]; }
    static bool is_delayed_slope(int j) { return current_tape->past.is_slope[j]; }
    static bool has_history(int j) { return !current_tape->history[j].empty(); }
    template <class R>
    [[gnu::noinline]] static R lag(int j, const R& t, const myriad::vec<R, n_state>& y, const auto& p) {
        R ago(real_of<R>(0));
        read(current_tape->lag[j], t, y, p, ago);
        return ago;
    }
    template <class R>
    [[gnu::noinline]] static R history(int j, const R& t, const auto& p) {
        R before(real_of<R>(0));
        const R* const no_state = nullptr;
        read(current_tape->history[j], t, no_state, p, before);
        return before;
    }
};

/// The models of MYRIAD_TAPE_KINDS.
namespace tape_models {
using in_packs = tape_model<false>;
using with_triggers = triggered_tape_model;
using with_delays = delayed_tape_model;
}  // namespace tape_models

}  // namespace myriad::python

namespace myriad::detail {

/// The arguments of an interpreter, whose arrays stay where they are.
template <class Model, class R>
requires(python::is_name<n_state<Model>>) struct argument_arrays<Model, R> {
    static constexpr int words = python::tape_events / 32 + 1;
    const R *relative_tolerance, *absolute_tolerance;
    const event_arguments<R>* event;
    std::uint32_t rising[words]{}, falling[words]{};
    const std::int16_t *state_column, *accessory_column, *integer_accessory_column, *sample_column;

    void point_to(const any_arguments<R>& from) {
        const argument_offsets<R> at = from.offsets();
        const auto take = [&](auto*& array, int offset) {
            array = reinterpret_cast<std::remove_reference_t<decltype(array)>>(from.arrays + offset);
        };
        take(relative_tolerance, at.relative_tolerance);
        take(absolute_tolerance, at.absolute_tolerance);
        take(event, at.event);
        take(state_column, at.state_column);
        take(accessory_column, at.accessory_column);
        take(integer_accessory_column, at.integer_accessory_column);
        take(sample_column, at.sample_column);
        const std::uint32_t *of_rising, *of_falling;
        take(of_rising, at.rising);
        take(of_falling, at.falling);
        for (int k = 0; k <= from.model->n_event / 32; ++k) rising[k] = of_rising[k], falling[k] = of_falling[k];
    }
};

}  // namespace myriad::detail
