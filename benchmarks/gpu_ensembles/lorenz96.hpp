// SPDX-License-Identifier: MIT
// The models of the case lorenz96, dx_i/dt = (x_(i+1) - x_(i-2)) x_(i-1) - x_i + F: written as a whole, and as units.
#pragma once

#include <myriad/coupled_units.hpp>
#include <myriad/methods.hpp>
#include <myriad/model.hpp>

namespace gpu_ensembles {

/// All n states as one model.
template <int n>
struct lorenz96 {
    static constexpr int n_state = n;
    enum parameter { F, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n> rhs(auto, const myriad::vec<R, n>& x, const auto& p) {
        myriad::vec<R, n> slopes;
        MYRIAD_UNROLL
        for (int i = 0; i < n; ++i)
            slopes[i] = (x[(i + 1) % n] - x[(i + n - 2) % n]) * x[(i + n - 1) % n] - x[i] + p[F];
        return slopes;
    }
};

/// One state, which reads three others.
struct lorenz96_unit {
    enum unit_state { x, n_unit_state };
    enum parameter { F, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_unit_state> rhs(int unit, auto, const auto& y, const auto& p) {
        const int n = y.units;
        const int next = unit + 1 == n ? 0 : unit + 1, before = unit == 0 ? n - 1 : unit - 1,
                  second_before = unit < 2 ? unit + n - 2 : unit - 2;
        return myriad::vec<R, n_unit_state>{(y.of(next)[x] - y.of(second_before)[x]) * y.of(before)[x] - y[x] + p[F]};
    }
};
template <int n>
using lorenz96_units = myriad::coupled_units<lorenz96_unit, n>;

/// Errors judged as CuBIE, DifferentialEquations.jl and SUNDIALS do: the root mean square of the errors, each over atol
/// + rtol |y|. At equal tolerances it allows larger errors than the default.
using tsitouras_5_rms = myriad::controlled<myriad::tsitouras_5, myriad::rms_norm, myriad::mixed_scale>;

}  // namespace gpu_ensembles
