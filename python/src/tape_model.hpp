// SPDX-License-Identifier: MIT
// The model that runs a tape; components beyond the tape's are not used, and stay zero.
#pragma once

#include <limits>
#include <type_traits>

#include "myriad/kernel/model/action_queue.hpp"
#include "myriad/python/kernel_library.hpp"
#include "tape.hpp"

namespace myriad::python {

template <class R>
inline constexpr bool is_dual = requires(R x) {
    x.derivative;
};

/// Numbers of any kind as reals, lane by lane, and back.
template <class R, class I>
inline R real_lanes(const I& from) {
    if constexpr (is_dual<R>) {
        return R(real_lanes<decltype(R::value)>(from));
    } else {
        R to{};
        for (int i = 0; i < lanes_of<R>; ++i)
            detail::set_lane(to, i, static_cast<real_of<R>>(detail::get_lane(from, i)));
        return to;
    }
}
/// The whole number that a register holds.
inline std::int64_t whole(double x) {
    return x < 0x1p63 ? static_cast<std::int64_t>(x) : std::numeric_limits<std::int64_t>::max();
}
template <class I, class R>
inline void store_integer(I& to, const R& from) {
    for (int i = 0; i < lanes_of<R>; ++i)
        detail::set_lane(to, i, static_cast<std::int32_t>(whole(detail::get_lane(from, i))));
}

/// The elementary functions, compiled once for each kind of numbers, in tape_functions.cpp.
template <class R>
void apply_function(tape_code code, const R& x, const R& y, R& result);
/// The same for operations of whole numbers.
template <class R>
void apply_to_whole_numbers(tape_code code, bool is_long, const R& x, const R& y, R& result);

/// What a hook of a tape wants for its instances.
template <class R>
struct tape_wishes {
    mask_of<R> end_phase{}, end_instance{};
};
/// An action that waits: what the function of a trigger puts or drops, and what is taken from the queue.
struct tape_action {
    int put = -1, drop = -1;  ///< the number of the action
    double time = 0.0, priority = -std::numeric_limits<double>::infinity();
    vec<double, tape_values> value;
};

/// The arguments of rhs and events.
template <class R, class States, class Inputs>
struct function_source {
    static constexpr bool in_hook = false;
    const R& t;
    const States& y;
    const Inputs& p;
    R* results;
};
/// The arguments of a hook; `waiting` where there is an action that waits.
template <class R, class Lane>
struct hook_source {
    static constexpr bool in_hook = true;
    Lane& p;
    tape_wishes<R>& wishes;
    tape_action* waiting = nullptr;
};

/// The argument of `generate`: an instance of a study.
template <class Instance>
struct generate_source {
    static constexpr bool in_hook = false;
    Instance& p;
};

inline void run_on_waiting_action(const tape_step& step, tape_action& waiting, double& x);

/// Runs a function. One copy for each kind of arguments, since kernels call it at every stage.
template <class R, class Source>
[[gnu::noinline]] void run_tape(const tape_function& f, const Source& s) {
    R r[tape_registers];
    const auto truth = [](const auto& mask) { return myriad::select(mask, R(1), R(0)); };
    for (const tape_step* step = f.begin; step != f.end; ++step) {
        const auto [value, to, a, b, c, code] = *step;
        switch (code) {
            case tape_code::constant:
                r[to] = R(static_cast<real_of<R>>(value));
                break;
            case tape_code::negate:
                r[to] = -r[a];
                break;
            case tape_code::fma:
                r[to] = myriad::fma(r[a], r[b], r[c]);
                break;
            case tape_code::select:
                r[to] = myriad::select(r[a] != R(0), r[b], r[c]);
                break;
            case tape_code::both:
                r[to] = r[a] * r[b];
                break;
            case tape_code::either:
                r[to] = myriad::max(r[a], r[b]);
                break;
            case tape_code::opposite:
                r[to] = R(1) - r[a];
                break;
            case tape_code::is_finite:
                r[to] = truth(myriad::is_finite(r[a]));
                break;
            case tape_code::lookup:
                r[to] = myriad::lookup(static_cast<const real_of<R>*>(s.p.shared) + static_cast<std::int64_t>(value), c,
                                       a, r[b]);
                break;
            case tape_code::find_interval:
                r[to] = myriad::find_interval(
                    static_cast<const real_of<R>*>(s.p.shared) + static_cast<std::int64_t>(value), a, r[b]);
                break;
#define MYRIAD_TAPE_CASE(name, op) \
    case tape_code::name:          \
        r[to] = r[a] op r[b];      \
        break;
                MYRIAD_TAPE_INFIX(MYRIAD_TAPE_CASE)
#undef MYRIAD_TAPE_CASE
#define MYRIAD_TAPE_CASE(name, op)   \
    case tape_code::name:            \
        r[to] = truth(r[a] op r[b]); \
        break;
                MYRIAD_TAPE_COMPARISON(MYRIAD_TAPE_CASE)
#undef MYRIAD_TAPE_CASE
            case tape_code::load_parameter:
                r[to] = s.p.parameter[a];
                break;
            case tape_code::load_shared:
                r[to] = R(static_cast<const real_of<R>*>(s.p.shared)[a]);
                break;
            case tape_code::load_shared_integer:
                r[to] = R(static_cast<real_of<R>>(static_cast<const std::int32_t*>(s.p.shared_integer)[a]));
                break;
            case tape_code::load_accessory:
                r[to] = s.p.accessory[a];
                break;
            case tape_code::load_integer_accessory:
                r[to] = real_lanes<R>(s.p.integer_accessory[a]);
                break;
            default:
                if (code >= tape_code::powr && code <= tape_code::floor_divide) {
                    apply_function(code, r[a], r[b], r[to]);
                } else if (code >= tape_code::wrapping_add && code <= tape_code::remainder) {
                    apply_to_whole_numbers(code, c != 0, r[a], r[b], r[to]);
                } else if constexpr (Source::in_hook) {
                    run_in_hook<R>(*step, s, r);
                } else if constexpr (requires { s.p.random; }) {
                    run_in_generate(*step, s.p, r);
                } else if (code == tape_code::load_state) {
                    r[to] = s.y[a];
                } else if (code == tape_code::load_time) {
                    r[to] = s.t;
                } else if (code == tape_code::store_result) {
                    s.results[a] = r[to];
                }
        }
    }
}
/// The operations that only hooks have.
template <class R, class Source>
inline void run_in_hook(const tape_step& step, const Source& s, R* r) {
    auto& lane = s.p;
    R& x = r[step.to];
    const int c = step.a;
    switch (step.code) {
        case tape_code::load_state:
            x = lane.y[c];
            break;
        case tape_code::load_time:
            x = lane.t;
            break;
        case tape_code::load_step:
            x = lane.h;
            break;
        case tape_code::load_next_step:
            x = lane.h_next;
            break;
        case tape_code::load_t_begin:
            x = lane.t_begin;
            break;
        case tape_code::load_t_end:
            x = lane.t_end;
            break;
        case tape_code::load_phase:
            x = real_lanes<R>(lane.phase);
            break;
        case tape_code::load_instance:
            x = real_lanes<R>(lane.index);
            break;
        case tape_code::load_event_count:
            x = real_lanes<R>(lane.event_count[c]);
            break;
        case tape_code::store_state:
            lane.y[c] = x;
            break;
        case tape_code::store_parameter:
            lane.parameter[c] = x;
            break;
        case tape_code::store_accessory:
            lane.accessory[c] = x;
            break;
        case tape_code::store_integer_accessory:
            store_integer(lane.integer_accessory[c], x);
            break;
        case tape_code::store_next_step:
            lane.h_next = x;
            break;
        case tape_code::store_end_phase:
            s.wishes.end_phase = x != R(0);
            break;
        case tape_code::store_end_instance:
            s.wishes.end_instance = x != R(0);
            break;
        default:
            if constexpr (std::is_same_v<R, double>) run_on_waiting_action(step, *s.waiting, x);
    }
}
/// The operations of actions that wait.
inline void run_on_waiting_action(const tape_step& step, tape_action& waiting, double& x) {
    switch (step.code) {
        case tape_code::load_waiting:
            x = waiting.value[step.a];
            break;
        case tape_code::store_waiting:
            waiting.value[step.a] = x;
            break;
        case tape_code::store_put:
            waiting.put = step.a;
            waiting.time = x;
            break;
        case tape_code::store_drop:
            waiting.drop = step.a;
            break;
        case tape_code::store_result:
            waiting.priority = x;
            break;
        default:
            break;
    }
}

/// The operations that only `generate` has.
template <class R, class Instance>
inline void run_in_generate(const tape_step& step, Instance& instance, R* r) {
    R& x = r[step.to];
    const int c = step.a;
    switch (step.code) {
        case tape_code::load_state:
            x = instance.y[c];
            break;
        case tape_code::load_instance:
            x = static_cast<R>(instance.index);
            break;
        case tape_code::uniform:
            x = instance.random.uniform(r[step.a], r[step.b]);
            break;
        case tape_code::normal:
            x = instance.random.normal(r[step.a], r[step.b]);
            break;
        case tape_code::store_state:
            instance.y[c] = x;
            break;
        case tape_code::store_parameter:
            instance.parameter[c] = x;
            break;
        case tape_code::store_accessory:
            instance.accessory[c] = x;
            break;
        case tape_code::store_integer_accessory:
            instance.integer_accessory[c] = static_cast<std::int32_t>(whole(x));
            break;
        default:
            break;
    }
}

/// `size`: a `tape_size`.
template <class size>
struct tape_model {
    static constexpr bool writes_parameters = true;
    static constexpr bool rare_events = true;
    static constexpr bool scalar_only = size::scalar_only;
    static constexpr int pack_batches = tape_batches;
    enum state { n_state = size::n_state };
    enum parameter { n_parameter = size::n_parameter };
    enum shared { n_shared = 1 };
    enum shared_integer { n_shared_integer = 1 };
    enum accessory { n_accessory = size::n_accessory };
    enum integer_accessory { n_integer_accessory = size::n_integer_accessory };
    enum event { n_event = size::n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        R slopes[n_state];
        for (R& slope : slopes) slope = R(0);
        run(current_tape->rhs, t, y, p, slopes);
        myriad::vec<R, n_state> all;
        for (int c = 0; c < n_state; ++c) all[c] = slopes[c];
        return all;
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto t, const myriad::vec<R, n_state>& y, const auto& p) {
        R values[n_event];
        for (R& value : values) value = R(1);  // an event that is not there never happens
        run(current_tape->events, t, y, p, values);
        myriad::vec<R, n_event> all;
        for (int c = 0; c < n_event; ++c) all[c] = values[c];
        return all;
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
template <class size>
struct triggered_tape_model : tape_model<size> {
    using queue = basic_action_queue<tape_layout>;
    enum stop { n_stop = size::n_stop };
    enum trigger { n_trigger = size::n_trigger };

    template <class R>
    [[gnu::noinline]] static R stop_time(int stop, int number, const auto& p) {
        if (stop == current_tape->due) return queue::next_time(p);
        R time = infinity_of<R>;
        read(current_tape->stop_time[stop], R(number), &time, p, time);
        return time;
    }
    [[gnu::noinline]] static myriad::action after_stop(int stop, int, auto& lane) {
        if (stop != current_tape->due) return tape_model<size>::hook(current_tape->after_stop[stop], lane);
        tape_action waiting;
        const auto priority = [&](int action) {
            tape_action one;
            tape_model<size>::hook(current_tape->priority[action], lane, &one);
            return one.priority;
        };
        const auto taken = queue::take(lane, priority, current_tape->seed);
        if (taken.action < 0) return myriad::action::proceed;
        waiting.value = taken.value;
        return tape_model<size>::hook(current_tape->late_action[taken.action], lane, &waiting);
    }
    [[gnu::noinline]] static bool condition(int trigger, const auto& positive) {
        double holds = 0.0;
        read(current_tape->condition[trigger], 0.0, states_of_sides<std::remove_cvref_t<decltype(positive)>>{positive},
             no_inputs{}, holds);
        return holds != 0.0;
    }
    MYRIAD_FUNCTION static bool initial_value(int trigger) { return !has(current_tape->false_at_first, trigger); }
    MYRIAD_FUNCTION static bool persistent(int trigger) { return !has(current_tape->lapsing, trigger); }
    [[gnu::noinline]] static myriad::action after_trigger(int trigger, auto& lane) {
        tape_action waiting;
        const myriad::action wanted = tape_model<size>::hook(current_tape->after_trigger[trigger], lane, &waiting);
        if (waiting.drop >= 0) queue::cancel(lane, waiting.drop);
        const bool fits = waiting.put < 0 || queue::put(lane, waiting.put, waiting.time, waiting.value);
        return fits ? wanted : myriad::action::overflow;
    }

private:
    static bool has(std::uint64_t triggers, int trigger) { return (triggers >> trigger & 1u) != 0; }
    /// The one result of a function.
    template <class R, class States, class Inputs>
    static void read(const tape_function& f, const R& t, const States& y, const Inputs& p, R& result) {
        if (!f.empty()) run_tape<R>(f, function_source<R, States, Inputs>{t, y, p, &result});
    }
};

template <class size>
using model_of_tape = std::conditional_t<(size::n_trigger > 0), triggered_tape_model<size>, tape_model<size>>;

}  // namespace myriad::python
