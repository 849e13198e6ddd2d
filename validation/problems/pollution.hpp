// SPDX-License-Identifier: MIT
// The air pollution model, stiff, with 20 states.
#pragma once

#include "problems/pollution.hpp"

namespace validation {

using problems::pollution;

}  // namespace validation
