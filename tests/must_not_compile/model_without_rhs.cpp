// expect: the model has no right-hand side: give it
// SPDX-License-Identifier: MIT
// A model needs a right-hand side.
#include "myriad/instantiate.hpp"
#include "myriad/model.hpp"

struct decay {
    enum state { x, n_state };
    enum parameter { k, n_parameter };
};

MYRIAD_INSTANTIATE(decay, myriad::runge_kutta_4)
