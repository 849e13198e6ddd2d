// SPDX-License-Identifier: MIT
// Compiles the kernel of Lorenz' equations.
#include "benchmarks/large_study/model.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(large_study::lorenz, myriad::runge_kutta_4)
