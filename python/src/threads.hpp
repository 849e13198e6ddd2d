// SPDX-License-Identifier: MIT
// The core's threads, which kernels and the host's loops share.
#pragma once

#include "myriad/host/threads/parallel.hpp"

namespace myriad::python {

/// Runs all parts, part 0 in the calling thread, the others in threads that wait for work between calls. A second team
/// at the same time, and one that needs more stack than these have, gets threads of its own. A forked child makes new
/// ones.
void start_team(openmp::team* all);

/// The number of threads worth using: OMP_NUM_THREADS, or the cores that this process may run on.
int usual_threads();

}  // namespace myriad::python
