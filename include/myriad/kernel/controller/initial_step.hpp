// SPDX-License-Identifier: MIT
// The first step of a phase if the user gave none: from the slope, the tolerances and the domain; or, as an option,
// from the change of the slope too.
#pragma once

#include "myriad/kernel/controller/fast_power.hpp"
#include "myriad/kernel/controller/norm.hpp"
#include "myriad/kernel/state/integration_state.hpp"
#include "myriad/kernel/stepper/component_loop.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// A first step where nothing is known of how fast the solution will change: a small part of the domain, or of
/// `args.step` in a domain without an end. It grows by what the steps see; a longer one might have all its stages where
/// the slope is zero, as at whole periods.
template <class Model, class R, class S>
MYRIAD_FUNCTION S cautious_step(const kernel_arguments<Model, R>& args, const S& domain) {
    constexpr R part = R(1e-9);
    return S(part) * select(domain <= S(largest_of<R>), domain, S(args.step));
}

/// The longest first step, as a part of the domain: nearly a tenth, and irrational, (3 - sqrt 5) / 8, so that its
/// stages do not lie at whole periods of a forcing of which the domain has a round number.
constexpr double first_part = 0.095491502812526288;

/// By the slope alone: no component changes by more than `args.first_change` of its size, which is at least atol /
/// rtol. Shampine and Reichelt, SIAM J. Sci. Comput. 18 (1997) 1, and their code ode45. At most `first_part` of the
/// domain, or 100 times `args.step` in one without an end. At a state of rest, where nothing would change in a million
/// times the domain, the slope says nothing. A component that is zero and has no absolute tolerance has no size.
template <class Model, class Method, class S>
MYRIAD_FUNCTION S step_by_slope(const kernel_arguments<Model, real_of<S>>& args,
                                const integration_state<Model, Method, S>& s, const vec<S, n_state<Model>>& slope) {
    using R = real_of<S>;
    S rate = S(R(0));  // of the fastest component, in parts of its size
    detail::each_component<Method, n_controlled<Model>>([&](int c) MYRIAD_LAMBDA {
        const R rtol = detail::relative_tolerance_of(args, c), atol = detail::absolute_tolerance_of(args, c);
        S tolerance = larger(S(rtol) * abs(s.data.y[c]), S(atol));
        const S relative = S(rtol) * abs(slope[c]) / tolerance;
        rate = select(tolerance > S(smallest_normal_of<R>), larger(relative, rate), rate);
    });
    rate = team_for<Model>::largest(rate);
    const S domain = abs(s.data.t_end - s.data.t), part = S(R(first_part)) * domain;
    const S most = select(part <= S(largest_of<R>), part, S(R(100)) * S(args.step));
    const S h = S(args.first_change) / rate;
    const mask_of<S> known = (h > S(R(0))) & (h <= S(R(1e6)) * domain) & (h <= S(largest_of<R>));
    return select(known, smaller(h, most), detail::cautious_step(args, domain));
}

/// By the slope and its change. Hairer, Norsett, Wanner, Solving ODE I, II.4, "Starting step size", in the maximum
/// norm: an Euler step that changes y by a hundredth of its size shows how fast the slope changes; the leading error
/// term of the first step is to be a hundredth of the tolerance.
template <class Model, class Method, class S>
MYRIAD_FUNCTION S step_by_curvature(const kernel_arguments<Model, real_of<S>>& args,
                                    integration_state<Model, Method, S>& s, const mask_of<S>& open,
                                    const vec<S, n_state<Model>>& slope0) {
    using R = real_of<S>;
    constexpr auto n = n_state<Model>, controlled = n_controlled<Model>;
    const S direction = copysign(S(R(1)), s.data.t_end - s.data.t);
    vec<S, controlled> scale;
    S d0 = S(R(0)), d1 = S(R(0)), d2 = S(R(0));
    detail::each_component<Method, controlled>([&](int c) MYRIAD_LAMBDA {
        scale[c] =
            fma(S(detail::relative_tolerance_of(args, c)), abs(s.data.y[c]), S(detail::absolute_tolerance_of(args, c)));
        if constexpr (scales_tolerances<Method>) scale[c] = scale[c] * s.steps.tolerance_scale;
        d0 = larger(abs(s.data.y[c]) / scale[c], d0);
        d1 = larger(abs(slope0[c]) / scale[c], d1);
    });
    d0 = team_for<Model>::largest(d0);
    d1 = team_for<Model>::largest(d1);
    const mask_of<S> tiny = (d0 < S(R(1e-5))) | (d1 < S(R(1e-5)));
    const S cautious = detail::cautious_step(args, abs(s.data.t_end - s.data.t));
    const S h0 = select(tiny, smaller(S(R(1e-6)), cautious), S(R(0.01)) * d0 / d1);
    vec<S, n> y;
    detail::each_component<Method, n>([&](int c) MYRIAD_LAMBDA { y[c] = fma(direction * h0, slope0[c], s.data.y[c]); });
    const auto slope = detail::evaluate_rhs<Model>(fma(direction, h0, s.data.t), y, s.data);
    s.extra_evaluations = count_where(open, s.extra_evaluations);
    detail::each_component<Method, controlled>(
        [&](int c) MYRIAD_LAMBDA { d2 = larger(abs(slope[c] - slope0[c]) / (scale[c] * h0), d2); });
    d2 = team_for<Model>::largest(d2);
    const S most = larger(d1, d2);
    const S power = S(fast_power(S(R(0.01)) / most, S(R(1.0 / (estimate_order<Method> + 1)))));
    const S h1 = select(most <= S(R(1e-15)), h0, power);
    S h = smaller(S(R(100)) * h0, h1);
    return select(h > S(R(0)), h, cautious);  // the slope is NaN: the trial step will report it
}

/// Sets `data.h_next` of the lanes whose first step is open.
template <class Model, class Method, class S>
MYRIAD_FUNCTION void choose_first_step(const kernel_arguments<Model, real_of<S>>& args,
                                       integration_state<Model, Method, S>& s, const mask_of<S>& open) {
    using R = real_of<S>;
    const vec<S, n_state<Model>> slope = s.slopes.start(open, s.now(), s.data, s.extra_evaluations);
    S h;
    if constexpr (chooses_first_step<Method>) {
        h = detail::step_by_curvature(args, s, open, slope);
    } else {
        h = detail::step_by_slope(args, s, slope);
    }
    h = larger(h, S(resolved_roundings<R>) * abs(s.data.t));
    h = limited(h, S(args.minimum_step), S(args.maximum_step));
    s.data.h_next = select(open, copysign(h, s.data.t_end - s.data.t), s.data.h_next);
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
