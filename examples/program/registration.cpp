// SPDX-License-Identifier: MIT
// A program like `myriad` that has a model: one line makes it known.
#include <myriad/program.hpp>

#include "../quickstart/model.hpp"

// snippet: register
MYRIAD_REGISTER_MODEL(duffing, myriad::cash_karp)
// end of snippet
