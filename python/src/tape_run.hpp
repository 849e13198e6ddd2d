// SPDX-License-Identifier: MIT
// Runs the functions of a tape, step by step, for numbers of any kind.
#pragma once

// clang-format off
#include "tape_vectors.hpp"  // before the kernel body
// clang-format on

#include <limits>
#include <type_traits>

#include "myriad/kernel/model/action_queue.hpp"
#include "myriad/python/kernel_library.hpp"

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
    tape_array<R> registers(static_cast<std::size_t>(f.registers));
    R* const r = registers.data();
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
            case tape_code::load_delayed:
                if constexpr (requires { s.p.delayed[0]; }) r[to] = s.p.delayed[a];
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

}  // namespace myriad::python
