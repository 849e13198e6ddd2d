// SPDX-License-Identifier: MIT
// A stiff network of 48 states.
#pragma once

#include "problems/van_der_pol_ring.hpp"

namespace validation {

using ring_of_48 = problems::van_der_pol_ring<48>;

}  // namespace validation
