// SPDX-License-Identifier: MIT
// The threads of the program `myriad`, which itself has no kernel: those of OpenMP, as kernels bring them.
#include "myriad/openmp/team.hpp"
