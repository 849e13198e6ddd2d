// SPDX-License-Identifier: MIT
// The Keller-Miksis bubble as a Myriad model that stores the largest radius of each phase.
#pragma once

#include <myriad/model.hpp>

#include "problems/keller_miksis.hpp"

namespace cpu_peers {

/// Written in fused multiply-adds.
struct keller_miksis_model : problems::keller_miksis_with_peak {
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto t, const myriad::vec<R, n_state>& u, const auto& p) {
        using myriad::cospi, myriad::exp2, myriad::fma, myriad::log2, myriad::sinpi;
        const R first = 2.0 * t, second = fma(2.0 * p[C11], R(t), p[C12]);
        const R inverse = 1.0 / u[y], mach = p[C9] * u[v], approach = 1.0 + mach;
        // Half the instructions of pow, and one digit less where the radius changes by orders of magnitude.
        const R gas = fma(p[C1], u[v], p[C0]) * exp2(-p[C10] * log2(u[y]));
        const R at_wall = fma(fma(p[C4], u[v], p[C3]), inverse, fma(R(-0.5), mach, R(1.5)) * u[v] * u[v]);
        const R driving = fma(p[C5], sinpi(first), fma(p[C6], sinpi(second), p[C2])) * approach;
        const R waves = u[y] * fma(p[C7], cospi(first), p[C8] * cospi(second));
        const R denominator = fma(u[y], 1.0 - mach, p[C4] * p[C9]);
        return {u[v], (gas - at_wall - driving - waves) / denominator};
    }
};

}  // namespace cpu_peers
