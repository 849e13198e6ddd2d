// expect: the model has no right-hand side: give it
// SPDX-License-Identifier: MIT
// The ensemble reports this too, where no kernel is compiled.
#include "myriad/myriad.hpp"

struct decay {
    enum state { x, n_state };
    enum parameter { k, n_parameter };
};

myriad::ensemble<decay> sweep(10);
