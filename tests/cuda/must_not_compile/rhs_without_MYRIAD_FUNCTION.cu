// SPDX-License-Identifier: MIT
// The right-hand side is host code without MYRIAD_FUNCTION.
#include <myriad/instantiate.hpp>
#include <myriad/model.hpp>

struct ball {
    enum state { x, v, n_state };
    enum event { floor, n_event };

    template <class R>
    static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return {y[v], R(-1)};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_event> events(auto, const myriad::vec<R, n_state>& y, const auto&) {
        return myriad::vec<R, n_event>{y[x]};
    }
    MYRIAD_FUNCTION static void after_event(int, auto& lane) { lane.y[v] = -lane.y[v]; }
};

MYRIAD_INSTANTIATE(ball, myriad::cash_karp)
