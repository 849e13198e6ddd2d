// SPDX-License-Identifier: MIT
// Compiles the kernels of the model with names of the library's internals, of explicit, sampling and stiff methods.
#include "tests/kernel/model/own_names.hpp"

#include <myriad/instantiate.hpp>

#define METHODS myriad::runge_kutta_4, myriad::dense<myriad::dormand_prince_5>, myriad::rodas_5p

MYRIAD_INSTANTIATE(plainly_named, METHODS)
MYRIAD_INSTANTIATE(strangely_named, METHODS)
