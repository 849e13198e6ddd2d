// expect: this enumerator is not a state
// SPDX-License-Identifier: MIT
// Enumerators of another kind are a mix-up, even where their number fits.
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

auto look(myriad::ensemble<decay>& sweep) { return sweep.state(decay::k); }
