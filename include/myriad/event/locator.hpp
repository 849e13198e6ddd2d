// SPDX-License-Identifier: MIT
// Finds events: which functions crossed zero in a trial step, the earliest crossing on the step's interpolant, and whether
// a step redone to that time has arrived. A lane's trial is never committed beyond a crossing; its other lanes go on.
//
// A crossing is a change of side: the side an event function was last seen on, beyond its tolerance, is remembered, so a
// function that lingers within the tolerance neither fires twice nor is lost, and one that only touches zero does not
// fire. Where a step starts within the tolerance, the slope of the function along the solution (by dual numbers) tells
// where it is heading, and a root at the start is divided out, so that a short flight after an impact is not missed.
#pragma once

#include "myriad/event/event_state.hpp"
#include "myriad/event/root_finder.hpp"
#include "myriad/integrator/state.hpp"
#include "myriad/stepper/dense_output.hpp"

namespace myriad::inline MYRIAD_TARGET {

/// Locates the events of one trial step of a pack.
template <class Model, class Method, class S>
struct event_locator {
    using R = real_of<S>;
    using mask = mask_of<S>;
    static constexpr int n = n_state<Model>;
    static constexpr int m = n_event<Model>;
    using values = vec<S, m>;
    using masks = vec<mask, m>;
    /// Redone steps per event: a step halved that often is as long as the rounding of its ends.
    static constexpr int most_tries = 80;

    const kernel_arguments<Model, R>& args;
    integration_state<Model, Method, S>& s;
    event_state<Model, S>& e;

    /// Forgets a location under way, such as that of a trial that failed its error test.
    MYRIAD_FUNCTION void forget(const mask& lanes) { e.locating = e.locating & !lanes; }

    /// Takes the event values at the start of a phase, which go on with the sides that the phase before left.
    MYRIAD_FUNCTION void begin(const mask& lanes) {
        const values g = evaluate_events<Model>(s.now(), s.data.y, s.data);
        masks on_jump;
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            on_jump[j] = lanes & (abs(e.side[j]) == S(R(event_sides::on_jump))) & (abs(g[j]) > S(args.event[j].tolerance));
            adopt(lanes, j, g[j], abs(e.side[j]) > S(R(1)));
            e.left[j] = e.left[j] | lanes;
        }
        const mask jumps = any_event(on_jump);
        if (MYRIAD_UNLIKELY(any(jumps))) {
            s.renew_slope(jumps);
            look_beyond(on_jump);
        }
    }

