// SPDX-License-Identifier: MIT
// Compiles the kernels of the cluster.
#include "cluster.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(bubble_cluster, myriad::cash_karp)
