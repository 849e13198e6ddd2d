// SPDX-License-Identifier: MIT
// The step of a noisy path up to an event: when the first of the event functions is at zero, where the Wiener processes
// are then, and the step of the method that leads there. Rarely called, for one lane, on data in memory.
#pragma once

#include <cstdint>

#include "myriad/kernel/event/bridge_crossing.hpp"
#include "myriad/kernel/event/event_memory.hpp"
#include "myriad/kernel/stepper/stochastic_step.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// A step of one lane in which an event may happen, and the part of it up to the event.
template <class Model, class R>
struct bridge_step {
    using state = vec<R, n_state<Model>>;
    using reals = vec<R, n_event<Model>>;
    using processes = vec<R, n_wiener<Model>>;
    using flags = mask_set<bool, n_event<Model>>;

    inputs<Model, R> p;
    path_interval<R> over;
    R t, h;
    state y, slope;
    reals g0, g1, rate;  // the event functions at both ends, and their variance per time at the start
    reals tolerance;     // to which they are located
    flags crossed;       // those that have been at zero
    flags open;          // at zero at the start, and free of noise there: their slope tells where they go
    static constexpr int words = words_for(MYRIAD_CAPACITY(n_event<Model>));
    std::uint32_t falling[words], rising[words];  // which crossings are events

    int event;                   // the first, or -1
    R theta;                     // when, as a part of the step
    state y1;                    // the state then
    reals g;                     // and all event functions
    processes whole, at, along;  // the increments of the step, those up to there, and their direction to the event
    R gradient;                  // of the event's function in that direction
    R departs;                   // how an event that is open at the start goes away from zero: its sign
    R trial, off;                // the trial in hand: a part of the step, and how far it is off along the direction
    event_place<Model, R> place;
    int evaluations;  // of the drift

    MYRIAD_FUNCTION bool is_asked(int j, bool falls) const {
        return (((falls ? falling : rising)[j / 32] >> (j % 32)) & 1u) != 0;
    }
    /// The standard deviation of event function j over the step.
    MYRIAD_FUNCTION R deviation(int j) const { return sqrt(rate[j] * abs(h)); }
};

/// When function j, which is at zero at the start of the step, is there again: a parabola has its slope there and its
/// value at the end. Not before the end if it stays on the side to which it goes, or if that is not asked for.
template <class Model, class R>
MYRIAD_FUNCTION R return_of(const bridge_step<Model, R>& b, int j, R change) {
    const bool is_back = change * b.g1[j] < R(0) && b.is_asked(j, change > R(0));
    return is_back ? change / (change - b.g1[j]) : R(2);
}

/// Finds the first event of the step, and when it happens.
template <class Model, class R>
MYRIAD_FUNCTION void find_first(bridge_step<Model, R>* b) {
    b->event = -1;
    b->theta = R(2);
    vec<R, n_event<Model>> slopes{};
    if (b->open.any_of()) slopes = detail::event_slopes<Model>(b->t, b->y, b->slope, b->p);
    MYRIAD_ROLLED
    for (int j = 0; j < MYRIAD_LENGTH(n_event<Model>); ++j) {
        R theta = R(2);
        if (b->open[j]) {
            theta = detail::return_of(*b, j, slopes[j] * b->h);
        } else if (b->crossed[j]) {
            const auto z = detail::bridge_normals<R>(b->over, bridge_draw::passage, j);
            theta = detail::first_passage(b->g0[j], b->g1[j], b->rate[j] * abs(b->h), z[0], z[1]);
        }
        if (!(theta < b->theta)) continue;
        b->event = j;
        b->theta = theta;
        b->departs = slopes[j] * b->h;
    }
}

/// How many standard deviations noise goes at most.
template <class R>
inline constexpr R most_deviations = R(9);

