// SPDX-License-Identifier: MIT
// Derivatives of summaries: of integrals, the integrals of derivatives, and of extrema those of the quantity where the
// extremum is, since its slope is zero there; with what events add, whose times move.
#pragma once

#include "myriad/kernel/core/static_for.hpp"
#include "myriad/kernel/model/summaries.hpp"
#include "myriad/kernel/model/varied_past.hpp"

namespace myriad::detail {

/// What becomes of the derivatives of a model's summaries where phases begin and end, and at events. The time moves by
/// dt in direction i, the state by component n i of v and those behind it, both as derivatives.
template <class Model, class Directions>
struct moving_summaries {
    static constexpr int n = n_state<Model>, count = Directions::count;

    /// Begins a phase.
    template <class R>
    MYRIAD_FUNCTION static void begin(auto& wrapped, const vec<R, count * n>& v, const vec<R, count>& dt) {
        each<R>(wrapped, v, dt, [&](auto r, const dual<R>& q, const R& by, R& derivative) MYRIAD_LAMBDA {
            derivative = is_integral<decltype(r)::value> ? -q.value * by : q.derivative;
        });
    }
    /// Integrals go on for sign * dt.
    template <class R>
    MYRIAD_FUNCTION static void extend(auto& wrapped, const vec<R, count>& dt, R sign) {
        vec<R, count * n> still{};
        each<R>(wrapped, still, dt, [&](auto r, const dual<R>& q, const R& by, R& derivative) MYRIAD_LAMBDA {
            if constexpr (is_integral<decltype(r)::value>) derivative = fma(sign * q.value, by, derivative);
        });
    }
    /// Arrives at an event: an extremum that is there moves with it.
    template <class R>
    MYRIAD_FUNCTION static void arrive(auto& wrapped, const vec<R, count * n>& v, const vec<R, count>& dt) {
        extend(wrapped, dt, R(1));
        each<R>(wrapped, v, dt, [&](auto r, const dual<R>& q, const R&, R& derivative) MYRIAD_LAMBDA {
            if constexpr (!is_integral<decltype(r)::value>) {
                const R away = abs(q.value - wrapped.accessory[summary_at<Model, decltype(r)::value>.accessory]);
                if (away <= R(4) * epsilon_of<R> * abs(q.value)) derivative = q.derivative;
            }
        });
    }
    /// In directions in which the time of an event has no derivative, summaries have none after a jump.
    template <class R>
    MYRIAD_FUNCTION static void lose(auto& wrapped, const vec<R, count>& dt) {
        for (int i = 0; i < count; ++i)
            if (!is_finite(dt[i])) forget(wrapped, i, true);
    }
    /// The times of extrema have no derivatives; with `all`, nothing has.
    MYRIAD_FUNCTION static void forget(auto& wrapped, int i, bool all) {
        using R = std::remove_cvref_t<decltype(wrapped.t)>;
        static_for<0, n_summary<Model>>([&](auto r) MYRIAD_LAMBDA {
            constexpr unmarked_summary what = summary_at<Model, decltype(r)::value>;
            constexpr bool is_time =
                what.kind == over_phase::time_of_maximum || what.kind == over_phase::time_of_minimum;
            if (is_time || all) wrapped.accessory[first_moving_accessory<Model>(i) + what.accessory] = nan_of<R>;
        });
    }

private:
    template <int r>
    static constexpr bool is_integral = summary_at<Model, r>.kind == over_phase::integral;

    /// Calls a function for each integral and extremum in each direction: with its number, its quantity now with the
    /// derivative in that direction, dt, and its own derivative.
    template <class R>
    MYRIAD_FUNCTION static void each(auto& wrapped, const vec<R, count * n>& v, const vec<R, count>& dt, auto&& f) {
        static_for<0, count>([&](auto i) MYRIAD_LAMBDA {
            constexpr int d = decltype(i)::value;
            const dual<R> t(wrapped.t, dt[d]);
            const vec<dual<R>, n> y = along(part<n>(wrapped.y), part<n>(v, d * n));
            const auto q =
                Model::template observe<dual<R>>(t, y, detail::inputs_along<Model, Directions, d, R>(wrapped, t, y));
            static_for<0, n_summary<Model>>([&](auto r) MYRIAD_LAMBDA {
                constexpr unmarked_summary what = summary_at<Model, decltype(r)::value>;
                if constexpr (what.kind != over_phase::time_of_maximum && what.kind != over_phase::time_of_minimum)
                    f(r, q[what.quantity], dt[d], wrapped.accessory[first_moving_accessory<Model>(d) + what.accessory]);
            });
        });
    }
};

}  // namespace myriad::detail
