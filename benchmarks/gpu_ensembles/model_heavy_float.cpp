// SPDX-License-Identifier: MIT
// Compiles the kernels of the models with heavy right-hand sides in single precision.
#include <myriad/instantiate.hpp>
#include <myriad/methods.hpp>

#include "problems/hodgkin_huxley.hpp"
#include "problems/kuramoto.hpp"

MYRIAD_INSTANTIATE_FLOAT(problems::hodgkin_huxley, myriad::dormand_prince_5)
MYRIAD_INSTANTIATE_FLOAT(problems::kuramoto<8>, myriad::dormand_prince_5)
MYRIAD_INSTANTIATE_FLOAT(problems::kuramoto<16>, myriad::dormand_prince_5)
MYRIAD_INSTANTIATE_FLOAT(problems::kuramoto<32>, myriad::dormand_prince_5)
