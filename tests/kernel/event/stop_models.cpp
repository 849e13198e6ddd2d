// SPDX-License-Identifier: MIT
// Compiles the kernels of the models with stop times.
#include "stop_models.hpp"

#include <myriad/instantiate.hpp>
#include <myriad/tangent.hpp>

MYRIAD_INSTANTIATE(stops::dosed, myriad::runge_kutta_4, myriad::tsitouras_5, myriad::rodas_5p,
                   myriad::dense<myriad::tsitouras_5>, myriad::dense<myriad::runge_kutta_4>)
MYRIAD_INSTANTIATE_FLOAT(stops::dosed, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(stops::listed, myriad::runge_kutta_4, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(stops::infused, myriad::runge_kutta_4, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(stops::delayed, myriad::runge_kutta_4, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(stops::kicked, myriad::runge_kutta_4, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(stops::prolonged, myriad::runge_kutta_4, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(stops::alone<stops::dosed>, myriad::runge_kutta_4, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(stops::alone<stops::delayed>, myriad::runge_kutta_4, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(stops::alone<stops::kicked>, myriad::runge_kutta_4, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(myriad::with_tangents<stops::squared>, myriad::tsitouras_5)
