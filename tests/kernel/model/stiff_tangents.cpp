// SPDX-License-Identifier: MIT
// The kernels of stiff models with tangents.
#include "tests/kernel/model/stiff_tangents.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(stiff_tangents::ring, myriad::rodas_5p)
MYRIAD_INSTANTIATE(stiff_tangents::ring_with_two, myriad::rodas_5p)
MYRIAD_INSTANTIATE(stiff_tangents::forced_with_one, myriad::tsitouras_5, myriad::rodas_5p, myriad::rosenbrock_23)
MYRIAD_INSTANTIATE(stiff::prothero_robinson_with_tangent, myriad::rodas_5p)
MYRIAD_INSTANTIATE(tangents::table_spectrum, myriad::rodas_5p)
