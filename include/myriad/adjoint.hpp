// SPDX-License-Identifier: MIT
// Gradients of a number that depends on the solution, by all initial states and parameters: myriad::adjoint.
#pragma once

#include "myriad/host/solve/adjoint.hpp"
#include "myriad/kernel/core/language.hpp"
