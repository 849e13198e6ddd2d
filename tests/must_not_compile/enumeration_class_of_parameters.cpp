// expect: an enumeration .parameter. without its count.*without .class.
// SPDX-License-Identifier: MIT
// The enumerators of an enum class are not members of the model.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct model {
    enum state { x, n_state };
    enum class parameter { k, n_parameter };

    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> rhs(auto, const myriad::vec<R, 1>& y, const auto&) {
        return myriad::vec<R, 1>{-y[0]};
    }
};

MYRIAD_INSTANTIATE(model, myriad::runge_kutta_4)
