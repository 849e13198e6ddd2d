// case: double_literal_in_a_float_rhs
// expect: narrowing.*double.* to .*float|cannot be narrowed from type 'double' to .*float|conversion from 'double' to .*float|loses floating-point precision: 'double' to 'float'
// case: double_literal_in_a_float_hook
// expect: narrowing.*double.* to .*float|cannot be narrowed from type 'double' to .*float|conversion from 'double' to .*float|loses floating-point precision: 'double' to 'float'
// SPDX-License-Identifier: MIT
// A double literal would make a float model compute in double.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct decay {
    enum state { x, n_state };
    enum parameter { k, n_parameter };

    static constexpr bool scalar_only = true;

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
#ifdef CASE_double_literal_in_a_float_rhs
        return myriad::vec<R, n_state>{-0.1 * (p[k] * y[x])};
#else
        return myriad::vec<R, n_state>{-(p[k] * y[x])};
#endif
    }
#ifdef CASE_double_literal_in_a_float_hook
    MYRIAD_FUNCTION static void finalise(auto& lane) { lane.y[x] = 0.1 * lane.y[x]; }
#endif
};

MYRIAD_INSTANTIATE_FLOAT(decay, myriad::runge_kutta_4)
