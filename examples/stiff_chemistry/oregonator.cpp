// SPDX-License-Identifier: MIT
// Compiles the kernel of the Oregonator.
#include "oregonator.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(oregonator, myriad::rodas_5p)
