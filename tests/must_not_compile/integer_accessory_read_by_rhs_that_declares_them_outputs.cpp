// expect: no member named.*integer_accessory
// SPDX-License-Identifier: MIT
// A model that says that rhs does not see accessories does not see integer ones either.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct decay {
    static constexpr bool accessories_are_outputs = true;
    enum state { x, n_state };
    enum integer_accessory { mode, n_integer_accessory };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return myriad::vec<R, n_state>{myriad::select(p.integer_accessory[mode] == 1, R(0), -y[x])};
    }
};

MYRIAD_INSTANTIATE(decay, myriad::runge_kutta_4)
