// SPDX-License-Identifier: MIT
// The sides of one lane's event functions: read and set, with the thresholds that decide them. Everything in this
// folder that works on one lane reaches its data here.
#pragma once

#include <cstdint>

#include "myriad/kernel/event/event_functions.hpp"
#include "myriad/kernel/event/event_memory.hpp"
#include "myriad/kernel/event/event_sides.hpp"
#include "myriad/kernel/state/integration_state.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

template <class R>
MYRIAD_FUNCTION R sign_of(R x) {
    return x > R(0) ? R(1) : x < R(0) ? R(-1) : R(0);
}

/// A crossing is a change of side. The side on which a function was last seen is remembered, so that one that lands on
/// zero is not lost, and one that only touches zero does not fire. Values within rounding of zero count as zero. Right
/// after its event a function may still be short of the surface, as closely as the event was located, but counts as on
/// the side that its slope along the solution is heading for.
template <class Model, class Method, class S>
struct lane_sides {
    using R = real_of<S>;
    static constexpr auto m = n_event<Model>;
    using reals = vec<R, m>;  // of the event functions in one lane
    using flags = mask_set<bool, m>;
    using masks = mask_set<mask_of<S>, m>;

    const kernel_arguments<Model, R>& args;
    integration_state<Model, Method, S>& s;
    event_sides<Model, S>& e;
    event_memories<Model, R, lanes_of<S>>* memory;

    MYRIAD_FUNCTION event_memory<Model, R>& memory_of(int i) const {
        auto* own = memory->lane + i;
        MYRIAD_OPTIMISATION_BARRIER(own);  // else nvcc keeps the values it points to in registers
        return *own;
    }
    /// Its values are not kept between steps.
    MYRIAD_FUNCTION event_scratch<Model, R>& scratch() const {
        auto* shared = &memory->scratch;
        MYRIAD_OPTIMISATION_BARRIER(shared);
        return *shared;
    }
    /// What the last phase has kept of event j for the next.
    MYRIAD_FUNCTION std::int32_t& kept_at(int j, int i) const {
        return args.side[static_cast<std::int64_t>(j) * args.size + s.instance[i]];
    }
    /// The inputs of lane i's event functions beside t and y.
    MYRIAD_FUNCTION decltype(auto) inputs_of(int i) const { return inputs_of(i, s.data); }
    MYRIAD_FUNCTION decltype(auto) inputs_of(int i, const lane_data<Model, S>& at) const {
        return detail::inputs_of_lane(at, i);
    }

    /// +1, -1, or 0 if the side is not yet known.
    MYRIAD_FUNCTION R side_of(int j, int i) const {
        return memory_of(i).open[j] ? R(0) : e.above.get(j, i) ? R(1) : R(-1);
    }
    MYRIAD_FUNCTION void put_side(int j, int i, R side) const {
        memory_of(i).open.set(j, side == R(0));
        memory_of(i).held.set(j, false);
        e.above.set(j, i, side > R(0));
    }
    /// Whether the next trial of lane i is redone, to end at an event.
    MYRIAD_FUNCTION bool is_locating(int i) const { return e.flags.get(e.locating, i); }
    /// Sets whether the next trial of lane i has to go to the locator. To be called after what decides it changed.
    MYRIAD_FUNCTION void update_in_question(int i) const {
        const auto& own = memory_of(i);
        e.flags.set(e.in_question, i, is_locating(i) || (own.open | own.on_jump).any_of() || args.sub_samples > 1);
    }

    /// The crossings that are events, from where the functions are.
    MYRIAD_FUNCTION masks asked() const {
        const masks& above = e.above;
        return (above & masks::from_bits(args.falling)) | (~above & masks::from_bits(args.rising));
    }
    /// Whether event j fires when its function crosses from the given side.
    MYRIAD_FUNCTION bool is_asked(int j, R side) const {
        const std::uint32_t asked = side > R(0) ? args.falling[j / 32] : side < R(0) ? args.rising[j / 32] : 0u;
        return ((asked >> (j % 32)) & 1u) != 0;
    }
    /// Whether a function with value g has crossed from the given side, by more than `past`.
    MYRIAD_FUNCTION bool crosses(int j, R side, R g, R past) const { return is_asked(j, side) && side * g < -past; }

    /// Whether a value is farther from the surface than the tolerance that was given.
    MYRIAD_FUNCTION bool is_beyond_tolerance(int j, R g) const {
        return abs(g) > args.event[j].tolerance && args.event[j].tolerance > R(0);
    }
    MYRIAD_FUNCTION bool are_beyond_tolerances(const reals& g) const {
        bool beyond = true;
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) beyond = beyond && is_beyond_tolerance(j, g[j]);
        return beyond;
    }
    /// The rounding errors of the event functions g at the committed state, or zero if those in question are farther
    /// from the surface than the tolerances that were given, and so than rounding.
    MYRIAD_FUNCTION reals roundings_if_needed(int i, const reals& g, const flags& in_question) const {
        bool clear = true;
        MYRIAD_UNROLL
        for (int j = 0; j < MYRIAD_LENGTH(m); ++j) clear = clear && (!in_question[j] || is_beyond_tolerance(j, g[j]));
        if (clear) return reals{};
        return detail::event_roundings<Model>(get_lane(s.now(), i), get_lanes<R>(s.data.y, i), inputs_of(i),
                                              &scratch().place);
    }

    /// Whether event j fired at the committed state. After an ordinary step every function has left.
    MYRIAD_FUNCTION bool is_fresh(int j, int i) const { return memory_of(i).fresh[j] && !e.left.get(j, i); }
    /// Whether event j fired at a jump that a state within `length` of it may not have passed: if another event is
    /// located right after that one, rounding may leave the state before the jump.
    MYRIAD_FUNCTION bool is_at_jump(int j, int i, R length) const {
        const auto& own = memory_of(i);
        return own.on_jump[j] && abs(length) <= own.jump_time;
    }
    MYRIAD_FUNCTION R rounding_of_time(int i) const { return R(4) * epsilon_of<R> * abs(get_lane(s.now(), i)); }
    /// Whether `length` is within that: values so near do not show that a function has left the place where it fired.
    MYRIAD_FUNCTION bool is_timeless(int i, R length) const { return abs(length) <= rounding_of_time(i); }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
