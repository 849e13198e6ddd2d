// SPDX-License-Identifier: MIT
// The kernels and adjoints of these models.
#include "tests/host/solve/adjoint_models.hpp"

#include <myriad/instantiate_adjoint.hpp>

using explicit_method = myriad::dense<myriad::dormand_prince_5>;
using stiff_method = myriad::dense<myriad::rodas_5p>;

MYRIAD_INSTANTIATE(adjoints::decay, explicit_method)
MYRIAD_INSTANTIATE_ADJOINT(adjoints::decay, explicit_method)
MYRIAD_INSTANTIATE(adjoints::network, explicit_method, myriad::dense<myriad::runge_kutta_4>)
MYRIAD_INSTANTIATE_ADJOINT(adjoints::network, explicit_method)
MYRIAD_INSTANTIATE(adjoints::network_by_all, explicit_method)
MYRIAD_INSTANTIATE(adjoints::kinetics, stiff_method)
MYRIAD_INSTANTIATE_ADJOINT(adjoints::kinetics, stiff_method)
MYRIAD_INSTANTIATE(adjoints::kinetics_by_all, stiff_method)
MYRIAD_INSTANTIATE(adjoints::guarded, explicit_method)
MYRIAD_INSTANTIATE_ADJOINT(adjoints::guarded, explicit_method)
