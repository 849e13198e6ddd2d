// SPDX-License-Identifier: MIT
// The Duffing oscillator twice: in one kernel threads go on at once, in the other they wait as a GPU's do for company.
#pragma once

#include "examples/duffing/duffing.hpp"

namespace company {

struct at_once : duffing {};
struct waiting : duffing {};

}  // namespace company