    /// Takes the event values after hooks changed what they depend on. A function within its tolerance keeps its side,
    /// unless the hook moved it there: then the slope at the next step decides.
    MYRIAD_FUNCTION void restart(const mask& lanes) {
        const values g = evaluate_events<Model>(s.now(), s.data.y, s.data);
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) adopt(lanes & !e.firing[j], j, g[j], abs(e.value[j]) > S(args.event[j].tolerance));
    }

    /// The same after the actions of firing events, with the slopes of the state they left (`s.slope`). A function that
    /// fired is on the side it is heading for. Where its slope is zero, it rests on the side it came from if an action
    /// changed it, and passed if none did. Where it was still moving away when it fired, as in a flight too short for the
    /// resolution of the state, an action that turned it round must not send it through the surface. One that jumps fired
    /// right before the jump: a look ahead tells whether it is about to pass it.
    MYRIAD_FUNCTION void settle(const mask& lanes) {
        const values g = evaluate_events<Model>(s.now(), s.data.y, s.data);
        const values slope = event_slopes<Model>(s.now(), s.data.y, s.slope, s.data);
        masks on_jump;
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            const mask fired = lanes & e.firing[j];
            const S from = e.side[j];
            const mask moved = g[j] != e.value[j];
            const mask beyond = abs(g[j]) > S(args.event[j].tolerance);
            const mask jumped = moved & beyond;
            on_jump[j] = fired & beyond;
            const mask acted = moved | (slope[j] != e.heading[j]);
            const S ahead = sign_of(slope[j]) * sign_of(s.h);
            const mask unresolved = from * sign_of(e.heading[j]) * sign_of(s.h) > S(R(0));
            const mask rests = (ahead == S(R(0))) & !e.left[j];
            S side = select(unresolved | (ahead == S(R(0))), select(acted | rests, from, -from), ahead);
            side = select(jumped, sign_of(g[j]), side);
            e.side[j] = select(fired, side, e.side[j]);
            e.value[j] = select(fired, g[j], e.value[j]);
            e.left[j] = (e.left[j] & !fired) | (lanes & jumped);
        }
        if (MYRIAD_UNLIKELY(any(any_event(on_jump)))) look_beyond(on_jump);
    }

    /// Events of which a crossing from the given sides is asked for.
    MYRIAD_FUNCTION masks crossings(const mask& lanes, const values& side, const values& g) const {
        masks crossed;
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            crossed[j] = lanes & (S(args.event[j].direction) * side[j] <= S(R(0))) &
                         (side[j] * g[j] < S(-args.event[j].tolerance));
        }
        return crossed;
    }

    /// Looks at an accepted trial that ends at t1 with the event values g1. Lanes that crossed, or stopped short of
    /// their target, are set up for a redone step and taken out of `accepted`; events that have happened are put in
    /// `firing`, either at the end of the trial or, in lanes taken out of `accepted` as well, at its start.
    MYRIAD_FUNCTION void locate(const rk_trial<Method, S, n>& trial, const S& t1, const values& g1, mask& accepted) {
        if constexpr (lanes_of<S> > 1) {
            // Most steps change nothing but the values; below, a pack goes through all that one of its lanes needs. Nothing
            // fires then: what fired before was cleared when it was acted on.
            if (args.sub_samples <= 1 && !any(accepted & !undisturbed(g1))) {
                MYRIAD_UNROLL
                for (int j = 0; j < m; ++j) e.value[j] = select(accepted, g1[j], e.value[j]);
                return;
            }
            // Copies, so that only they and not the caller's registers need an address.
            const rk_trial<Method, S, n> trial_copy = trial;
            const S t1_copy = t1;
            const values g1_copy = g1;
            mask still_accepted = accepted;
            look_out_of_line(trial_copy, t1_copy, g1_copy, still_accepted);
            accepted = still_accepted;
        } else {
            look(trial, t1, g1, accepted);
        }
    }

