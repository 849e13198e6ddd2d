// case: delays_with_a_method_for_stochastic_equations
// expect: the model has delays, which methods for stochastic equations do not take
// case: delays_with_tangents
// expect: with_tangents and with_sensitivities take no model with delays
// case: delays_with_sensitivities
// expect: with_tangents and with_sensitivities take no model with delays
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
#if defined(CASE_delays_with_tangents)
using with_tangents = myriad::with_tangents<decay, 1>;
MYRIAD_INSTANTIATE(with_tangents, myriad::cash_karp)
#endif
#if defined(CASE_delays_with_sensitivities)
using with_sensitivities = myriad::with_sensitivities<decay, decay::tau>;
MYRIAD_INSTANTIATE(with_sensitivities, myriad::cash_karp)
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
