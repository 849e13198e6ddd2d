// SPDX-License-Identifier: MIT
// Summaries of observed quantities along the solution: extrema, their times and integrals over the phase, computed on
// the interpolant of each committed step. Their current values are stored only in their accessories. Only in kernels of
// models that declare `summaries`.
#pragma once

#include "myriad/kernel/scalar/dual.hpp"
#include "myriad/kernel/scalar/root_finder.hpp"
#include "myriad/kernel/state/inside_step.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// A committed step as the summaries see it: its interpolant, with the term that raises a cubic to order four.
template <class Method, class S, extent n>
struct observed_step {
    // The cubic Hermite polynomial is of lower order than the steps of a method of order five. One more evaluation
    // raises it: the state at one point gives a slope there that is accurate to order four.
    static constexpr bool bends = !has_own_interpolant<Method> && (Method::order > 4);

    step_data<Method, S, n> data;
    vec<S, bends ? n : 0> bend;

    /// State at t + theta h; for a dual theta, with its derivative.
    template <class T>
    MYRIAD_FUNCTION vec<T, n> at(const T& theta) const {
        vec<T, n> y = detail::interpolate(data, theta);
        if constexpr (bends) {
            const T bump = theta * (S(real_of<S>(1)) - theta);
            MYRIAD_UNROLL
            for (int c = 0; c < n; ++c) y[c] = fma(bump * bump, bend[c], y[c]);
        }
        return y;
    }
};

/// An observer: see observers.hpp.
template <class Model, class Method, class S>
struct summariser {
    using R = real_of<S>;
    using mask = mask_of<S>;
    static constexpr auto n = n_state<Model>;
    static constexpr auto m = n_observed<Model>;
    static constexpr bool watches = has_summaries<Model>;
    static constexpr bool changes_inputs = sees_summaries<Model>;
    static constexpr bool integrates = summarises_any<Model, over_phase::integral>;
    using step_type = observed_step<Method, S, n>;
    using values = vec<S, m>;
    using slopes = vec<dual<S>, m>;

    struct memory {};  // all is in accessories

    const kernel_arguments<Model, R>& args;
    integration_state<Model, Method, S>& s;
    memory& own;

    MYRIAD_FUNCTION void begin(int i) {
        const lane_data<Model, R> one = detail::extract_lane(s.data, i);
        const inputs<Model, R>& p = one;
        if constexpr (has_delays<Model>) detail::recall<Model>(one.t, one.y, p);
        const vec<R, m> q = Model::template observe<R>(one.t, one.y, p);
        wait_for_readers();
        static_for<0, n_summary<Model>>([&](auto r) MYRIAD_LAMBDA {
            constexpr unmarked_summary what = summary_at<Model, decltype(r)::value>;
            constexpr bool time = what.kind == over_phase::time_of_maximum || what.kind == over_phase::time_of_minimum;
            const R first = time ? one.t : (what.kind == over_phase::integral ? R(0) : q[what.quantity]);
            if (keeps<what.quantity>()) set_lane(receiver<what.accessory>(), i, first);
        });
        team_for<Model>::synchronise();  // stop times may read them
    }

