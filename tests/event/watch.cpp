// SPDX-License-Identifier: MIT
// Compiles the kernels of the model that the tests of events watch.
#include "watch.hpp"

#include <myriad/instantiate.hpp>

#include "methods.hpp"

MYRIAD_INSTANTIATE(watch, ALL_ORDERS)
MYRIAD_INSTANTIATE_FLOAT(watch, myriad::cash_karp)
