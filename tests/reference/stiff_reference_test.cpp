// SPDX-License-Identifier: MIT
// Stiff problems with end values computed in quadruple precision.
#include "myriad/myriad.hpp"
#include "tests/catch.hpp"