    /// Updates the summaries with the accepted steps. Returns the lanes in which an accessory has changed.
    MYRIAD_FUNCTION mask see(const accepted_step<Model, Method, S>& seen) {
        const auto& trial = seen.trial;
        const S& t1 = seen.t1;
        const mask& accepted = seen.accepted;
        const auto before = s.data.accessory;
        if constexpr (sees_summaries<Model> && team_size < Model >> 1) {
            inputs<Model, S> now = s.data;
            as_part<Model>::template keep_inputs<R>(now);
        }
        step_type step{seen.ends(), {}};
        if constexpr (interpolates_with_slope_end<Method> ||
                      (seeks_extrema<Model> && interpolates_between_slopes<Method>))
            detail::ensure_slope_end<Model>(s, step.data, t1, accepted);
        const slopes first = at_end<0>(step, step.data.t, step.data.y), last = at_end<1>(step, t1, trial.y);
        if constexpr (integrates) know_interpolant(step, accepted);

        wait_for_readers();
        mask search = mask(false);
        static_for<0, m>([&](auto j) MYRIAD_LAMBDA {
            constexpr int q = decltype(j)::value;
            if constexpr (extreme<q, over_phase::maximum> || extreme<q, over_phase::minimum>) {
                consider<q>(accepted, after_event(first, step.data), step.data.t);
                consider<q>(accepted, last, t1);
                search = search | (accepted & may_turn(first[q], last[q]));
            }
        });
        if (MYRIAD_UNLIKELY(any(team_for<Model>::any(search)))) {
            if constexpr (is_pack<S>) {
                // Copies, so that the caller's variables need no address and stay in registers.
                const trial_step<Method, S, n> trial_copy = trial;
                step_type copy{
                    {step.data.t, step.data.h, step.data.y, trial_copy, step.data.slope_end, step.data.extra},
                    step.bend};
                search_out_of_line(copy, first, last, search);
            } else {
                search_inside(step, first, last, search);
            }
        }
        if constexpr (integrates) integrate_step(step, first, last, accepted);

        mask changed = mask(false);
        if constexpr (sees_summaries<Model>) {
            MYRIAD_UNROLL
            for (int a = 0; a < n_accessory<Model>; ++a)
                changed = changed | (accepted & differs_in_bits(before[a], s.data.accessory[a]));
            if constexpr (team_size < Model >> 1)
                changed = accepted & team_for<Model>::any(as_part<Model>::template inputs_differ<R>());
        }
        return changed;
    }

private:
    /// Waits until all threads of a team have read the accessories, of which this thread is about to write some.
    static MYRIAD_FUNCTION void wait_for_readers() {
        if constexpr (sees_summaries<Model>) team_for<Model>::synchronise();
    }

    template <int q, over_phase kind>
    static constexpr bool extreme = summarises<Model>(q, kind);

    /// Whether this thread keeps the summaries of its quantity q. In a team, it does for quantities of its own units.
    template <int q>
    static MYRIAD_FUNCTION bool keeps() {
        if constexpr (team_size<Model> == 1) {
            return true;
        } else {
            return as_part<Model>::keeps(q);
        }
    }
    /// The accessory that receives a summary.
    template <int number>
    MYRIAD_FUNCTION S& receiver() const {
        if constexpr (team_size<Model> == 1) {
            return s.data.accessory[number];
        } else {
            return as_part<Model>::template receiver<S>(number);
        }
    }

    /// The quantities at theta = `end`, with their slopes along the solution per step.
    template <int end>
    MYRIAD_FUNCTION slopes at_end(const step_type& step, const S& t, const vec<S, n>& y) const {
        vec<dual<S>, n> moving;
        if constexpr (!seeks_extrema<Model>) {
            MYRIAD_UNROLL
            for (int c = 0; c < n; ++c) moving[c] = dual<S>(y[c]);
        } else if constexpr (interpolates_between_slopes<Method>) {
            const vec<S, n>& slope = end == 0 ? step.data.trial.slope_start() : step.data.slope_end;
            MYRIAD_UNROLL
            for (int c = 0; c < n; ++c) moving[c] = dual<S>(y[c], step.data.h * slope[c]);
        } else {
            moving = detail::interpolate(step.data, dual<S>(S(R(end)), S(R(1))));
            MYRIAD_UNROLL
            for (int c = 0; c < n; ++c) moving[c].value = y[c];
        }
        return observe(dual<S>(t, step.data.h), moving);
    }
    template <class T>
    MYRIAD_FUNCTION vec<T, m> observe(const T& t, const vec<T, n>& y) const {
        const inputs<Model, S>& p = s.data;
        if constexpr (has_delays<Model> && std::is_same_v<T, S>) detail::recall<Model>(t, y, p);
        if constexpr (has_delays<Model> && !std::is_same_v<T, S>)
            return Model::template observe<T>(t, y, detail::moving_past<Model>(t, y, p));
        else
            return Model::template observe<T>(t, y, p);
    }
    template <class T>
    MYRIAD_FUNCTION vec<T, m> observe_at(const step_type& step, const T& theta) const {
        return observe<T>(fma(theta, step.data.h, step.data.t), step.at(theta));
    }

