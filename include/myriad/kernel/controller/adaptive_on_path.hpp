// SPDX-License-Identifier: MIT
// Adaptive steps of stochastic equations. Steps end at multiples of their length, which is a cell of the path or a
// half, a quarter and so on of one, so that a rejected step is taken again along the same path, refined by its tree:
// nothing is drawn again, nothing is stored, and what was rejected leaves no trace but the length of the steps.
#pragma once

#include "myriad/kernel/controller/norm.hpp"
#include "myriad/kernel/controller/step_decision.hpp"
#include "myriad/kernel/methods/adaptive.hpp"
#include "myriad/kernel/state/integration_state.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// Stepping (see stepping.hpp) by halves and doubles.
template <class Model, class Method, class S>
struct adaptive_stepping_on_path {
    using R = real_of<S>;
    using mask = mask_of<S>;
    using C = control_of<S>;
    using L = real_of<C>;
    static constexpr auto n = n_state<Model>;
    static constexpr std::int32_t stagnation_interval = 0;
    static_assert(!remembers_errors<Method>,
                  "steps of stochastic equations are halved and doubled, by no controller that remembers errors: leave "
                  "out pi_control and pid_control");
    static_assert(!chooses_first_step<Method>,
                  "steps of stochastic equations begin with options::step or a cell of the path: leave out "
                  "automatic_first_step");
    /// The ratio of error to tolerance up to which a step is doubled, if the error grows like h^(3/2) and steps are to
    /// be nine tenths of the longest that the tolerance allows; the ratio up to which one halving is enough for a
    /// rejected step; and what each further halving divides it by.
    static constexpr double most_doubled = 0.30187, most_halved = 2.41495, factor_of_half = 2.82843;
    static constexpr int most_halvings = 4;

    const kernel_arguments<Model, R>& args;
    integration_state<Model, Method, S>& s;

    MYRIAD_FUNCTION void load(int i) {
        const std::int64_t index = s.instance[i];
        set_lane(s.data.h_next, i, args.h_next[index]);
        if constexpr (scales_tolerances<Method>) set_lane(s.steps.tolerance_scale, i, args.tolerance_scale[index]);
    }
    MYRIAD_FUNCTION void store(int i) const { args.h_next[s.instance[i]] = get_lane(s.steps.step, i); }

    MYRIAD_FUNCTION void choose_step(int i, std::int32_t phase) {
        const bool restart = !args.carry_step || phase == 0 || get_lane(s.data.h_next, i) == R(0);
        if (restart) set_lane(s.data.h_next, i, args.first_change > R(0) ? R(0) : args.step);
    }
    /// Where phases go back to t_begin, each has a path of its own.
    MYRIAD_FUNCTION void begin(int i, R t) {
        const std::int64_t index = s.instance[i];
        const R t_begin = args.t_begin != nullptr ? args.t_begin[index] : args.common_t_begin;
        set_lane(s.steps.base, i, t_begin);
        s.steps.path.set(i, args.first_index + index, args.carry_time ? 0 : args.phase[index]);
        detail::set_place(s.steps.from, i, detail::place_of_length(t - t_begin, args.noise.cell));
        set_lane(s.steps.last_not_finite, i, false);
        const R wanted = abs(get_lane(s.data.h_next, i));
        set_step(i, parts_within(wanted > R(0) ? wanted : args.noise.cell, parts_of_cell),
                 get_lane(s.data.t_end, i) < t);
    }
    MYRIAD_FUNCTION void move(int, R) {}
    MYRIAD_FUNCTION void resume(int, R) {}
    MYRIAD_FUNCTION R time(int i) const { return get_lane(s.data.t, i); }

