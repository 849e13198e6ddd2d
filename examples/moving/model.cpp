// SPDX-License-Identifier: MIT
// The kernels of the model.
// snippet: instantiation
#include "model.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(van_der_pol, myriad::dormand_prince_5)
// end of snippet
