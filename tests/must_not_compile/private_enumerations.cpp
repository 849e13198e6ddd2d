// expect: the model.s n_state is private: a model is a struct
// SPDX-License-Identifier: MIT
// A class begins with what is private.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

class model {
    enum state { x, n_state };


public:
    template <class R>
    MYRIAD_FUNCTION static myriad::vec<R, 1> rhs(auto, const myriad::vec<R, 1>& y, const auto&) {
        return myriad::vec<R, 1>{-y[0]};
    }
};

MYRIAD_INSTANTIATE(model, myriad::runge_kutta_4)
