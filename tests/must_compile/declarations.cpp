// SPDX-License-Identifier: MIT
// Models with summaries, also of enumerations without a name, and with couplings.
#include <myriad/instantiate.hpp>
#include <myriad/model.hpp>

#include "tests/kernel/model/unit_models.hpp"

struct decay {
    enum { x, n_state };
    enum { k, n_parameter };
    enum { largest, at, n_accessory };
    enum { height, n_observed };
    static constexpr myriad::summary summaries[] = {{height, myriad::over_phase::maximum, largest},
                                                    {height, myriad::over_phase::time_of_maximum, at}};

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return myriad::vec<R, n_state>{-(p[k] * y[x])};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_observed> observe(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_observed>{y[x]};
    }
};
static_assert(myriad::detail::type_mark<decltype(decay::n_accessory)> !=
              myriad::detail::type_mark<decltype(decay::n_observed)>);

MYRIAD_INSTANTIATE(decay, myriad::runge_kutta_4)

using phases = myriad::coupled_units<units::phase_oscillator, 5>;
MYRIAD_INSTANTIATE(phases, myriad::runge_kutta_4)
