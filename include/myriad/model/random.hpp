// SPDX-License-Identifier: MIT
// The former path of <myriad/random.hpp>.
#pragma once

#include "myriad/random.hpp"
