// SPDX-License-Identifier: MIT
// A function called by a hook is host code without MYRIAD_FUNCTION, even if it is constexpr.
#include <myriad/instantiate.hpp>
#include <myriad/model.hpp>

constexpr double doubled(double x) { return 2 * x; }

struct decay {
    enum state { x, n_state };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return {-y[x]};
    }
    MYRIAD_FUNCTION static void initialise(auto& lane) { lane.y[x] = doubled(lane.t); }
};

MYRIAD_INSTANTIATE(decay, myriad::cash_karp)
