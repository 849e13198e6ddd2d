// SPDX-License-Identifier: MIT
// The models on which methods are compared, and the controls compared with the elementary one.
#pragma once

#include <myriad/methods.hpp>
#include <myriad/model.hpp>

#include "benchmarks/gpu_ensembles/models.hpp"

namespace methods {

using keller_miksis = gpu_ensembles::keller_miksis;
using relief_valve = gpu_ensembles::relief_valve;

/// Robertson's reaction with its rate constants as parameters: a -> b at k1, 2 b -> b + c at k2, b + c -> a + c at k3.
/// The sum of the concentrations is conserved.
struct robertson {
    enum state { a, b, c, n_state };
    enum parameter { k1, k2, k3, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        // The difference of the large, nearly equal fluxes between a and b is computed once, so that the sum does not
        // depend on which products the compiler fuses.
        const R back = p[k3] * y[b] * y[c] - p[k1] * y[a], fast = p[k2] * y[b] * y[b];
        return {back, -back - fast, fast};
    }
};

using tsitouras_5_pi = myriad::controlled<myriad::tsitouras_5, myriad::pi_control>;
using dormand_prince_8_pi = myriad::controlled<myriad::dormand_prince_8, myriad::pi_control>;
using dormand_prince_8_rms = myriad::controlled<myriad::dormand_prince_8, myriad::rms_norm>;
using rodas_5p_pi = myriad::controlled<myriad::rodas_5p, myriad::pi_control>;

}  // namespace methods
