// expect: this enumerator is not a shared of the model; where the model declares anew .* give those of the inherited one as numbers
// SPDX-License-Identifier: MIT
// Which enumerations a model has inherited cannot be told; those that it has are its own.
#include "myriad/myriad.hpp"

struct decay {
    enum state { x, n_state };
    enum shared { rate, n_shared };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& y, const auto& p) {
        return myriad::vec<R, n_state>{-(p.shared[rate] * y[x])};
    }
};
struct limited : decay {
    enum shared { limit = decay::n_shared, n_shared };
};

auto look(myriad::ensemble<limited>& sweep) { return sweep.shared(limited::rate); }
