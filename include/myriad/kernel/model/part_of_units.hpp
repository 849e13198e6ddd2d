// SPDX-License-Identifier: MIT
// The part of coupled units that one thread of a team integrates, as a model: the loop takes it like any other, with
// the thread's states as its state vector. Only what reads other threads' states is done together: the right-hand side,
// here, and the decisions on a step, which take the largest error and the finiteness of all threads (core/team.hpp).
//
// Thread number i of a team of k has units i, i + k, i + 2 k, ... Where k does not divide the number of units, the last
// ones are the last unit once more in some threads: they compute what its thread computes, and change no largest error.
// Every sum is formed by one thread in the order of one thread per instance, and a largest number has no order, so that
// results have the same bits for every number of threads.
#pragma once

#include <cstdint>
#include <type_traits>

#include "myriad/kernel/core/team.hpp"
#include "myriad/kernel/core/vec.hpp"
#include "myriad/kernel/model/coupled_units.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// Where a team has the values that its threads read of each other, in numbers from the first.
template <class Whole>
struct team_layout {
    using unit = typename Whole::unit_type;
    static constexpr int units = Whole::n_unit;
    static constexpr int state = 0;  // component by component, so that neighbours' are side by side
    static constexpr int parameter = state + n_state<Whole>;  // of the system, then of the units
    static constexpr int published = parameter + n_parameter<Whole>;
    static constexpr int sum = published + units * n_publication<unit>;
    static constexpr int end = sum + units * n_coupling<unit>;
};
/// Numbers from one team's values to the next one's: the teams of a warp read side by side from different banks.
template <class Whole, int threads, class R>
constexpr int team_stride() {
    constexpr int banks = 128 / static_cast<int>(sizeof(R));
    int stride = (team_layout<Whole>::end + threads - 1) / threads * threads;
    while (stride % banks != threads % banks) stride += threads;
    return stride;
}

/// The state of any unit as other threads' units see it.
template <class Whole, class R>
struct seen_states {
    using layout = team_layout<Whole>;
    using unit_type = typename layout::unit;
    static constexpr int units = layout::units;
    const R* memory;  // of the team
    int unit;

    template <class C>
    MYRIAD_FUNCTION const R& operator[](C c) const {
        constexpr int size = n_unit_state<unit_type>;
        return memory[layout::state + unit_index<unit_state_enumeration<unit_type>, size>(c) * units + unit];
    }
    template <class P>
    MYRIAD_FUNCTION const R& published(P publication) const {
        constexpr int size = n_publication<unit_type>;
        return memory[layout::published + unit_index<publication_enumeration<unit_type>, size>(publication) * units +
                      unit];
    }
    template <class C>
    MYRIAD_FUNCTION const R& coupled(C coupling) const {
        return memory[layout::sum + checked_index<n_coupling<unit_type>>(static_cast<int>(coupling)) * units + unit];
    }
    MYRIAD_FUNCTION seen_states of(int other) const { return {memory, checked_unit<units>(other)}; }
};
/// The state of one of the thread's own units, in its registers.
template <class Whole, class R>
struct own_states : seen_states<Whole, R> {
    const R* own;

    MYRIAD_FUNCTION own_states(const R* memory, int unit, const R* first)
        : seen_states<Whole, R>{memory, unit}, own(first) {}
    template <class C>
    MYRIAD_FUNCTION const R& operator[](C c) const {
        using unit_type = typename Whole::unit_type;
        return own[unit_index<unit_state_enumeration<unit_type>, n_unit_state<unit_type>>(c)];
    }
};

/// What units read besides states.
template <class R>
struct team_inputs {
    const R* parameter;
    const R* shared;
    const std::int32_t* shared_integer;
    vec<R, 0> accessory;
    vec<std::int32_t, 0> integer_accessory;
};

template <class Whole, int threads>
struct part_of_units {
    using unit_type = typename Whole::unit_type;
    using layout = team_layout<Whole>;
    using together = thread_team<threads>;
    static constexpr int units = Whole::n_unit, states_of_unit = n_unit_state<unit_type>;
    static constexpr int parts = (units + threads - 1) / threads;  // units of a thread
    static constexpr int n_state = parts * states_of_unit;
    static constexpr int n_shared = detail::n_shared<Whole>, n_shared_integer = detail::n_shared_integer<Whole>;

    template <class R>
    static constexpr int stride = team_stride<Whole, threads, R>();
    /// Of shared memory: for the tolerances of all states, once in a block, and for each thread.
    template <class R>
    static constexpr int bytes_of_block = 2 * detail::n_state<Whole>* static_cast<int>(sizeof(R));
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
        return static_cast<R*>(memory_of_block());
    }
    template <class R>
    static MYRIAD_FUNCTION R* memory() {
        R* first = static_cast<R*>(memory_of_block()) + 2 * detail::n_state<Whole>;
#if defined(__CUDA_ARCH__)
        first += threadIdx.x / threads * stride<R>;
#endif
        return first;
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
    /// Copies the parameters of an instance there. The right-hand side waits for it.
    template <class Arguments>
    static MYRIAD_FUNCTION void load_parameters(const Arguments& args, std::int64_t instance) {
        if constexpr (n_parameter < Whole >> 0) {
            using R = std::remove_cvref_t<decltype(args.relative_tolerance[0])>;
            together::synchronise();  // all have done with those of the last instance
            R* const to = memory<R>() + layout::parameter;
            for (int c = together::number_of_thread(); c < n_parameter<Whole>; c += threads)
                to[c] = args.parameter[static_cast<std::int64_t>(c) * args.size + instance];
        }
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
        together::synchronise();
        const team_inputs<R> inputs{of_team + layout::parameter, p.shared, p.shared_integer, {}, {}};
        const auto inputs_of = [&](int unit) MYRIAD_LAMBDA {
            return unit_inputs<unit_type, units, R, R, team_inputs<R>>(inputs, unit);
        };
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
                MYRIAD_UNROLL
                for (int part = 0; part < parts; ++part) {
                    if (is_own(part))
                        detail::sum_coupling<unit_type, units, number, 1>(
                            unit_of(part), matrix, of_team + layout::published, of_team + layout::sum);
                }
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
