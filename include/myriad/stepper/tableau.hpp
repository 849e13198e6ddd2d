// SPDX-License-Identifier: MIT
// The former path of <myriad/tableau.hpp>.
#pragma once

#include "myriad/tableau.hpp"
