// SPDX-License-Identifier: MIT
// Compiles the kernels of the methods with chosen step-size controls.
#include "tests/kernel/methods/controller_policies.hpp"

#include <myriad/instantiate.hpp>

#include "tests/support/problems.hpp"

MYRIAD_INSTANTIATE(problems::van_der_pol, choices::pi, choices::pid, choices::averaged, choices::automatic,
                   choices::high_order, choices::plain, choices::scaled)
