// SPDX-License-Identifier: MIT
// A trial step of one instance as event location sees it: its two ends and the cubic between them.
#pragma once

#include "myriad/kernel/event/event_functions.hpp"
#include "myriad/kernel/stepper/dense_output.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

template <class Model, class R>
struct step_ends {
    using state = vec<R, n_state<Model>>;
    using event_values = vec<R, n_event<Model>>;

    inputs<Model, R> p;  // the other inputs of the event functions
    R t, h, t1;          // h = t1 - t, without t1's rounding
    state y, y1, slope, slope1;
    event_values g, g1;  // of the event functions

    step_ends() = default;
    MYRIAD_FUNCTION explicit step_ends(const inputs<Model, R>& given) : p(given), slope1{}, g{} {}

    /// The event functions at fraction theta of the step, on the cubic through its ends.
    MYRIAD_FUNCTION event_values values_at(R theta) const {
        return detail::evaluate_events<Model>(fma(theta, h, t), state_at(theta), p);
    }
    /// The same with their slopes per step.
    MYRIAD_FUNCTION vec<dual<R>, n_event<Model>> moving_values_at(R theta) const {
        const auto inside = detail::hermite_interpolation(y, y1, slope, slope1, h, dual<R>(theta, R(1)));
        return detail::evaluate_moving_events<Model>(dual<R>(fma(theta, h, t), h), inside, p);
    }
    /// The rounding errors of the event functions at the end: the state there is the sum of that at the start and of
    /// increments.
    MYRIAD_FUNCTION event_values roundings(event_place<Model, R>* place) const {
        state size;
        MYRIAD_UNROLL
        for (int c = 0; c < MYRIAD_LENGTH(n_state<Model>); ++c)
            size[c] = max(abs(y[c]), abs(y1[c])) + abs(h * slope[c]);
        return detail::event_roundings<Model>(t1, y1, size, p, place);
    }
    /// Slopes of the event functions along the solution, at the start and at the end.
    MYRIAD_FUNCTION event_values slopes() const { return detail::event_slopes<Model>(t, y, slope, p); }
    MYRIAD_FUNCTION event_values slopes1() const { return detail::event_slopes<Model>(t1, y1, slope1, p); }

    MYRIAD_FUNCTION state state_at(R theta) const {
        return detail::hermite_interpolation(y, y1, slope, slope1, h, theta);
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