    /// Computes the stages that the interpolant needs; the slope at the end must be set.
    MYRIAD_FUNCTION void know_interpolant(step_type& step, const mask& lanes) {
        detail::ensure_interpolant<Model>(s, step.data, lanes);
        if constexpr (step_type::bends) {
            // The bump theta^2 (1 - theta)^2 is steepest here and, by symmetry, at 1 - c.
            constexpr R c = static_cast<R>(0.21132486540518711775L);  // (1 - 1 / sqrt(3)) / 2
            constexpr R steepness =
                static_cast<R>(2 * 0.21132486540518711775L * 0.78867513459481288225L * 0.57735026918962576451L);
            const vec<dual<S>, n> there = detail::interpolate(step.data, dual<S>(S(c), S(R(1))));
            vec<S, n> y;
            MYRIAD_UNROLL
            for (int i = 0; i < n; ++i) y[i] = there[i].value;
            const auto slope = detail::evaluate_rhs<Model>(fma(S(c), step.data.h, step.data.t), y, s.data);
            MYRIAD_UNROLL
            for (int i = 0; i < n; ++i)
                step.bend[i] = fma(step.data.h, slope[i], -there[i].derivative) * S(R(1) / steepness);
            s.extra_evaluations = count_where(lanes, s.extra_evaluations);
        }
    }

    /// Updates the extrema of quantity q with the quantities at time t. A NaN persists.
    template <int q>
    MYRIAD_FUNCTION void consider(const mask& lanes, const slopes& there, const S& t) {
        consider_for<q, over_phase::maximum, over_phase::time_of_maximum>(lanes, there, t);
        consider_for<q, over_phase::minimum, over_phase::time_of_minimum>(lanes, there, t);
    }
    template <int q, over_phase kind, over_phase its_time>
    MYRIAD_FUNCTION void consider_for(const mask& lanes, const slopes& there, const S& t) {
        if constexpr (extreme<q, kind>) {
            if (!keeps<q>()) return;
            const S& value = there[q].value;
            S& best = receiver<summarised_into<Model, q, kind>>();
            const mask better =
                lanes & ((kind == over_phase::maximum ? value > best : value < best) | (value != value));
            best = select(better, value, best);
            if constexpr (extreme<q, its_time>) {
                S& when = receiver<summarised_into<Model, q, its_time>>();
                when = select(better, t, when);
            }
            each_companion<q, kind>(
                [&](auto c, S& kept) MYRIAD_LAMBDA { kept = select(better, there[decltype(c)::value].value, kept); });
        }
    }

    /// The quantities at the start of a step, with what moves with an event just before it.
    MYRIAD_FUNCTION slopes after_event(const slopes& first, const step_data<Method, S, n>& step) const {
        if constexpr (n_companion<Model> == 0) {
            return first;
        } else {
            slopes moved = first;
            static_for<0, n_companion<Model>>([&](auto i) MYRIAD_LAMBDA {
                constexpr companion what = companion_at<Model, decltype(i)::value>;
                const S by = s.data.accessory[what.moves_by], slope = first[what.beside].derivative / step.h;
                const S& value = first[what.quantity].value;
                moved[what.quantity].value =
                    select(step.t == s.data.accessory[what.event_time], fma(slope, by, value), value);
            });
            return moved;
        }
    }

    /// Calls a function with the number of each quantity that is kept beside a summary of quantity q, and where it is.
    template <int q, over_phase kind, class F>
    MYRIAD_FUNCTION void each_companion(F&& function) {
        if constexpr (n_companion<Model> != 0) {
            static_for<0, n_companion<Model>>([&](auto i) MYRIAD_LAMBDA {
                constexpr companion what = companion_at<Model, decltype(i)::value>;
                if constexpr (what.beside == q && what.kind == kind)
                    function(constant_index<what.quantity>{}, s.data.accessory[what.accessory]);
            });
        }
    }

