// SPDX-License-Identifier: MIT
// The kernels of coupled units with delays.
#include "delayed_units.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(delayed_units::phases<5>, myriad::tsitouras_5, myriad::runge_kutta_4)
MYRIAD_INSTANTIATE(delayed_units::written_phases<5>, myriad::tsitouras_5, myriad::runge_kutta_4)
MYRIAD_INSTANTIATE(delayed_units::phases<20>, myriad::dormand_prince_5)
MYRIAD_INSTANTIATE(delayed_units::written_phases<20>, myriad::dormand_prince_5)
MYRIAD_INSTANTIATE(delayed_units::cells, myriad::dormand_prince_5)
MYRIAD_INSTANTIATE(delayed_units::written_cells, myriad::dormand_prince_5)
MYRIAD_INSTANTIATE(delayed_units::changing_units, myriad::dormand_prince_5, myriad::rodas_5p)
MYRIAD_INSTANTIATE(delayed_units::written_changing, myriad::dormand_prince_5, myriad::rodas_5p)
MYRIAD_INSTANTIATE(delayed_units::phases_with_tangent, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(delayed_units::written_with_tangent, myriad::tsitouras_5)
