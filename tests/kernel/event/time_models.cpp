// SPDX-License-Identifier: MIT
// Compiles the kernels of the models of time_models.hpp, and those of logged_motion.hpp and levels.hpp that need no
// packs.
#include "time_models.hpp"

#include <myriad/instantiate.hpp>

#include "levels.hpp"
#include "logged_motion.hpp"
#include "methods.hpp"

MYRIAD_INSTANTIATE(wave, ALL_METHODS)
MYRIAD_INSTANTIATE(gate, ALL_METHODS)
MYRIAD_INSTANTIATE(pendulum, ALL_METHODS)
MYRIAD_INSTANTIATE(walled, ALL_METHODS)
MYRIAD_INSTANTIATE(settling, ALL_METHODS)
MYRIAD_INSTANTIATE_FLOAT(settling, myriad::cash_karp)
MYRIAD_INSTANTIATE_FLOAT(logged_motion, myriad::tsitouras_5, myriad::dormand_prince_8)
MYRIAD_INSTANTIATE(levels, myriad::tsitouras_5)
#if defined(MYRIAD_NIGHTLY)
MYRIAD_INSTANTIATE(levels, myriad::dormand_prince_8)
#endif
MYRIAD_INSTANTIATE(logged_motion, myriad::cash_karp, myriad::tsitouras_5)
MYRIAD_INSTANTIATE_FLOAT(logged_motion, myriad::cash_karp)
