// SPDX-License-Identifier: MIT
// The methods that are validated: one entry in one of these lists adds a method everywhere. Each is instantiated with
// dense output, which without samples takes the same steps, bit for bit.
#pragma once

#include <myriad/methods.hpp>

/// Non-stiff problems are integrated with each of these.
#define VALIDATED_METHODS(DO) DO(runge_kutta_4) DO(cash_karp) DO(tsitouras_5)
/// Stiff problems with each of these; none yet, so that for them only the references are compared with each other.
#define VALIDATED_STIFF_METHODS(DO)
/// Some problems in single precision too.
#define VALIDATED_FLOAT_METHODS(DO) DO(tsitouras_5)
