// expect: an ensemble.s real type is double or float
// SPDX-License-Identifier: MIT
// Reals are double or float.
#include "myriad/myriad.hpp"

struct decay {
    enum state { x, n_state };
    enum parameter { k, n_parameter };
    enum accessory { peak, n_accessory };
    enum integer_accessory { count, n_integer_accessory };
    enum shared { force, n_shared };
    enum shared_integer { mode, n_shared_integer };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return myriad::vec<R, n_state>{-(p[k] * y[x])};
    }
};

myriad::ensemble<decay, int> sweep(10);
