// SPDX-License-Identifier: MIT
// Compiles the kernels of the van der Pol oscillator.
#include <myriad/instantiate.hpp>

#include "van_der_pol.hpp"

MYRIAD_INSTANTIATE(gpu_ensembles::van_der_pol, myriad::dormand_prince_5, myriad::cash_karp)
MYRIAD_INSTANTIATE(gpu_ensembles::van_der_pol_units, myriad::dormand_prince_5)
MYRIAD_INSTANTIATE_FLOAT(gpu_ensembles::van_der_pol, myriad::dormand_prince_5, myriad::cash_karp)
MYRIAD_INSTANTIATE_FLOAT(gpu_ensembles::van_der_pol_units, myriad::dormand_prince_5)