    /// The next step of every lane: to the next multiple of its length, or to the next stop, if that comes before or
    /// little later.
    MYRIAD_FUNCTION void propose(const mask&) {
        s.steps.to = detail::moved(s.steps.from, s.steps.per_step);
        s.steps.node = s.steps.parts;
        s.h = s.steps.step;
        const S remaining = s.t_stop() - s.data.t;
        s.final_step = abs(remaining) <= abs(s.h) * S(R(1) + sliver);
        if (MYRIAD_UNLIKELY(any(s.running() & (s.final_step | s.steps.between))))
            for_each_lane(s.running() & (s.final_step | s.steps.between), [&](int i) MYRIAD_LAMBDA { cut(i); });
        s.steps.end = s.steps.base + length_of(s.steps.to);
        s.steps.end = select(s.final_step, s.t_stop(), s.steps.end);
    }

    MYRIAD_FUNCTION S end_time() const { return s.steps.end; }

    /// Accepts or rejects the trial of every lane and chooses the next step: rejected ones are halved up to four times
    /// at once, those that are not finite four times. Accepted ones are doubled if the error allows it and what follows
    /// begins at a multiple of twice the length.
    template <class EndStuck>
    MYRIAD_FUNCTION step_decision<S> judge(const trial_step<Method, S, n>& trial, const S&, mask valid,
                                           EndStuck&& end_stuck) {
        error_norm<S> error = detail::scaled_error<Model, Method>(args, s.data.y, s.h, trial);
        if constexpr (scales_tolerances<Method>)
            error.worst = static_cast<C>(error_ratio(S(error.worst), s.steps.tolerance_scale));
        valid = valid & error.finite;
        const mask within = valid & (error.worst <= C(L(1)));
        const mask accepted = s.running() & within, rejected = s.running() & !within;
        const mask small_error = accepted & (error.worst <= C(L(most_doubled)));
        if (any(rejected | small_error)) {
            for_each_lane(small_error, [&](int i) MYRIAD_LAMBDA { lengthen(i); });
            const mask finite = valid & (error.worst <= C(largest_of<L>));
            s.steps.last_not_finite = select(rejected, !finite, s.steps.last_not_finite);
            mask stuck = mask(false);
            for_each_lane(rejected, [&](int i) MYRIAD_LAMBDA {
                const L worst = get_lane(finite, i) ? get_lane(error.worst, i) : largest_of<L>;
                set_lane(stuck, i, !shorten(i, worst));
            });
            if (any(stuck)) end_stuck(stuck, mask(false));
        }
        return {accepted, s.steps.step};
    }
    MYRIAD_FUNCTION status failure_of(int i) const {
        return get_lane(s.steps.last_not_finite, i) ? status::not_finite : status::step_underflow;
    }

    MYRIAD_FUNCTION mask advance(const mask& accepted, const S& t1, const mask&) {
        s.data.t = select(accepted, t1, s.data.t);
        s.steps.from.cell = select(accepted, s.steps.to.cell, s.steps.from.cell);
        s.steps.from.part = select(accepted, s.steps.to.part, s.steps.from.part);
        for_each_lane(accepted & (s.final_step | s.steps.between), [&](int i) MYRIAD_LAMBDA { set_between(i); });
        return accepted & (t1 == s.data.t_end);
    }

    MYRIAD_FUNCTION bool stagnates(int) { return false; }

private:
    static constexpr R sliver = R(1e-6);  // of a step: added to the last one
    static constexpr R part = R(1.0 / parts_of_cell);

