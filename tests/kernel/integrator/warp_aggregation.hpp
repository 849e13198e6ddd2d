// SPDX-License-Identifier: MIT
// The Duffing oscillator twice: in one kernel threads go on at once, in the other they wait as those of a warp do.
#pragma once

#include "examples/duffing/duffing.hpp"

namespace warp_aggregation {

struct at_once : duffing {};
struct waiting : duffing {};

}  // namespace warp_aggregation
