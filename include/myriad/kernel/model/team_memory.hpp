// SPDX-License-Identifier: MIT
// The memory of a team of threads that integrates an instance of coupled units: what lies where, and how right-hand
// sides and hooks see it.
#pragma once

#include <cstdint>
#include <type_traits>

#include "myriad/kernel/core/team.hpp"
#include "myriad/kernel/core/vec.hpp"
#include "myriad/kernel/model/unit_views.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// Where a team has the values that its threads read of each other, in numbers from the first.
template <class Whole>
struct team_layout {
    using unit = typename Whole::unit_type;
    static constexpr int units = Whole::n_unit;
    // Of states, for a right-hand side component by component, so that neighbours' are side by side, else unit by unit;
    // behind them the event functions, and values of the past, unit by unit. All of these may be dual numbers for event
    // functions and what is observed.
    static constexpr int state = 0, event = n_state<Whole>, delayed = event + n_event<Whole>;
    static constexpr int seen = delayed + n_delayed<Whole>;
    static constexpr int parameter = n_event<Whole> > 0 || n_observed<Whole> > 0 ? 2 * seen : seen;
    static constexpr int accessory = parameter + n_parameter<Whole>;  // of the system, then of the units, as parameters
    static constexpr int integer_accessory = accessory + n_accessory<Whole>;
    static constexpr int published = integer_accessory + n_integer_accessory<Whole>;
    static constexpr int sum = published + units * n_publication<unit>;
    static constexpr int kept = sum + units * n_coupling<unit>;
    // Parameters and accessories as they were before a hook that may write them, if right-hand sides and events read
    // them.
    static constexpr int inputs = published - parameter;
    static constexpr bool keeps_inputs =
        writes_parameters<Whole> ||
        (!accessories_are_outputs<Whole> && n_accessory<Whole> + n_integer_accessory<Whole> > 0);
    static constexpr int end = kept + (keeps_inputs ? inputs : 0);
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

/// Values of the past in the team's memory, if there are any.
template <class S, bool there>
struct past_of_team {};
template <class S>
struct past_of_team<S, true> {
    const S* delayed;
};
template <class Whole, class S>
using past_of_team_of = past_of_team<S, has_delays<Whole>>;
template <class Whole, class S>
MYRIAD_FUNCTION past_of_team_of<Whole, S> past_in_memory([[maybe_unused]] const S* memory) {
    if constexpr (has_delays<Whole>) {
        return {memory + team_layout<Whole>::delayed};
    } else {
        return {};
    }
}

/// What units read besides states; values of the past are numbers of type S.
template <class Whole, class R, class S>
struct team_inputs : past_of_team_of<Whole, S> {
    const R* parameter;
    const R* shared;
    const std::int32_t* shared_integer;
    const R* accessory;
    const integer_of<R>* integer_accessory;

    template <class I>
    MYRIAD_FUNCTION const R& operator[](I i) const {
        return parameter[static_cast<int>(i)];
    }
};

/// The whole system as hooks see it: the members of `lane`, of which the team has the components in its memory.
template <class Whole, class R, class Lane>
struct team_lane : past_of_team_of<Whole, R> {
    const R& t;
    decltype(Lane::t_begin) t_begin;
    decltype(Lane::t_end) t_end;
    const R& h;
    R& h_next;
    R* y;
    std::conditional_t<writes_parameters<Whole>, R, const R>* parameter;
    const R* shared;
    const std::int32_t* shared_integer;
    R* accessory;
    integer_of<R>* integer_accessory;
    const index_of<R>& index;
    const integer_of<R>& phase;
    const integer_of<R>* event_count;
};

template <class Whole, int threads>
requires team_layout<Whole>::keeps_inputs struct place_of_inputs<part_of_units<Whole, threads>> {
    int in_memory = team_layout<Whole>::parameter;
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