    MYRIAD_FUNCTION R length_of(std::int32_t parts) const { return args.noise.cell * (static_cast<R>(parts) * part); }
    /// The time from the beginning of the path to a place.
    MYRIAD_FUNCTION R length_of_lane(const path_place<R>& place) const {
        return fma(static_cast<R>(place.cell), args.noise.cell, length_of(place.part));
    }
    MYRIAD_FUNCTION S length_of(const path_place<S>& place) const {
        if constexpr (is_pack<S>) {
            S length = S(R(0));
            MYRIAD_UNROLL
            for (int i = 0; i < lanes_of<S>; ++i) set_lane(length, i, length_of_lane(detail::get_place(place, i)));
            return length;
        } else {
            return length_of_lane(place);
        }
    }
    /// The largest part of a cell, halved again and again, that is no longer than a time, nor than so many parts.
    MYRIAD_FUNCTION std::int32_t parts_within(R length, std::int32_t parts) const {
        length = min(length, args.maximum_step) * (R(1) + sliver);
        while (parts > 1 && length_of(parts) > length) parts /= 2;
        return parts;
    }
    MYRIAD_FUNCTION void set_step(int i, std::int32_t parts, bool backwards) {
        const bool whole = parts == parts_of_cell;
        path_place<R> per_step{whole ? 1 : 0, whole ? 0 : parts};
        if (backwards) per_step = {-1, whole ? 0 : parts_of_cell - parts};
        detail::set_place(s.steps.per_step, i, per_step);
        set_lane(s.steps.parts, i, parts);
        set_lane(s.steps.step, i, backwards ? -length_of(parts) : length_of(parts));
        set_lane(s.data.h_next, i, get_lane(s.steps.step, i));
        set_between(i);
    }
    MYRIAD_FUNCTION std::int32_t parts_of(int i) const { return static_cast<std::int32_t>(get_lane(s.steps.parts, i)); }
    MYRIAD_FUNCTION bool goes_backwards(int i) const { return get_lane(s.steps.step, i) < R(0); }
    MYRIAD_FUNCTION void set_between(int i) {
        set_lane(s.steps.between, i, detail::get_place(s.steps.from, i).part % parts_of(i) != 0);
    }

    /// The trial of a lane that ends at a stop, or begins between multiples of the step.
    MYRIAD_FUNCTION void cut(int i) {
        const path_place<R> from = detail::get_place(s.steps.from, i);
        const R t = get_lane(s.data.t, i), base = get_lane(s.steps.base, i), remaining = get_lane(s.t_stop(), i) - t;
        path_place<R> to = detail::get_place(s.steps.to, i);
        R h = get_lane(s.steps.step, i);
        const std::int32_t beyond = from.part % parts_of(i);
        if (beyond != 0) {
            const std::int32_t left = goes_backwards(i) ? beyond : parts_of(i) - beyond;
            to = goes_backwards(i) ? path_place<R>{from.cell, from.part - left}
                                   : detail::moved(from, path_place<R>{0, left});
            h = base + length_of_lane(to) - t;
        }
        const bool final = abs(remaining) <= abs(h) * (R(1) + sliver);
        bool is_node = beyond == 0;
        if (final) {
            const path_place<R> stop = detail::place_of_length(get_lane(s.t_stop(), i) - base, args.noise.cell);
            is_node = is_node && stop.cell == to.cell && stop.part == to.part;
            to = stop;
            h = remaining;
        }
        set_lane(s.final_step, i, final);
        detail::set_place(s.steps.to, i, to);
        set_lane(s.steps.node, i, is_node ? parts_of(i) : 0);
        set_lane(s.h, i, h);
    }
    /// Doubles the step of lane i for what begins where the trial ends.
    MYRIAD_FUNCTION void lengthen(int i) {
        const std::int32_t parts = parts_of(i);
        if (parts == parts_of_cell || detail::get_place(s.steps.to, i).part % (2 * parts) != 0) return;
        if (parts_within(length_of(2 * parts), 2 * parts) == 2 * parts) set_step(i, 2 * parts, goes_backwards(i));
    }
    /// Halves the step of lane i. Returns false if it is as short as it may be.
    MYRIAD_FUNCTION bool shorten(int i, L worst) {
        R length = min(abs(get_lane(s.h, i)), abs(get_lane(s.steps.step, i)));
        for (int k = 0; k < most_halvings; ++k, worst /= L(factor_of_half)) {
            length *= R(0.5);
            if (worst <= L(most_halved)) break;
        }
        const std::int32_t parts = parts_within(max(length, args.minimum_step), parts_of(i));
        if (parts == parts_of(i)) return false;
        set_step(i, parts, goes_backwards(i));
        return true;
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
