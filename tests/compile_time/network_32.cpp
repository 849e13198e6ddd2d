// SPDX-License-Identifier: MIT
// A stiff network of 32 states whose Jacobian's pattern the compiler finds, for the limit of its compile time.
#include <myriad/instantiate.hpp>

#include "problems/van_der_pol_ring.hpp"

MYRIAD_INSTANTIATE(problems::van_der_pol_ring<32>, myriad::rodas_5p)
