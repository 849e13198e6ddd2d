// SPDX-License-Identifier: MIT
// Compiles the kernels whose sensitivities are compared.
#include "validation/sensitivities/models.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(validation::robertson_by, myriad::rodas_5p)
MYRIAD_INSTANTIATE(validation::hires_by, myriad::rodas_5p)
MYRIAD_INSTANTIATE(validation::van_der_pol_by, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(validation::lorenz_by, myriad::tsitouras_5)
