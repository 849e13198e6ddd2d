// SPDX-License-Identifier: MIT
// Extrema of observed quantities along noisy paths, and their times: drawn within each step from the laws of the
// Brownian bridge that a quantity is there, with the noise as at its start. Only in kernels of models that declare
// `summaries`.
#pragma once

#include "myriad/kernel/event/bridge_crossing.hpp"
#include "myriad/kernel/output/summariser.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// When a bridge from `a` below its largest value to `b` below it has it, as a part of its length, by three normal
/// numbers: a path in between that stays below is one up to there and one back from the end, so that z = theta / (1 -
/// theta) has the density of the first passage times 1 + z. With probability b / (a + b) that is the law of a passage
/// from a to b, else that of one from b to a, backwards.
template <class R>
MYRIAD_FUNCTION R time_of_largest(R a, R b, R variance, R which, R normal, R other) {
    if (!(variance > R(0))) return b < a ? R(1) : R(0);
    if (!(which > normal_quantile(b / (a + b)))) return detail::first_passage(a, b, variance, normal, other);
    return R(1) - detail::first_passage(b, a, variance, normal, other);
}

/// An observer: see observers.hpp.
template <class Model, class Method, class S>
requires stochastic_method<Method>
struct summariser<Model, Method, S> {
    using R = real_of<S>;
    using mask = mask_of<S>;
    static constexpr auto n = n_state<Model>;
    static constexpr auto m = n_observed<Model>;
    static constexpr bool watches = has_summaries<Model>;
    static constexpr bool changes_inputs = sees_summaries<Model>;
    using values = vec<S, m>;

    struct memory {};  // all is in accessories

    const kernel_arguments<Model, R>& args;
    integration_state<Model, Method, S>& s;
    memory& own;

    MYRIAD_FUNCTION void begin(int i) {
        const lane_data<Model, R> one = detail::extract_lane(s.data, i);
        const inputs<Model, R>& p = one;
        const vec<R, m> q = Model::template observe<R>(one.t, one.y, p);
        static_for<0, n_summary<Model>>([&](auto r) MYRIAD_LAMBDA {
            constexpr unmarked_summary what = summary_at<Model, decltype(r)::value>;
            constexpr bool time = what.kind == over_phase::time_of_maximum || what.kind == over_phase::time_of_minimum;
            set_lane(s.data.accessory[what.accessory], i, time ? one.t : q[what.quantity]);
        });
    }

    /// Updates the extrema with the accepted steps. Returns the lanes in which an accessory has changed.
    MYRIAD_FUNCTION mask see(const accepted_step<Model, Method, S>& seen) {
        const auto before = s.data.accessory;
        const inputs<Model, S>& p = s.data;
        const S t = s.now();
        const values first = Model::template observe<S>(t, s.data.y, p),
                     last = Model::template observe<S>(seen.t1, seen.trial.y, p), rate = rates(t);
        static_for<0, m>([&](auto j) MYRIAD_LAMBDA {
            constexpr int q = decltype(j)::value;
            const S variance = rate[q] * abs(s.h);
            if constexpr (extreme<q, over_phase::maximum>)
                consider<q, over_phase::maximum>(seen.accepted, t, first[q], last[q], variance);
            if constexpr (extreme<q, over_phase::minimum>)
                consider<q, over_phase::minimum>(seen.accepted, t, -first[q], -last[q], variance);
        });
        mask changed = mask(false);
        if constexpr (sees_summaries<Model>) {
            MYRIAD_UNROLL
            for (int a = 0; a < n_accessory<Model>; ++a)
                changed = changed | (seen.accepted & differs_in_bits(before[a], s.data.accessory[a]));
        }
        return changed;
    }

private:
    template <int q, over_phase kind>
    static constexpr bool extreme = summarises<Model>(q, kind);

    /// The variances of the quantities per time.
    MYRIAD_FUNCTION values rates(const S& t) const {
        const inputs<Model, S>& p = s.data;
        const diffusion_type<Model, S> factors = Model::template diffusion<S>(t, s.data.y, p);
        values rate;
        MYRIAD_UNROLL
        for (int q = 0; q < m; ++q) rate[q] = S(R(0));
        MYRIAD_UNROLL_UP_TO(16, 4)
        for (int k = 0; k < MYRIAD_LENGTH(n_wiener<Model>); ++k) {
            const vec<dual<S>, m> along =
                Model::template observe<dual<S>>(dual<S>(t), detail::moved_by_process<Model>(s.data.y, factors, k), p);
            MYRIAD_UNROLL
            for (int q = 0; q < m; ++q) rate[q] = rate[q] + detail::square_along_noise(along[q].derivative);
        }
        return rate;
    }

    /// Updates the maximum of a quantity, or the minimum by its values with the other sign, with a step in which it
    /// goes from `first` to `last`. A NaN persists.
    template <int q, over_phase kind>
    MYRIAD_FUNCTION void consider(const mask& lanes, const S& t, const S& first, const S& last, const S& variance) {
        constexpr bool falls = kind == over_phase::minimum;
        constexpr int number = 2 * q + (falls ? 1 : 0);
        constexpr over_phase of_time = falls ? over_phase::time_of_minimum : over_phase::time_of_maximum;
        S& kept = s.data.accessory[summarised_into<Model, q, kind>];
        const S best = falls ? -kept : kept;
        const mask may_be = lanes & !(largest(first, last, variance, S(R(most_squares<R>))) <= best);
        if (!any(may_be)) return;
        const path_interval<S> over = s.steps.interval(args.noise);
        const auto z = detail::bridge_normals<S>(over, bridge_draw::extreme, number);
        const S value = largest(first, last, variance, fma(z[0], z[0], z[1] * z[1]));
        const mask better = may_be & !(value <= best);
        kept = select(better, falls ? -value : value, kept);
        if constexpr (extreme<q, of_time>) {
            S& time = s.data.accessory[summarised_into<Model, q, of_time>];
            for_each_lane(better, [&](int i) MYRIAD_LAMBDA {
                path_interval<R> of_lane;
                s.steps.set_interval(of_lane, i, args.noise);
                const auto which = detail::bridge_normals<R>(of_lane, bridge_draw::when, 2 * number);
                const auto normal = detail::bridge_normals<R>(of_lane, bridge_draw::when, 2 * number + 1);
                const R top = get_lane(value, i);
                const R theta = detail::time_of_largest(top - get_lane(first, i), top - get_lane(last, i),
                                                        get_lane(variance, i), which[0], normal[0], normal[1]);
                set_lane(time, i, fma(theta, get_lane(s.h, i), get_lane(t, i)));
            });
        }
    }
    /// The largest value of a bridge between two, which is above a value c with probability exp(-2 (c - first) (c -
    /// last) / variance); `squares` is -2 log U of a uniform number.
    static MYRIAD_FUNCTION S largest(const S& first, const S& last, const S& variance, const S& squares) {
        const S change = last - first;
        const S middle = S(R(0.5)) * (first + last + sqrt(fma(change, change, squares * variance)));
        return max(middle, max(first, last));
    }
};

}  // namespace myriad::detail::inline MYRIAD_TARGET
