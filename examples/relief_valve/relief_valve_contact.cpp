// SPDX-License-Identifier: MIT
// Compiles the kernel of the relief valve with resting contact.
#include "relief_valve_contact.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(relief_valve_contact, myriad::cash_karp)
