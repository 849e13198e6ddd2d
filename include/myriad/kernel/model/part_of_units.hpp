// SPDX-License-Identifier: MIT
// The part of coupled units that one thread of a team integrates, as a model: the loop takes it like any other, with
// the thread's states as its state vector. Only what reads other threads' states is done together: the right-hand side,
// event functions and hooks, here, and the decisions on a step, which take the largest error and the finiteness of all
// threads (core/team.hpp). Every thread has the values of all event functions and locates events as one thread does;
// hooks are called by the leading thread, with the whole system.
//
// Thread number i of a team of k has units i, i + k, i + 2 k, ... Where k does not divide the number of units, the last
// ones are the last unit once more in some threads: they compute what its thread computes, and change no largest error.
// Every sum is formed by one thread in the order of one thread per instance, and a largest number has no order, so that
// results have the same bits for every number of threads.
#pragma once

#include <cstdint>
#include <type_traits>

#include "myriad/kernel/core/team.hpp"
#include "myriad/kernel/model/coupled_units.hpp"
#include "myriad/kernel/model/delays_of_part.hpp"
#include "myriad/kernel/model/team_memory.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

template <class Whole, int threads>
struct part_of_units : part_summaries<Whole, (Whole::n_unit + threads - 1) / threads>,
                       delays_of_part<part_of_units<Whole, threads>, Whole, (Whole::n_unit + threads - 1) / threads> {
    using unit_type = typename Whole::unit_type;
    using layout = team_layout<Whole>;
    using together = thread_team<threads>;
    static constexpr int units = Whole::n_unit, states_of_unit = n_unit_state<unit_type>;
    static constexpr int parts = (units + threads - 1) / threads;  // units of a thread
    static constexpr int n_state = parts * states_of_unit;
    static constexpr int n_shared = detail::n_shared<Whole>, n_shared_integer = detail::n_shared_integer<Whole>;
    static constexpr int n_event = detail::n_event<Whole>, n_stop = detail::n_stop<Whole>;
    static constexpr int n_observed = parts * n_unit_observed<unit_type>;
    static constexpr bool writes_time_domain = detail::writes_time_domain<Whole>;
    static constexpr bool accessories_are_outputs = detail::accessories_are_outputs<Whole>,
                          writes_parameters = detail::writes_parameters<Whole>;

    template <class R>
    static constexpr int stride = team_stride<Whole, threads, R>();
    /// Bytes of shared memory: once in a block, for what large teams exchange and for the tolerances of all states; and
    /// for each thread.
    template <class R>
    static constexpr int bytes_of_block = together::exchange_bytes +
                                          2 * detail::n_state<Whole>* static_cast<int>(sizeof(R));
    template <class R>
    static constexpr int bytes_of_thread = stride<R> / threads* static_cast<int>(sizeof(R));

    static MYRIAD_FUNCTION bool is_own(int part) {
        return units % threads == 0 || part * threads + together::number_of_thread() < units;
    }
    static MYRIAD_FUNCTION int unit_of(int part) {
        const int unit = part * threads + together::number_of_thread();
        return is_own(part) ? unit : units - 1;
    }
    static MYRIAD_FUNCTION int whole_state(int c) {
        return unit_of(c / states_of_unit) * states_of_unit + c % states_of_unit;
    }

    /// The tolerances, relative ones first.
    template <class R>
    static MYRIAD_FUNCTION R* tolerances() {
        return static_cast<R*>(memory_of_block()) + together::exchange_bytes / static_cast<int>(sizeof(R));
    }
    template <class R>
    static MYRIAD_FUNCTION R* memory() {
        return tolerances<R>() + 2 * detail::n_state<Whole> + together::number_of_team() * stride<R>;
    }

    /// Copies the tolerances there, by `all` threads with consecutive numbers; they are to wait for each other then.
    template <class Arguments>
    static MYRIAD_FUNCTION void stage_tolerances(const Arguments& args, int number, int all) {
        using R = std::remove_cvref_t<decltype(args.relative_tolerance[0])>;
        constexpr int n = detail::n_state<Whole>;
        R* const to = tolerances<R>();
        for (int c = number; c < n; c += all) {
            to[c] = args.relative_tolerance[c];
            to[n + c] = args.absolute_tolerance[c];
        }
    }
    /// Calls `use(c)` for the thread's share of so many components.
    template <int count, class Use>
    static MYRIAD_FUNCTION void share_out(Use&& use) {
        if constexpr (count > 0) {
            for (int c = together::number_of_thread(); c < count; c += threads) use(c);
        }
    }
    template <class R>
    static MYRIAD_FUNCTION integer_of<R>* integer_accessories() {
        return reinterpret_cast<integer_of<R>*>(memory<R>() + layout::integer_accessory);
    }

    /// Copies the parameters and accessories of an instance there.
    template <class Arguments>
    static MYRIAD_FUNCTION void load(const Arguments& args, std::int64_t instance) {
        using R = std::remove_cvref_t<decltype(args.relative_tolerance[0])>;
        if constexpr (layout::published == layout::parameter) return;
        const auto copy = [&](auto count, auto* to, const auto* from) MYRIAD_LAMBDA {
            share_out<decltype(count)::value>([&](int c) MYRIAD_LAMBDA { to[c] = from[c * args.size + instance]; });
        };
        together::synchronise();  // all have done with those of the last instance
        copy(constant_index<n_parameter<Whole>>{}, memory<R>() + layout::parameter, args.parameter);
        copy(constant_index<n_accessory<Whole>>{}, memory<R>() + layout::accessory, args.accessory);
        copy(constant_index<n_integer_accessory<Whole>>{}, integer_accessories<R>(), args.integer_accessory);
        together::synchronise();
    }
    /// Copies the inputs to another place in the team's memory, to which `before`, a copy of the data, then refers.
    template <class R>
    static MYRIAD_FUNCTION void keep_inputs([[maybe_unused]] auto& before) {
        if constexpr (layout::keeps_inputs) {
            together::synchronise();  // all have read what lies there
            share_out<layout::inputs>(
                [](int c) MYRIAD_LAMBDA { memory<R>()[layout::kept + c] = memory<R>()[layout::parameter + c]; });
            together::synchronise();
            before.in_memory = layout::kept;
        }
    }
    /// Whether this thread's share of the inputs differs from that copy.
    template <class R>
    static MYRIAD_FUNCTION bool inputs_differ() {
        bool different = false;
        if constexpr (layout::keeps_inputs) {
            together::synchronise();  // all have written them
            share_out<layout::inputs>([&](int c) MYRIAD_LAMBDA {
                const R *const kept = memory<R>() + layout::kept, *const now = memory<R>() + layout::parameter;
                different = different || differs_in_bits(kept[c], now[c]);
            });
        }
        return different;
    }
    /// Copies the accessories and parameters, which hooks may have written, back.
    template <class Arguments>
    static MYRIAD_FUNCTION void store(const Arguments& args, std::int64_t instance) {
        together::synchronise();  // all have written them
        using R = std::remove_cvref_t<decltype(args.relative_tolerance[0])>;
        share_out<n_accessory<Whole>>([&](int c) MYRIAD_LAMBDA {
            args.accessory[c * args.size + instance] = memory<R>()[layout::accessory + c];
        });
        share_out<n_integer_accessory<Whole>>([&](int c) MYRIAD_LAMBDA {
            args.integer_accessory[c * args.size + instance] = static_cast<std::int32_t>(integer_accessories<R>()[c]);
        });
        if constexpr (writes_parameters) {
            share_out<n_parameter<Whole>>([&](int c) MYRIAD_LAMBDA {
                args.parameter[c * args.size + instance] = memory<R>()[layout::parameter + c];
            });
        }
    }
    /// Records the accessories where `to(array, column)` says.
    template <class Arguments, class To>
    static MYRIAD_FUNCTION void record(const Arguments& args, To&& to) {
        together::synchronise();  // all have written them
        using R = std::remove_cvref_t<decltype(args.relative_tolerance[0])>;
        share_out<n_accessory<Whole>>([&](int c) MYRIAD_LAMBDA {
            const int column = args.accessory_column[c];
            if (column >= 0) to(args.record.values, column) = memory<R>()[layout::accessory + c];
        });
        share_out<n_integer_accessory<Whole>>([&](int c) MYRIAD_LAMBDA {
            const int column = args.integer_accessory_column[c];
            if (column >= 0) to(args.record.integers, column) = static_cast<std::int32_t>(integer_accessories<R>()[c]);
        });
    }

    /// Puts the thread's delayed values there, if there are any.
    template <class S>
    static MYRIAD_FUNCTION void put_past([[maybe_unused]] S* of_team, [[maybe_unused]] const auto& p) {
        if constexpr (has_delays<Whole>) part_of_units::put_delayed(of_team + layout::delayed, p);
    }
    /// Puts a number for each state, `own(c)` for the thread's, into the team's memory, one unit after the other; and
    /// what `put_more` puts there.
    template <class S, class Own, class More>
    static MYRIAD_FUNCTION S* put_states(Own&& own, More&& put_more) {
        auto* const of_team = reinterpret_cast<S*>(memory<real_of<S>>());
        together::synchronise();  // all have read what lies there
        MYRIAD_UNROLL
        for (int c = 0; c < n_state; ++c)
            if (is_own(c / states_of_unit)) of_team[whole_state(c)] = own(c);
        put_more(of_team);
        together::synchronise();
        return of_team;
    }
    /// The states y with the values of the past that `p` has.
    template <class S>
    static MYRIAD_FUNCTION S* put_seen(const vec<S, n_state>& y, const auto& p) {
        return put_states<S>([&](int c) MYRIAD_LAMBDA { return y[c]; },
                             [&](S* of_team) MYRIAD_LAMBDA { put_past(of_team, p); });
    }
    /// Calls `use` for a number of each state in the order of the states.
    template <class R, class Own, class Use>
    static MYRIAD_FUNCTION void in_order(Own&& own, Use&& use) {
        const R* const of_team =
            put_states<R>([&](int c) MYRIAD_LAMBDA { return static_cast<R>(own(c)); }, [](R*) MYRIAD_LAMBDA {});
        using number = std::remove_cvref_t<decltype(own(0))>;
        for (int c = 0; c < detail::n_state<Whole>; ++c) use(static_cast<number>(of_team[c]));
    }

    template <class R, class S = R>
    using unit_inputs_type = unit_inputs<unit_type, units, R, R, team_inputs<Whole, R, S>>;
    template <class R, class S = R>
    static MYRIAD_FUNCTION team_inputs<Whole, R, S> inputs_of_team(const auto& p) {
        int first = layout::parameter;
        if constexpr (layout::keeps_inputs) first = p.in_memory;
        const R* const accessory = memory<R>() + first + n_parameter<Whole>;
        return {past_in_memory<Whole>(reinterpret_cast<const S*>(memory<R>())),
                memory<R>() + first,
                p.shared,
                p.shared_integer,
                accessory,
                reinterpret_cast<const integer_of<R>*>(accessory + n_accessory<Whole>)};
    }

    /// The event functions of all units, in every thread.
    template <class S>
    MYRIAD_FUNCTION static vec<S, n_event> events(auto t, const vec<S, n_state>& y, const auto& p) {
        using R = real_of<S>;
        constexpr int count = n_unit_event<unit_type>;
        S* const states = put_seen(y, p);
        S* const of_all = states + layout::event;
        const auto inputs = inputs_of_team<R, S>(p);
        MYRIAD_UNROLL
        for (int part = 0; part < parts; ++part) {
            if (!is_own(part)) continue;
            const int unit = unit_of(part);
            const vec<S, count> of_unit = unit_type::template events<S>(
                unit, t, unit_states<unit_type, units, const S>{states, unit}, unit_inputs_type<R, S>(inputs, unit));
            for (int e = 0; e < count; ++e) of_all[unit * count + e] = of_unit[e];
        }
        together::synchronise();
        vec<S, n_event> values;
        MYRIAD_UNROLL
        for (int j = 0; j < n_event; ++j) values[j] = of_all[j];
        return values;
    }
    /// The quantities that the thread's units observe.
    template <class S>
    MYRIAD_FUNCTION static vec<S, n_observed> observe(auto t, const vec<S, n_state>& y, const auto& p) {
        using R = real_of<S>;
        constexpr int count = n_unit_observed<unit_type>;
        const S* const states = put_seen(y, p);
        const auto inputs = inputs_of_team<R, S>(p);
        vec<S, n_observed> values;
        MYRIAD_UNROLL
        for (int part = 0; part < parts; ++part) {
            const int unit = unit_of(part);
            const vec<S, count> of_unit = unit_type::template observe<S>(
                unit, t, unit_states<unit_type, units, const S>{states, unit}, unit_inputs_type<R, S>(inputs, unit));
            for (int q = 0; q < count; ++q) values[part * count + q] = of_unit[q];
        }
        return values;
    }
    /// Whether the unit of this thread's quantity of that number is its own, so that this thread keeps the summaries.
    static MYRIAD_FUNCTION bool keeps(int quantity) { return is_own(quantity / n_unit_observed<unit_type>); }
    /// The receiver of a summary, by its number in `part_summaries`.
    template <class R>
    static MYRIAD_FUNCTION R& receiver(int number) {
        constexpr int size = n_unit_accessory<unit_type>, of_system = n_accessory<unit_type>;
        const int part = (number - of_system) / size;
        return memory<R>()[layout::accessory + of_system + unit_of(part) * size + (number - of_system) % size];
    }

    template <class R>
    MYRIAD_FUNCTION static R stop_time(int stop, int number, const auto& p) {
        return Whole::template stop_time<R>(stop, number, inputs_of_team<R>(p));
    }

    // Hooks
    MYRIAD_FUNCTION static void initialise(auto& lane) {
        call(lane, [](auto& whole) MYRIAD_LAMBDA { Whole::initialise(whole); });
    }
    MYRIAD_FUNCTION static action after_step(auto& lane) {
        return call(lane, [](auto& whole) MYRIAD_LAMBDA {
            if constexpr (units_have_generic_after_step<unit_type>) {
                using R = std::remove_cvref_t<decltype(whole.t)>;
                return Whole::template after_step<R>(whole) ? action::end_phase : action::proceed;
            } else {
                return Whole::after_step(whole);
            }
        });
    }
    MYRIAD_FUNCTION static action after_event(int event, auto& lane) {
        return call(lane, [&](auto& whole) MYRIAD_LAMBDA { return Whole::after_event(event, whole); });
    }
    MYRIAD_FUNCTION static action after_stop(int stop, int number, auto& lane) {
        return call(lane, [&](auto& whole) MYRIAD_LAMBDA { return Whole::after_stop(stop, number, whole); });
    }
    MYRIAD_FUNCTION static void finalise(auto& lane) {
        call(lane, [](auto& whole) MYRIAD_LAMBDA { Whole::finalise(whole); });
    }

    /// Calls a hook with the whole system by the leading thread. All threads have what it has changed, and its action.
    template <class Lane, class Hook>
    static MYRIAD_FUNCTION action call(Lane& lane, Hook&& hook) {
        using R = std::remove_cvref_t<decltype(lane.t)>;
        R* const states = put_seen(lane.y, lane);
        action wanted = action::proceed;
        if (together::leads()) {
            team_lane<Whole, R, Lane> whole{past_in_memory<Whole>(static_cast<const R*>(states)),
                                            lane.t,
                                            lane.t_begin,
                                            lane.t_end,
                                            lane.h,
                                            lane.h_next,
                                            states,
                                            memory<R>() + layout::parameter,
                                            lane.shared,
                                            lane.shared_integer,
                                            memory<R>() + layout::accessory,
                                            integer_accessories<R>(),
                                            lane.index,
                                            lane.phase,
                                            detail::first_of(lane.event_count)};
            wanted = detail::action_of([&]() MYRIAD_LAMBDA { return hook(whole); });
        }
        together::synchronise();
        MYRIAD_UNROLL
        for (int c = 0; c < n_state; ++c) lane.y[c] = states[whole_state(c)];
        lane.h_next = together::of_leader(lane.h_next);
        if constexpr (writes_time_domain) {
            lane.t_begin = together::of_leader(lane.t_begin);
            lane.t_end = together::of_leader(lane.t_end);
        }
        return static_cast<action>(together::of_leader(static_cast<int>(wanted)));
    }

    /// The factors of the noise of the thread's units.
    template <class S>
    MYRIAD_FUNCTION static vec<S, n_state> diffusion(auto t, const vec<S, n_state>& y, const auto& p) {
        using R = real_of<S>;
        const auto inputs = inputs_of_team<R>(p);
        vec<S, n_state> factors;
        MYRIAD_UNROLL
        for (int part = 0; part < parts; ++part) {
            const auto of_unit = detail::factors_of_unit<unit_type, S>(
                unit_of(part), t, y.values + part * states_of_unit, unit_inputs_type<R>(inputs, unit_of(part)));
            MYRIAD_UNROLL
            for (int c = 0; c < states_of_unit; ++c) factors[part * states_of_unit + c] = of_unit[c];
        }
        return factors;
    }
    /// The slopes of the thread's units.
    template <class R>
    MYRIAD_FUNCTION static vec<R, n_state> rhs(auto t, const vec<R, n_state>& y, const auto& p) {
        R* const of_team = memory<R>();
        together::synchronise();  // all have read what lies there
        MYRIAD_UNROLL
        for (int part = 0; part < parts; ++part) {
            if (!is_own(part)) continue;
            MYRIAD_UNROLL
            for (int c = 0; c < states_of_unit; ++c)
                of_team[layout::state + c * units + unit_of(part)] = y[part * states_of_unit + c];
        }
        put_past(of_team, p);
        together::synchronise();
        const auto inputs = inputs_of_team<R>(p);
        const auto inputs_of = [&](int unit) MYRIAD_LAMBDA { return unit_inputs_type<R>(inputs, unit); };
        const auto states_of = [&](int part) MYRIAD_LAMBDA {
            return own_states<Whole, R>(of_team, unit_of(part), y.values + part * states_of_unit);
        };
        if constexpr (n_publication < unit_type >> 0) {
            MYRIAD_UNROLL
            for (int part = 0; part < parts; ++part) {
                const int unit = unit_of(part);
                const auto values = unit_type::template publish<R>(unit, t, states_of(part), inputs_of(unit));
                if (!is_own(part)) continue;
                MYRIAD_UNROLL
                for (int c = 0; c < n_publication<unit_type>; ++c)
                    of_team[layout::published + c * units + unit] = values[c];
            }
            together::synchronise();
        }
        if constexpr (n_coupling < unit_type >> 0) {
            static_for<0, n_coupling<unit_type>>([&](auto k) MYRIAD_LAMBDA {
                constexpr int number = decltype(k)::value;
                const R* const matrix =
                    inputs.shared + Whole::first_coupling + first_coupling_entry<unit_type, units, number>;
                // 128 bubbles in teams of 32 threads took 87, 80 and 77 ms with 4, 8 and 16 columns (NVIDIA H200).
                constexpr int columns = 16;
                const vec<R, parts> sums = detail::sum_coupling<unit_type, units, number, parts, columns>(
                    [](int part) MYRIAD_LAMBDA { return unit_of(part); }, matrix, of_team + layout::published);
                MYRIAD_UNROLL
                for (int part = 0; part < parts; ++part)
                    if (is_own(part)) of_team[layout::sum + number * units + unit_of(part)] = sums[part];
            });
            together::synchronise();
        }
        vec<R, n_state> slopes;
        MYRIAD_UNROLL
        for (int part = 0; part < parts; ++part) {
            const int unit = unit_of(part);
            const auto values = unit_type::template rhs<R>(unit, t, states_of(part), inputs_of(unit));
            MYRIAD_UNROLL
            for (int c = 0; c < states_of_unit; ++c) slopes[part * states_of_unit + c] = values[c];
        }
        return slopes;
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
