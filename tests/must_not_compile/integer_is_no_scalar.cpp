// expect: not a scalar kind: use double, float, pack or dual
// SPDX-License-Identifier: MIT
// An integer as the scalar of a state is refused by name.
#include "myriad/kernel/scalar/select.hpp"

using real = myriad::real_of<int>;
