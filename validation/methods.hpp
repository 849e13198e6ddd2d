// SPDX-License-Identifier: MIT
// The validated methods: those of the library. Each is instantiated with dense output, which without samples takes the
// same steps, bit for bit.
#pragma once

#include <myriad/methods.hpp>

#if defined(MYRIAD_VALIDATE_FEW_METHODS)  // to save compile time: one kernel per problem and method
#define VALIDATED_METHODS(DO) DO(runge_kutta_4) DO(cash_karp) DO(tsitouras_5)
#define VALIDATED_STIFF_METHODS(DO) DO(rodas_5p)
#else
/// Non-stiff problems are integrated with each of these.
#define VALIDATED_METHODS(DO) MYRIAD_EXPLICIT_METHODS(DO)
/// Stiff problems are integrated with each of these.
#define VALIDATED_STIFF_METHODS(DO) MYRIAD_STIFF_METHODS(DO)
#endif
/// Some problems also in single precision.
#define VALIDATED_FLOAT_METHODS(DO) DO(tsitouras_5)