    /// Whether the cubic polynomial through both ends with their slopes may have an extremum inside. If not, both
    /// slopes have the sign of its rise and are at most three times as large: Fritsch and Carlson, SIAM J. Numer. Anal.
    /// 17 (1980) 238.
    MYRIAD_FUNCTION mask may_turn(const dual<S>& first, const dual<S>& last) const {
        const S rise = last.value - first.value, bound = S(R(3)) * rise * rise;
        const S a = first.derivative * rise, b = last.derivative * rise;
        return !((a >= S(R(0))) & (a <= bound) & (b >= S(R(0))) & (b <= bound));
    }

    /// Out of line; otherwise its operands would stay live throughout the loop.
    __attribute__((noinline)) void search_out_of_line(step_type& step, const slopes& first, const slopes& last,
                                                      const mask& search) {
        search_inside(step, first, last, search);
    }

    /// One quantity and sign after the other, with the same code: 1 for the maximum, -1 for the minimum. A team takes
    /// its threads' quantities one after the other: all threads look at the same point of the step, as a quantity may
    /// depend on the states of all.
    MYRIAD_FUNCTION void search_inside(step_type& step, const slopes& first, const slopes& last, mask search) {
        search = team_for<Model>::any(search);
        if constexpr (!integrates) know_interpolant(step, search);
        static_for<0, m>([&](auto j) MYRIAD_LAMBDA {
            constexpr int q = decltype(j)::value;
            constexpr bool maximum = extreme<q, over_phase::maximum>, minimum = extreme<q, over_phase::minimum>;
            if constexpr (maximum || minimum) {
                MYRIAD_ROLLED
                for (int thread = 0; thread < team_size<Model>; ++thread) {
                    if (!team_for<Model>::of_thread(thread, keeps<q>())) continue;
                    const dual<S> at_first = of_thread(thread, first[q]), at_last = of_thread(thread, last[q]);
                    const turn middle = turn_between<q>(step, search, at_first, at_last, thread);
                    MYRIAD_ROLLED
                    for (int sign = maximum ? 1 : -1; sign >= (minimum ? -1 : 1); sign -= 2)
                        find_extremum<q>(step, static_cast<R>(sign), search, at_first, at_last, middle, thread);
                }
            }
        });
    }
    static MYRIAD_FUNCTION dual<S> of_thread(int thread, const dual<S>& own) {
        return {team_for<Model>::of_thread(thread, own.value), team_for<Model>::of_thread(thread, own.derivative)};
    }
    /// The slope of a thread's quantity inside the step.
    template <int q>
    MYRIAD_FUNCTION S slope_at(const step_type& step, const S& theta, int thread) const {
        return team_for<Model>::of_thread(thread, look_at(step, theta)[q].derivative);
    }

    /// The quantities and their slopes inside the step.
    MYRIAD_FUNCTION slopes look_at(const step_type& step, const S& theta) const {
        if constexpr (is_pack<S>) {
            return look_out_of_line(step, theta);
        } else {
            return observe_at(step, dual<S>(theta, S(R(1))));
        }
    }
    __attribute__((noinline)) slopes look_out_of_line(const step_type& step, const S& theta) const {
        return observe_at(step, dual<S>(theta, S(R(1))));
    }

    /// A point between two extrema inside the step, with the slope there.
    struct turn {
        mask there;
        S theta, slope;
    };

