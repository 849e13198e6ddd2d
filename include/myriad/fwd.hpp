// SPDX-License-Identifier: MIT
// Declarations of the library's types alone, for headers that only name them.
#pragma once

#include "myriad/host/core/declarations.hpp"
