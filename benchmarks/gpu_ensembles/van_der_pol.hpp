// SPDX-License-Identifier: MIT
// The models of the case van_der_pol_grid, x'' = mu (1 - x^2) x' - x: written as a whole, and as a unit.
#pragma once

#include <myriad/coupled_units.hpp>
#include <myriad/methods.hpp>
#include <myriad/model.hpp>

namespace gpu_ensembles {

struct van_der_pol {
    enum state { x, v, n_state };
    enum parameter { mu, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return {y[v], p[mu] * (R(1) - y[x] * y[x]) * y[v] - y[x]};
    }
};

struct van_der_pol_unit {
    enum unit_state { x, v, n_unit_state };
    enum unit_parameter { mu, n_unit_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_unit_state> rhs(int, auto, const auto& y, const auto& p) {
        return {y[v], p.unit_parameter[mu] * (R(1) - y[x] * y[x]) * y[v] - y[x]};
    }
};
using van_der_pol_units = myriad::coupled_units<van_der_pol_unit, 1>;

}  // namespace gpu_ensembles