    /// If both ends slope the same way but the cubic polynomial through them slopes the other way in between: the
    /// steepest point of that interval.
    template <int q>
    MYRIAD_FUNCTION turn turn_between(const step_type& step, const mask& lanes, const dual<S>& first,
                                      const dual<S>& last, int thread) const {
        const S rise = last.value - first.value;
        const S a = S(R(3)) * rise - S(R(2)) * first.derivative - last.derivative;  // slope d + 2 a theta + 3 b theta^2
        const S b = first.derivative + last.derivative - S(R(2)) * rise;
        const S theta = -a / (S(R(3)) * b);
        const S slope = fma(a, theta, first.derivative);
        turn found;
        found.there = lanes & (theta > S(R(0))) & (theta < S(R(1))) & (slope * first.derivative <= S(R(0))) &
                      (slope * last.derivative <= S(R(0)));
        found.theta = select(found.there, theta, S(R(0.5)));
        found.slope = S(R(0));
        if (any(found.there)) found.slope = slope_at<q>(step, found.theta, thread);
        return found;
    }

    /// Finds the largest (sign 1) or smallest (sign -1) value of quantity q inside the step, if it has one: its slope
    /// on the interpolant changes sign there.
    template <int q>
    MYRIAD_FUNCTION void find_extremum(const step_type& step, R sign, const mask& lanes, const dual<S>& first,
                                       const dual<S>& last, const turn& middle, int thread) {
        const S zero = S(R(0)), d0 = S(sign) * first.derivative, d1 = S(sign) * last.derivative,
                d = S(sign) * middle.slope;
        const mask early = middle.there & (d0 > zero) & (d < zero), late = middle.there & (d > zero) & (d1 < zero);
        const bracket<S> b{select(late, middle.theta, zero), select(early, middle.theta, S(R(1))), select(late, d, d0),
                           select(early, d, d1)};
        // With a slope this small, as of a constant quantity, it rises above both ends by less than rounding.
        const S least = S(epsilon_of<R>) * max(abs(first.value), abs(last.value));
        const mask wanted = lanes & (b.f_low > least) & (b.f_high < -least);
        if (!any(wanted)) return;
        const S small = S(R(1024) * epsilon_of<R>) * (b.f_low - b.f_high);
        const S theta = detail::find_root(b, wanted, [&](const S& x, mask& close) MYRIAD_LAMBDA {
            const S slope = S(sign) * slope_at<q>(step, x, thread);
            close = abs(slope) <= small;
            return slope;
        });
        const slopes there = look_at(step, theta);
        wait_for_readers();
        if (team_for<Model>::number_of_thread() == thread)
            consider<q>(wanted, there, fma(theta, step.data.h, step.data.t));
    }

    /// Five-point Lobatto rule, exact for polynomials up to degree seven: Abramowitz and Stegun, Handbook of
    /// Mathematical Functions, 25.4.32 and table 25.6.
    MYRIAD_FUNCTION void integrate_step(const step_type& step, const slopes& first, const slopes& last,
                                        const mask& lanes) {
        constexpr R near = static_cast<R>(0.17267316464601142810L);  // (1 - sqrt(3 / 7)) / 2
        values sum;
        MYRIAD_UNROLL
        for (int q = 0; q < m; ++q) {  // not their sum, in which nvcc would fuse one product or the other
            const S weight = S(R(1) / R(20));
            sum[q] = fma(weight, last[q].value, weight * first[q].value);
        }
        for (int k = 0; k < 3; ++k) {
            const R theta = k == 0 ? near : (k == 1 ? R(0.5) : R(1) - near);
            const S weight = S(k == 1 ? R(16) / R(45) : R(49) / R(180));
            const values inside = observe_at(step, S(theta));
            MYRIAD_UNROLL
            for (int q = 0; q < m; ++q) sum[q] = fma(weight, inside[q], sum[q]);
        }
        wait_for_readers();
        static_for<0, m>([&](auto j) MYRIAD_LAMBDA {
            constexpr int q = decltype(j)::value;
            if constexpr (extreme<q, over_phase::integral>) {
                if (!keeps<q>()) return;
                S& integral = receiver<summarised_into<Model, q, over_phase::integral>>();
                integral = select(lanes, fma(step.data.h, sum[q], integral), integral);
                each_companion<q, over_phase::integral>([&](auto c, S& kept) MYRIAD_LAMBDA {
                    kept = select(lanes, fma(step.data.h, sum[decltype(c)::value], kept), kept);
                });
            }
        });
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
