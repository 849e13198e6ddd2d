// SPDX-License-Identifier: MIT
// The kernels of models with events and tangents, and of one without tangents.
#include <myriad/instantiate.hpp>

#include "tests/kernel/model/tangent_models.hpp"

MYRIAD_INSTANTIATE(tangents::table, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(tangents::table_spectrum, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(myriad::with_tangents<tangents::gear>, myriad::cash_karp)
MYRIAD_INSTANTIATE(myriad::with_tangents<tangents::dip>, myriad::cash_karp)
