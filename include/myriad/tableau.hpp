// SPDX-License-Identifier: MIT
// For methods of your own: tableaus of coefficients and their order conditions.
#pragma once

#include "myriad/kernel/core/language.hpp"
#include "myriad/kernel/methods/rosenbrock_tableau.hpp"
#include "myriad/kernel/methods/tableau.hpp"
