// SPDX-License-Identifier: MIT
// Compiles the kernel of Lorenz' equations.
#include <myriad/instantiate.hpp>

#include "benchmarks/large_study/model.hpp"

MYRIAD_INSTANTIATE(large_study::lorenz, myriad::runge_kutta_4)
