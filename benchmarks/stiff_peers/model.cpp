// SPDX-License-Identifier: MIT
// Compiles the kernel of the benchmark.
#include <myriad/instantiate.hpp>

#include "problems/pollution.hpp"

MYRIAD_INSTANTIATE(problems::pollution, myriad::rodas_5p)