/// Finds the increments of the processes up to the event: along the gradient of its function they bring that to zero,
/// if it changes by noise as at the start of the step and else evenly; across it they are those of a bridge.
template <class Model, class Method, class R>
MYRIAD_FUNCTION void find_increments(bridge_step<Model, R>* b) {
    constexpr auto m = n_wiener<Model>;
    if constexpr (uses_integrals<Method>) {
        b->whole = detail::path_integrals<m>(b->over).increment;
    } else {
        b->whole = detail::path_increments<m>(b->over);
    }
    const int j = b->event;
    const auto factors = Model::template diffusion<R>(b->t, b->y, b->p);
    b->gradient = sqrt(b->rate[j]);
    const R per_gradient = b->gradient > R(0) ? R(1) / b->gradient : R(0);
    R along_whole = R(0), along_at = R(0);
    const R spread = sqrt(b->theta * (R(1) - b->theta) * abs(b->h));
    MYRIAD_ROLLED
    for (int k = 0; k < MYRIAD_LENGTH(m); ++k) {
        constexpr int per_group = normals_per_block<R>;
        b->along[k] = per_gradient * detail::events_along<Model>(b->t, b->y, b->p, factors, k)[j].derivative;
        const R z = detail::bridge_normals<R>(b->over, bridge_draw::aside, k / per_group)[k % per_group];
        b->at[k] = fma(b->theta, b->whole[k], spread * z);
        along_whole = fma(b->along[k], b->whole[k], along_whole);
        along_at = fma(b->along[k], b->at[k], along_at);
    }
    const R evenly = b->g1[j] - b->g0[j] - b->gradient * along_whole;
    // No further from the mean than noise goes, if the function is anything but linear.
    const R mean = b->theta * along_whole, most = most_deviations<R> * spread;
    const R wanted = mean + min(max(-per_gradient * fma(b->theta, evenly, b->g0[j]) - mean, -most), most);
    MYRIAD_ROLLED
    for (int k = 0; k < MYRIAD_LENGTH(m); ++k) b->at[k] = fma(wanted - along_at, b->along[k], b->at[k]);
}

/// Takes the step to the trial. The processes go evenly to where they are at theta, and on to the end of the step, and
/// besides along the gradient.
template <class Model, class Method, class R>
MYRIAD_RARE_FUNCTION void step_to_trial(bridge_step<Model, R>* b) {
    constexpr auto m = n_wiener<Model>;
    constexpr bool with_integrals = uses_integrals<Method>;
    const R s = b->trial, h = s * b->h, t1 = b->t + h;
    const bool before = s <= b->theta;
    const R part = before ? (b->theta > R(0) ? s / b->theta : R(0)) : (s - b->theta) / (R(1) - b->theta);
    vec<R, m> increments;
    vec<R, with_integrals ? m : 0> integrals;
    MYRIAD_UNROLL_UP_TO(64, 16)
    for (int k = 0; k < MYRIAD_LENGTH(m); ++k) {
        const R evenly = before ? part * b->at[k] : fma(part, b->whole[k] - b->at[k], b->at[k]);
        increments[k] = fma(b->off, b->along[k], evenly);
        if constexpr (with_integrals) integrals[k] = R(0.5) * h * increments[k];  // the mean of a bridge's
    }
    b->y1 = b->y;
    if (h != R(0)) {
        const noisy_equation<Model, R, with_integrals> equation{b->p, increments, integrals};
        b->y1 = Method::step(equation, b->t, h, t1, b->y, b->slope);
    }
    b->g = detail::evaluate_events<Model>(t1, b->y1, b->p);
    b->evaluations += Method::stages;
}

/// Takes the step to the first event, so that its function is zero there as closely as its tolerance or rounding let it
/// be told: the functions need not be linear, nor the noise the same all the way.
template <class Model, class Method, class R>
struct located_passage {
    bridge_step<Model, R>* b;
    R side, enough;  // the sign of the function before the event, and how near to zero it is to come

