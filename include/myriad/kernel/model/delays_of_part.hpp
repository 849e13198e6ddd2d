// SPDX-License-Identifier: MIT
// The delayed values of the units that one thread of a team integrates. Each thread looks up those of its own units in
// the ring, which has the past of all, and puts them into the team's memory, where functions of all units read them.
// Its own units' states it writes into the ring.
#pragma once

#include <type_traits>

#include "myriad/kernel/model/delays_of_units.hpp"
#include "myriad/kernel/model/team_memory.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// Bases of Part, the part of Whole that is described in part_of_units.hpp: each for what units have.
template <class Part, class Whole, int parts>
struct with_delays_of_part {};
template <class Part, class Whole, int parts>
requires has_delays<Whole>
struct with_delays_of_part<Part, Whole, parts> {
    using delayed_unit_type = typename Whole::unit_type;
    static constexpr int delayed_of_unit = n_unit_delayed<delayed_unit_type>;
    static constexpr int n_delayed = parts * delayed_of_unit;
    /// Whether lags of units differ, so that jumps arrive at other times in other threads.
    static constexpr bool has_own_lags = !has_lags_of_system<delayed_unit_type>;

    static MYRIAD_FUNCTION bool is_own_state(int c) { return Part::is_own(c / Part::states_of_unit); }
    /// The state of the whole system that delayed value j is of.
    static MYRIAD_FUNCTION int state_of_delayed(int j) {
        return Whole::delayed_state(Part::unit_of(j / delayed_of_unit) * delayed_of_unit + j % delayed_of_unit);
    }
    MYRIAD_FUNCTION static int same_lag(int j) {
        const int first = first_of_lag<delayed_unit_type>(j % delayed_of_unit);
        return has_own_lags ? j - j % delayed_of_unit + first : first;
    }
    template <class R>
    MYRIAD_FUNCTION static R lag(int j, const auto& p) {
        using real = typename std::remove_cvref_t<decltype(p)>::real;
        const auto inputs = Part::template inputs_of_team<real>(p);
        if constexpr (has_own_lags) {
            const int unit = Part::unit_of(j / delayed_of_unit);
            return delayed_unit_type::template lag<R>(unit, j % delayed_of_unit,
                                                      typename Part::template unit_inputs_type<real>(inputs, unit));
        } else {
            return delayed_unit_type::template lag<R>(j % delayed_of_unit,
                                                      system_inputs<delayed_unit_type, real, real>(inputs));
        }
    }
    /// Puts the thread's delayed values into the team's memory.
    template <class S>
    static MYRIAD_FUNCTION void put_delayed(S* to, const auto& p) {
        detail::for_each_delayed<Part>([&](auto j) MYRIAD_LAMBDA {
            const int part = j / delayed_of_unit;
            if (Part::is_own(part)) to[Part::unit_of(part) * delayed_of_unit + j % delayed_of_unit] = p.delayed[j];
        });
    }
};

template <class Part, class Whole, int parts>
struct with_slopes_of_part : with_delays_of_part<Part, Whole, parts> {};
template <class Part, class Whole, int parts>
requires has_delayed_slopes<Whole>
struct with_slopes_of_part<Part, Whole, parts> : with_delays_of_part<Part, Whole, parts> {
    MYRIAD_FUNCTION static bool is_delayed_slope(int j) {
        return Whole::unit_type::is_delayed_slope(j % n_unit_delayed<typename Whole::unit_type>);
    }
};

template <class Part, class Whole, int parts>
struct delays_of_part : with_slopes_of_part<Part, Whole, parts> {};
template <class Part, class Whole, int parts>
requires has_history<Whole>
struct delays_of_part<Part, Whole, parts> : with_slopes_of_part<Part, Whole, parts> {
    template <class R>
    MYRIAD_FUNCTION static R history(int j, const R& t, const auto& p) {
        using unit_type = typename Whole::unit_type;
        using real = typename std::remove_cvref_t<decltype(p)>::real;
        const auto inputs = Part::template inputs_of_team<real>(p);
        const int unit = Part::unit_of(j / n_unit_delayed<unit_type>);
        return unit_type::template history<R>(unit, j % n_unit_delayed<unit_type>, t,
                                              typename Part::template unit_inputs_type<real>(inputs, unit));
    }
    MYRIAD_FUNCTION static bool has_history(int j) {
        return Whole::has_history(j % n_unit_delayed<typename Whole::unit_type>);
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
