// SPDX-License-Identifier: MIT
// A function called by a hook is host code without MYRIAD_FUNCTION.
#include <myriad/instantiate.hpp>
#include <myriad/model.hpp>

inline double reflected(double v) { return -0.9 * v; }

struct ball {
    enum state { x, v, n_state };
    enum event { floor, n_event };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return {y[v], R(-1)};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_event>{y[x]};
    }
    MYRIAD_FUNCTION static void after_event(int, auto& lane) { lane.y[v] = reflected(lane.y[v]); }
};

MYRIAD_INSTANTIATE(ball, myriad::cash_karp)
