// SPDX-License-Identifier: MIT
// Compiles the pendulum's kernels: with a method of the library and with the example's own.
#include "models.hpp"

#include <myriad/instantiate.hpp>

#include "bogacki_shampine_3.hpp"

// snippet: instantiate
MYRIAD_INSTANTIATE(pendulum, myriad::tsitouras_5, bogacki_shampine_3)
// end of snippet
