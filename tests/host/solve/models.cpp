// SPDX-License-Identifier: MIT
// Compiles the kernels of the models for the tests of solvers and backends.
#include "models.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(solving::swing, myriad::runge_kutta_4, myriad::cash_karp, myriad::dense<myriad::tsitouras_5>)
MYRIAD_INSTANTIATE_FLOAT(solving::swing, myriad::cash_karp)
MYRIAD_INSTANTIATE(solving::heat, myriad::runge_kutta_4)
MYRIAD_INSTANTIATE(solving::drift, myriad::runge_kutta_4, myriad::cash_karp)
MYRIAD_INSTANTIATE(solving::long_chain, myriad::dense<myriad::dormand_prince_5>)
