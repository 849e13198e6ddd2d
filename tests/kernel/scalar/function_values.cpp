// SPDX-License-Identifier: MIT
// Compiles the kernel that records function values.
#include "tests/kernel/scalar/function_values.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(function_values::values, myriad::runge_kutta_4)
MYRIAD_INSTANTIATE_FLOAT(function_values::values, myriad::runge_kutta_4)
MYRIAD_INSTANTIATE_FLOAT(function_values::elementary, myriad::runge_kutta_4)
