// expect: jacobian has a wrong signature: it must be
// SPDX-License-Identifier: MIT
// A Jacobian is square, with a row for every component.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct rotation {
    enum state { x, y, n_state };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, n_state> rhs(auto, const myriad::vec<R, n_state>& s, const auto&) {
        return {s[y], -s[x]};
    }
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<myriad::vec<R, n_state>, 3> jacobian(auto, const myriad::vec<R, n_state>&,
                                                                            const auto&) {
        return {};
    }
};

MYRIAD_INSTANTIATE(rotation, myriad::rodas_5p)
