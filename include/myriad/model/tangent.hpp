// SPDX-License-Identifier: MIT
// The former path of <myriad/tangent.hpp>.
#pragma once

#include "myriad/tangent.hpp"
