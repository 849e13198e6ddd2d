// expect: narrowing.*double.* to .*float|cannot be narrowed from type 'double' to .*float|conversion from 'double' to .*float|loses floating-point precision: 'double' to 'float'
// SPDX-License-Identifier: MIT
// A double literal would make a hook of a float model compute in double.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct decay {
    enum state { x, n_state };
    enum parameter { k, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return myriad::vec<R, n_state>{-(p[k] * y[x])};
    }
    MYRIAD_FUNCTION static void finalise(auto& lane) { lane.y[x] = 0.1 * lane.y[x]; }
};

MYRIAD_INSTANTIATE_FLOAT(decay, myriad::runge_kutta_4)