    /// The function at a trial, positive before the event.
    MYRIAD_FUNCTION R value(R part, R off, bool& close) const {
        b->trial = part;
        b->off = off;
        detail::step_to_trial<Model, Method>(b);
        const R g = side * b->g[b->event];
        close = abs(g) <= enough;
        return g;
    }
    /// Ends the step where the function is zero, between a trial before the event and one behind it, `from` and `to`
    /// by their parts of the step or by how far they are off. By turns the secant and the middle, as functions may be
    /// anything but straight; of one that jumps, the last trial before the jump.
    MYRIAD_FUNCTION bool settle(R from, R f_from, R to, R f_to, bool in_time) const {
        R low = R(0), high = R(1);
        const auto trial = [&](R x, bool& close) MYRIAD_LAMBDA {
            const R at = fma(x, to - from, from);
            const R g = in_time ? value(at, R(0), close) : value(b->theta, at, close);
            if (close && in_time) b->theta = at;
            return g;
        };
        MYRIAD_ROLLED
        for (int i = 0; i < 256 && high - low > R(4) * epsilon_of<R> * high; ++i) {
            R x = high - f_to * (high - low) / (f_to - f_from);
            if (i % 2 != 0 || !(x > low && x < high)) x = R(0.5) * (low + high);
            bool close = false;
            const R f = trial(x, close);
            if (close) return true;
            (f > R(0) ? low : high) = x;
            (f > R(0) ? f_from : f_to) = f;
        }
        bool close = false;
        trial(low, close);
        if (in_time) b->theta = fma(low, to - from, from);
        return true;
    }
    /// Where noise moves the function most, the increments along its gradient give way.
    MYRIAD_RARE_FUNCTION bool by_noise() const {
        bool close = false;
        const R first = value(b->theta, R(0), close);
        if (close) return true;
        const R limit = most_deviations<R> * sqrt(abs(b->h)), way = first > R(0) ? -side : side;
        R near = R(0), f_near = first, far = min(abs(first) / b->gradient, limit);
        MYRIAD_ROLLED
        for (;;) {
            const R f = value(b->theta, way * far, close);
            if (close) return true;
            if ((f > R(0)) != (first > R(0)) && abs(f) < infinity_of<R>)
                return first > R(0) ? settle(way * near, f_near, way * far, f, false)
                                    : settle(way * far, f, way * near, f_near, false);
            if (!(far < limit) || !(abs(f) < infinity_of<R>)) return false;
            near = far;
            f_near = f;
            far = min(R(2) * far, limit);
        }
    }
    /// Else the time does, if the function changes its sign up to the end of the step.
    MYRIAD_RARE_FUNCTION bool in_time() const {
        bool close = false;
        const bool open = b->open[b->event];
        R from = R(0), f_from = side * b->g0[b->event];
        if (open) {  // from where it is away from zero
            from = b->theta;
            do {
                from = R(0.5) * from;
                f_from = value(from, R(0), close);
            } while (!(f_from > R(0)) && from > R(1e-6) * b->theta);
            if (!(f_from > R(0))) {  // never: the event is at once
                b->theta = from;
                return true;
            }
        }
        const R theta = b->theta, at_theta = value(theta, R(0), close);
        if (close) return true;
        if (at_theta < R(0)) return settle(from, f_from, theta, at_theta, true);
        const R at_end = value(R(1), R(0), close);
        if (!(at_end < R(0))) return false;
        return settle(theta, at_theta, R(1), at_end, true);
    }
};

/// Takes the step to the first event that can be located; if there is none, `event` is -1.
template <class Model, class Method, class R>
MYRIAD_RARE_FUNCTION void step_to_event(bridge_step<Model, R>* b) {
    b->evaluations = 1;
    b->slope = detail::evaluate_rhs<Model>(b->t, b->y, b->p);
    MYRIAD_ROLLED
    for (int tries = 0; tries < n_event<Model>; ++tries) {
        detail::find_first(b);
        if (b->event < 0) return;
        detail::find_increments<Model, Method>(b);
        const int j = b->event;
        const bool open = b->open[j];
        const R size = abs(open ? b->g1[j] : b->g0[j]);
        const located_passage<Model, Method, R> passage{b, (open ? b->departs : b->g0[j]) > R(0) ? R(1) : R(-1),
                                                        max(b->tolerance[j], R(4) * epsilon_of<R> * size)};
        const R change = abs(b->g1[j] - b->g0[j]);
        const bool is_noisy = !open && R(8) * b->deviation(j) > change;
        if ((is_noisy && passage.by_noise()) || passage.in_time()) return;
        b->crossed.set(j, false);  // a function that is anything but linear does not get there
    }
    b->event = -1;
}

/// What events on noisy paths keep and work on in a pack.
template <class Model, class R, int lanes>
requires(has_diffusion<Model>&& has_events<Model>) struct event_memories<Model, R, lanes> {
    vec<std::int32_t, n_event<Model>> lingered[lanes] = {};  // actions in a row that left the function on its surface
    bridge_step<Model, R> step;
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
