// SPDX-License-Identifier: MIT
// High irradiance responses, stiff, with eight states.
#pragma once

#include "problems/hires.hpp"

namespace validation {

using problems::hires;

}  // namespace validation
