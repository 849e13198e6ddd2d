// SPDX-License-Identifier: MIT
// The kernel of Lorenz' equations with a tangent.
#include <myriad/instantiate.hpp>
#include <myriad/methods.hpp>

#include "lorenz.hpp"

MYRIAD_INSTANTIATE(validation::lorenz_tangent, myriad::tsitouras_5)
