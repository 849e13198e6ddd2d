// SPDX-License-Identifier: MIT
// Compiles the kernels of the model with a queue.
#include "queued.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(queued, myriad::runge_kutta_4, myriad::tsitouras_5)
