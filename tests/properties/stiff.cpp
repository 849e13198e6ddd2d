// SPDX-License-Identifier: MIT
// The kernels of a stiff model, in packs of every size.
#include "tests/support/stiff.hpp"

#include "tests/properties/pack_sizes_body.hpp"

RUN_WITH_PACKS(stiff::van_der_pol, myriad::rodas_5p, double)
