// SPDX-License-Identifier: MIT
// Compiles the kernels of the models of models.hpp; `forgotten` is left out on purpose, as is tsitouras_5.
#include "models.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(ensemble_models::complete, myriad::cash_karp)
MYRIAD_INSTANTIATE(ensemble_models::watched, myriad::cash_karp, myriad::runge_kutta_4, myriad::dense<myriad::cash_karp>)
MYRIAD_INSTANTIATE(ensemble_models::hooked, myriad::cash_karp)
MYRIAD_INSTANTIATE(ensemble_models::bare, myriad::cash_karp, myriad::runge_kutta_4, myriad::dense<myriad::cash_karp>)
MYRIAD_INSTANTIATE_FLOAT(ensemble_models::bare, myriad::cash_karp, myriad::runge_kutta_4)