private:
    /// Out of line, as the loop would carry what it needs through every step.
    [[gnu::noinline]] void look_out_of_line(const rk_trial<Method, S, n>& trial, const S& t1, const values& g1, mask& accepted) {
        look(trial, t1, g1, accepted);
    }

    /// The same where something may have happened.
    MYRIAD_FUNCTION void look(const rk_trial<Method, S, n>& trial, const S& t1, const values& g1, mask& accepted) {
        find_open_sides(accepted);
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) e.firing[j] = mask(false);

        values side = e.side;
        masks crossed = crossings(accepted, side, g1);
        const bool look_inside = args.sub_samples > 1;
        mask crossing = any_event(crossed);
        if (MYRIAD_UNLIKELY(look_inside || any(crossing | e.locating | (accepted & s.final_step)))) {
            step_data<Method, S, n> step{s.now(), s.h, s.data.y, trial, s.slope, {}};
            mask wanted = look_inside ? accepted : crossing | (accepted & e.locating);
            MYRIAD_UNROLL
            for (int j = 0; j < m; ++j)
                wanted = wanted | (accepted & s.final_step & (abs(g1[j]) <= S(args.event[j].tolerance)));
            if (any(wanted)) complete(step, t1, wanted);
            window w{S(R(0)), S(R(1)), e.value, g1};
            if (look_inside) {
                crossed = scan(step, accepted, side, w);
                crossing = any_event(crossed);
            }
            finish_located(step, t1, g1, side, crossing, accepted);
            if (any(crossing)) begin_located(step, side, crossed, crossing, w, accepted);
        }
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            const S seen = select(abs(g1[j]) > S(args.event[j].tolerance), sign_of(g1[j]), side[j]);
            e.side[j] = select(accepted, seen, e.side[j]);
            e.left[j] = e.left[j] | (accepted & (abs(g1[j]) > S(args.event[j].tolerance)));
            e.value[j] = select(accepted, g1[j], e.value[j]);
        }
    }

    /// Lanes on their way to no event, whose event functions have left their tolerance and end the trial beyond it, on the side
    /// where they were.
    MYRIAD_FUNCTION mask undisturbed(const values& g1) const {
        mask quiet = !e.locating;
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) quiet = quiet & e.left[j] & (e.side[j] * g1[j] > S(args.event[j].tolerance));
        return quiet;
    }

    /// Puts functions on the side that they have a little ahead, further than the rounding of t and of the state: that is
    /// beyond a jump which a step was located to, and which the state is heading for. Needs the slope.
    MYRIAD_FUNCTION void look_beyond(const masks& on_jump) {
        constexpr R fraction = std::is_same_v<R, float> ? R(0x1p-12) : R(0x1p-26);
        const S t = s.now();
        const S little = fma(S(fraction), abs(s.data.h_next), S(R(64) * epsilon_of<R>) * abs(t));
        const S ahead = copysign(little, s.data.t_end - t);
        vec<S, n> y;
        MYRIAD_UNROLL
        for (int c = 0; c < n; ++c) y[c] = fma(ahead, s.slope[c], s.data.y[c]);
        const values g = evaluate_events<Model>(t + ahead, y, s.data);
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            const mask beyond = on_jump[j] & (abs(g[j]) > S(args.event[j].tolerance));
            e.side[j] = select(beyond, sign_of(g[j]), e.side[j]);
            e.value[j] = select(beyond, g[j], e.value[j]);
        }
    }

    MYRIAD_FUNCTION void adopt(const mask& lanes, int j, const S& g, const mask& open) {
        const mask beyond = abs(g) > S(args.event[j].tolerance);
        const S side = select(beyond, sign_of(g), select(open, S(R(0)), e.side[j]));
        e.side[j] = select(lanes, side, e.side[j]);
        e.value[j] = select(lanes, g, e.value[j]);
    }

    /// The part of the step that holds a lane's first crossings, in fractions of the step, with the values at its ends.
    struct window {
        S low, high;
        values g_low, g_high;
    };

    /// Settles sides that are open by where the function is heading.
    MYRIAD_FUNCTION void find_open_sides(const mask& accepted) {
        mask open = mask(false);
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) open = open | (e.side[j] == S(R(0)));
        open = open & accepted;
        if (MYRIAD_UNLIKELY(any(open))) {
            const values slope = event_slopes<Model>(s.now(), s.data.y, s.slope, s.data);
            MYRIAD_UNROLL
            for (int j = 0; j < m; ++j) {
                const S heading = sign_of(slope[j]) * sign_of(s.h);
                e.side[j] = select(open & (e.side[j] == S(R(0))), heading, e.side[j]);
            }
        }
    }

    /// f at the end of the trial, free for methods whose last stage is there, one more evaluation for others; and what else
    /// the interpolant needs.
    MYRIAD_FUNCTION void complete(step_data<Method, S, n>& step, const S& t1, const mask& wanted) {
        if constexpr (Method::first_same_as_last) {
            step.slope_end = step.trial.slope_end();
        } else {
            step.slope_end = evaluate_rhs<Model>(t1, step.trial.y, s.data);
            s.extra_evaluations = count_where(wanted, s.extra_evaluations);
        }
        if constexpr (extra_stages<Method> > 0) {
            s.extra_evaluations = count_where(wanted, s.extra_evaluations, extra_stages<Method>);
            complete_interpolant<Model>(step, s.data);
        }
    }

    MYRIAD_FUNCTION values values_at(const step_data<Method, S, n>& step, const S& theta) const {
        return evaluate_events<Model>(fma(theta, step.h, step.t), interpolate(step, theta), s.data);
    }

    /// Looks at `sub_samples` points of the step for the first that shows a crossing; follows the sides up to there.
    MYRIAD_FUNCTION masks scan(const step_data<Method, S, n>& step, const mask& accepted, values& side, window& w) {
        masks crossed;
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) crossed[j] = mask(false);
        mask open = accepted;
        for (int k = 1; k <= args.sub_samples; ++k) {
            const bool last = k == args.sub_samples;
            const S theta = S(static_cast<R>(k) / static_cast<R>(args.sub_samples));
            const values g = last ? w.g_high : values_at(step, theta);
            const masks now = crossings(open, side, g);
            const mask found = any_event(now);
            open = open & !found;
            MYRIAD_UNROLL
            for (int j = 0; j < m; ++j) {
                crossed[j] = crossed[j] | now[j];
                const mask beyond = abs(g[j]) > S(args.event[j].tolerance);
                side[j] = select(open & beyond, sign_of(g[j]), side[j]);
                e.left[j] = e.left[j] | (open & beyond);
                w.g_low[j] = select(open & !mask(last), g[j], w.g_low[j]);
                w.g_high[j] = select(found, g[j], w.g_high[j]);
            }
            w.low = select(open & !mask(last), theta, w.low);
            w.high = select(found, theta, w.high);
        }
        return crossed;
    }

    /// The earliest crossing of each lane of `crossing`, as a fraction of the step; sets the target.
    MYRIAD_FUNCTION S earliest(const step_data<Method, S, n>& step, const values& side, masks crossed,
                               const mask& crossing, window w) {
        const values slope = event_slopes<Model>(step.t, step.y, step.trial.k[0], s.data);
        values tolerance;
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) tolerance[j] = S(args.event[j].tolerance);
        mask open = crossing;
        masks which = first_event(crossed);
        // Each pass finds the root of one event and cuts the window there; an event that crosses earlier gets a pass.
        for (int pass = 0; pass < m && any(open); ++pass) {
            const S from = pick(which, side);
            const S near = pick(which, tolerance);
            const S g_low = from * pick(which, w.g_low);
            const S g_high = from * pick(which, w.g_high);
            // heading > 0: away from the crossing, in units of the event function per step
            const S heading = from * pick(which, slope) * step.h;
            const mask at_start = w.low == S(R(0));
            const mask on_surface = abs(g_low) <= near;
            const mask leaves = at_start & on_surface & (heading > S(R(0)));
            const mask already = on_surface & !leaves & (at_start | (g_low <= S(R(0))));
            const bracket<S> b{w.low, w.high, select(leaves, heading, g_low),
                               select(leaves, (g_high - g_low) / w.high, g_high)};
            const S small = S(R(0.1)) * near;
            S root = find_root(b, open & !already, [&](const S& theta, mask& close) MYRIAD_LAMBDA {
                const S g = from * pick(which, values_at(step, theta));
                const S rise = g - g_low;
                const S divided = rise / theta;
                close = select(leaves, (abs(rise) <= small) & (abs(divided) <= S(R(0.01)) * heading), abs(g) <= small);
                return select(leaves, divided, g);
            });
            root = select(already, w.low, root);
            const values g_root = values_at(step, root);
            w.high = select(open, root, w.high);
            MYRIAD_UNROLL
            for (int j = 0; j < m; ++j) {
                w.g_high[j] = select(open, g_root[j], w.g_high[j]);
                e.target[j] = select(open, which[j], e.target[j]);
            }
            masks sooner = crossings(open, side, w.g_high);
            MYRIAD_UNROLL
            for (int j = 0; j < m; ++j) sooner[j] = sooner[j] & !which[j];
            open = any_event(sooner);
            which = first_event(sooner);
        }
        return w.high;
    }

    /// Sets up lanes whose trial crossed: a step redone to the crossing, or the event at the start of the step.
    MYRIAD_FUNCTION void begin_located(const step_data<Method, S, n>& step, const values& side, const masks& crossed,
                                       const mask& crossing, const window& w, mask& accepted) {
        accepted = accepted & !crossing;
        s.located = count_where(crossing, s.located);
        S length = earliest(step, side, crossed, crossing, w) * step.h;
        const mask again = crossing & e.locating;
        e.h_resume = select(crossing & !again, s.data.h_next, e.h_resume);
        e.h_before = select(crossing & !again, S(R(0)), e.h_before);
        e.h_beyond = select(crossing, step.h, e.h_beyond);
        e.tries = select(again, e.tries + S(R(1)), select(crossing, S(R(0)), e.tries));
        // Where the interpolant has led beyond the crossing again and again, halve what is left of the step.
        const mask slow = again & ((e.tries >= S(R(10))) | (abs(length) <= abs(e.h_before)));
        length = select(slow, S(R(0.5)) * (e.h_before + step.h), length);
        const mask narrow = abs(step.h - e.h_before) <= S(R(0.5) * epsilon_of<R>) * abs(step.t + step.h);
        length = select(again & (narrow | (e.tries >= S(R(most_tries)))), e.h_before, length);
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) e.crossed[j] = select(crossing, crossed[j] | (again & e.crossed[j]), e.crossed[j]);
        const mask here = crossing & (length == S(R(0)));
        redo(crossing & !here, length);
        forget(here);
        if (any(here)) {
            const values slope = event_slopes<Model>(step.t, step.y, step.trial.k[0], s.data);
            MYRIAD_UNROLL
            for (int j = 0; j < m; ++j) {
                const mask fires =
                    here & (e.target[j] | (e.crossed[j] & (abs(e.value[j]) <= S(args.event[j].tolerance))));
                e.firing[j] = e.firing[j] | fires;
                e.heading[j] = select(here, slope[j], e.heading[j]);
            }
            if constexpr (is_adaptive<Method>) s.data.h_next = select(here, e.h_resume, s.data.h_next);
        }
    }

    /// Looks at lanes that did not cross: has a redone step arrived, or did it stop short; does the domain end on a root?
    MYRIAD_FUNCTION void finish_located(const step_data<Method, S, n>& step, const S& t1, const values& g1,
                                        const values& side, const mask& crossing, mask& accepted) {
        const mask arrived = accepted & e.locating & !crossing;
        const mask domain_end = accepted & s.final_step & !crossing & !e.locating;
        if (any(arrived)) arrive(step, t1, g1, side, arrived, accepted);
        if (any(domain_end)) end_on_root(step, t1, g1, side, domain_end);
    }

    /// Redone steps that ended before their crossing: within the tolerance their events have happened; others go further.
    MYRIAD_FUNCTION void arrive(const step_data<Method, S, n>& step, const S& t1, const values& g1, const values& side,
                                mask arrived, mask& accepted) {
        const values slope = event_slopes<Model>(t1, step.trial.y, step.slope_end, s.data);
        values tolerance;
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) tolerance[j] = S(args.event[j].tolerance);
        const S from = pick(e.target, side);
        const S gap = from * pick(e.target, g1);
        const mask narrow = abs(e.h_beyond - step.h) <= S(R(4) * epsilon_of<R>) * abs(t1);
        const mask short_of = arrived & (gap > pick(e.target, tolerance)) & !narrow & (e.tries < S(R(most_tries)));
        if (any(short_of)) {
            const S newton = step.h - gap / (from * pick(e.target, slope));
            const mask inside = (e.tries < S(R(10))) & (abs(newton) > abs(step.h)) & (abs(newton) < abs(e.h_beyond)) &
                                (newton * step.h > S(R(0)));
            e.tries = count_where(short_of, e.tries);
            e.h_before = select(short_of, step.h, e.h_before);
            redo(short_of, select(inside, newton, S(R(0.5)) * (step.h + e.h_beyond)));
            s.located = count_where(short_of, s.located);
            accepted = accepted & !short_of;
            arrived = arrived & !short_of;
        }
        const values g_middle = values_at(step, S(R(0.5)));
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            const S near = tolerance[j];
            const mask together = e.crossed[j] & (abs(g1[j]) <= near) & (side[j] * slope[j] * step.h < S(R(0)));
            e.firing[j] = arrived & (e.target[j] | together);
            e.heading[j] = slope[j];
            e.left[j] = e.left[j] | (arrived & (abs(g_middle[j]) > near));
        }
        forget(arrived);
        if constexpr (is_adaptive<Method>) s.data.h_next = select(arrived, e.h_resume, s.data.h_next);
        s.slope_end = step.slope_end;
        s.slope_end_known = arrived;
    }

    /// Functions within their tolerance, and at zero or heading for it, where the domain ends: their events happen there.
    MYRIAD_FUNCTION void end_on_root(const step_data<Method, S, n>& step, const S& t1, const values& g1,
                                     const values& side, const mask& domain_end) {
        const values slope = event_slopes<Model>(t1, step.trial.y, step.slope_end, s.data);
        MYRIAD_UNROLL
        for (int j = 0; j < m; ++j) {
            const S g = side[j] * g1[j];
            const mask fires = domain_end & (S(args.event[j].direction) * side[j] <= S(R(0))) & (side[j] != S(R(0))) &
                               (abs(g) <= S(args.event[j].tolerance)) &
                               ((g <= S(R(0))) | (side[j] * slope[j] * step.h < S(R(0))));
            e.heading[j] = select(fires, slope[j], e.heading[j]);
            e.firing[j] = e.firing[j] | fires;
        }
    }

    MYRIAD_FUNCTION void redo(const mask& lanes, const S& length) {
        e.locating = e.locating | lanes;
        e.h_redo = select(lanes, length, e.h_redo);
    }
};

}  // namespace myriad::inline MYRIAD_TARGET
