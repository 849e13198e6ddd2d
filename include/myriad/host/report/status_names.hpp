// SPDX-License-Identifier: MIT
// Names of statuses.
#pragma once

#include "myriad/kernel/core/status.hpp"

namespace myriad {

/// The name of a status, as in the code.
const char* name_of(status s);

}  // namespace myriad
