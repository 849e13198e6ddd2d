// SPDX-License-Identifier: MIT
// The ring modulator, stiff and driven, with 15 states.
#pragma once

#include "problems/ring_modulator.hpp"

namespace validation {

using problems::ring_modulator;

}  // namespace validation
