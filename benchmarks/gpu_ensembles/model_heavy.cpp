// SPDX-License-Identifier: MIT
// Compiles the kernels of the models with heavy right-hand sides in double precision.
#include <myriad/instantiate.hpp>
#include <myriad/methods.hpp>

#include "problems/hodgkin_huxley.hpp"
#include "problems/kuramoto.hpp"

MYRIAD_INSTANTIATE(problems::hodgkin_huxley, myriad::dormand_prince_5)
MYRIAD_INSTANTIATE(problems::kuramoto<8>, myriad::dormand_prince_5)
MYRIAD_INSTANTIATE(problems::kuramoto<16>, myriad::dormand_prince_5)
MYRIAD_INSTANTIATE(problems::kuramoto<32>, myriad::dormand_prince_5)
