// SPDX-License-Identifier: MIT
// The kernels of smooth flows with tangents, and of one without.
#include <myriad/instantiate.hpp>

#include "tests/kernel/model/tangent_models.hpp"

MYRIAD_INSTANTIATE(tangents::lorenz, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(tangents::lorenz_spectrum, myriad::tsitouras_5)
MYRIAD_INSTANTIATE_FLOAT(tangents::lorenz_spectrum, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(myriad::with_tangents<tangents::roessler>, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(tangents::strong_roessler_spectrum, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(tangents::spiral_spectrum, myriad::runge_kutta_4, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(tangents::van_der_pol_spectrum, myriad::cash_karp)
