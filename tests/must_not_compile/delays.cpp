// case: delays_with_a_method_for_stochastic_equations
// expect: the model has delays, which methods for stochastic equations do not take
// case: delays_with_two_tangents
// expect: a model with delays has one tangent vector, for the largest exponent
// case: delays_with_sensitivities_by_the_begin
// expect: with_sensitivities has no derivatives by t_begin of a model with delays
// case: slopes_of_the_past_with_sensitivities
// expect: take no model that reads slopes of its past
// case: delays_and_triggers_with_sensitivities
// expect: take no model with delays and triggers
// case: sensitivities_with_fixed_steps_and_a_lag_by_state
// expect: tangents and sensitivities of a model whose lags depend on time or state need an adaptive method
// case: delays_without_lag
// expect: a model with delays has `enum delayed \{ ..., n_delayed \};` and the functions `delayed_state`
// case: delayed_value_of_no_state
// expect: delayed_state names no state of the model
// case: lag_with_the_inputs_first
// expect: lag has a wrong signature: it must be
// SPDX-License-Identifier: MIT
// Models with delays that do not fit together.
#include <myriad/instantiate.hpp>  // first, as it is precompiled

#include "myriad/model.hpp"
#include "myriad/sensitivity.hpp"
#include "myriad/tangent.hpp"

struct decay {
    enum state { x, n_state };
    enum parameter { tau, n_parameter };
    enum delayed { past, n_delayed };

    MYRIAD_FUNCTION static int delayed_state(int) { return x; }
    template <class R>
    MYRIAD_FUNCTION static R lag(int, const auto& p) {
        return p[tau];
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>&, const auto& p) {
        return myriad::vec<R, n_state>{-p.delayed[past]};
    }
};
MYRIAD_INSTANTIATE(decay, myriad::cash_karp)

#if defined(CASE_delays_with_a_method_for_stochastic_equations)
struct noisy : decay {
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> diffusion(auto, const myriad::vec<R, n_state>& s, const auto&) {
        return myriad::vec<R, n_state>{s[x]};
    }
};
MYRIAD_INSTANTIATE(noisy, myriad::euler_maruyama)
#endif
#if defined(CASE_delays_with_two_tangents)
struct pair : decay {
    enum state { x, y, n_state };
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& s, const auto& p) {
        return myriad::vec<R, n_state>{-p.delayed[past], s[x]};
    }
};
using with_tangents = myriad::with_tangents<pair, 2>;
MYRIAD_INSTANTIATE(with_tangents, myriad::cash_karp)
#endif
#if defined(CASE_delays_with_sensitivities_by_the_begin)
using with_sensitivities = myriad::with_sensitivities<decay, myriad::time_domain::t_begin>;
MYRIAD_INSTANTIATE(with_sensitivities, myriad::cash_karp)
#endif
#if defined(CASE_slopes_of_the_past_with_sensitivities)
struct neutral : decay {
    MYRIAD_FUNCTION static bool is_delayed_slope(int) { return true; }
};
using with_sensitivities = myriad::with_sensitivities<neutral, neutral::tau>;
MYRIAD_INSTANTIATE(with_sensitivities, myriad::cash_karp)
#endif
#if defined(CASE_delays_and_triggers_with_sensitivities)
struct triggered : decay {
    enum event { low, n_event };
    enum trigger { below, n_trigger };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& s, const auto&) {
        return {s[x]};
    }
    MYRIAD_FUNCTION static bool condition(int, const auto& above) { return !above[low]; }
    MYRIAD_FUNCTION static void after_trigger(int, auto&) {}
};
using with_sensitivities = myriad::with_sensitivities<triggered, triggered::tau>;
MYRIAD_INSTANTIATE(with_sensitivities, myriad::cash_karp)
#endif
#if defined(CASE_sensitivities_with_fixed_steps_and_a_lag_by_state)
struct bent {
    enum state { x, n_state };
    enum parameter { tau, n_parameter };
    enum delayed { past, n_delayed };

    MYRIAD_FUNCTION static int delayed_state(int) { return x; }
    template <class R>
    MYRIAD_FUNCTION static R lag(int, const R&, const myriad::vec<R, n_state>& y, const auto& p) {
        return p[tau] + y[x] * y[x];
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>&, const auto& p) {
        return myriad::vec<R, n_state>{-p.delayed[past]};
    }
};
using with_sensitivities = myriad::with_sensitivities<bent, bent::tau>;
MYRIAD_INSTANTIATE(with_sensitivities, myriad::runge_kutta_4)
#endif
#if defined(CASE_delays_without_lag)
struct unknown {
    enum state { x, n_state };
    enum delayed { past, n_delayed };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>&, const auto& p) {
        return myriad::vec<R, n_state>{-p.delayed[past]};
    }
};
MYRIAD_INSTANTIATE(unknown, myriad::cash_karp)
#endif
#if defined(CASE_delayed_value_of_no_state)
struct elsewhere : decay {
    MYRIAD_FUNCTION static int delayed_state(int) { return 7; }
};
MYRIAD_INSTANTIATE(elsewhere, myriad::cash_karp)
#endif
#if defined(CASE_lag_with_the_inputs_first)
struct exchanged : decay {
    template <class R>
    MYRIAD_FUNCTION static R lag(const auto& p, int) {
        return p[tau];
    }
};
MYRIAD_INSTANTIATE(exchanged, myriad::cash_karp)
#endif
