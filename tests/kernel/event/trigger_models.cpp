// SPDX-License-Identifier: MIT
// Compiles the kernels of the models with triggers.
#include "trigger_models.hpp"

#include <myriad/instantiate.hpp>

MYRIAD_INSTANTIATE(triggers::logic, myriad::runge_kutta_4, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(triggers::alone<triggers::logic>, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(triggers::chain, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(triggers::alone<triggers::chain>, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(triggers::thermostat, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(triggers::relay, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(triggers::cascade, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(triggers::alone<triggers::cascade>, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(triggers::edges, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(triggers::alone<triggers::edges>, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(triggers::falling, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(triggers::alone<triggers::falling>, myriad::tsitouras_5)
