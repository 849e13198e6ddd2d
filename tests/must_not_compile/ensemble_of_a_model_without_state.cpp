// expect: the model has no state: give it `enum state
// SPDX-License-Identifier: MIT
// The ensemble reports this too, where no kernel is compiled.
#include "myriad/myriad.hpp"

struct decay {
    enum parameter { k, n_parameter };
};

myriad::ensemble<decay> sweep(10);
