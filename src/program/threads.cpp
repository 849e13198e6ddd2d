// SPDX-License-Identifier: MIT
// The threads of the program `myriad`, which itself has no kernel: OpenMP's threads, as kernels bring them.
#include "myriad/openmp/team.hpp"
