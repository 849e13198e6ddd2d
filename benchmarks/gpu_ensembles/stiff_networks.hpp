// SPDX-License-Identifier: MIT
// The models of the case stiff_networks. None declares a pattern: the compiler finds it.
#pragma once

#include <myriad/methods.hpp>
#include <myriad/model.hpp>

#include "problems/pollution.hpp"
#include "problems/robertson.hpp"
#include "problems/van_der_pol_ring.hpp"

namespace gpu_ensembles {

/// With rates of its own in each instance.
struct robertson {
    enum state { a, b, c, n_state };
    enum parameter { k1, k2, k3, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        const R slow = p[k1] * y[a], back = p[k2] * y[b] * y[c], fast = p[k3] * y[b] * y[b];
        return {back - slow, slow - back - fast, fast};
    }
};

}  // namespace gpu_ensembles
