// SPDX-License-Identifier: MIT
// Compiles the kernels of models with delays, with and without neighbouring solutions.
#include "varied_past_models.hpp"

#include <myriad/instantiate.hpp>
#include <myriad/sensitivity.hpp>
#include <myriad/tangent.hpp>

#define MYRIAD_WITH_SENSITIVITIES(Model, ...)                                                                      \
    MYRIAD_INSTANTIATE(varied::Model, __VA_ARGS__)                                                                 \
    using Model##_by_parameters = myriad::with_sensitivities<varied::Model, varied::Model::tau, varied::Model::a>; \
    MYRIAD_INSTANTIATE(Model##_by_parameters, __VA_ARGS__)

MYRIAD_WITH_SENSITIVITIES(smooth, myriad::runge_kutta_4, myriad::rodas_5p)
MYRIAD_WITH_SENSITIVITIES(jumping, myriad::dormand_prince_5, myriad::cash_karp)
MYRIAD_WITH_SENSITIVITIES(kicked, myriad::dormand_prince_5)
MYRIAD_WITH_SENSITIVITIES(bent, myriad::dormand_prince_5)
MYRIAD_WITH_SENSITIVITIES(struck, myriad::dormand_prince_5)
using exponential_tangent = myriad::with_tangents<varied::exponential>;
MYRIAD_INSTANTIATE(exponential_tangent, myriad::dormand_prince_5)
using kicked_tangent = myriad::with_tangents<varied::kicked>;
MYRIAD_INSTANTIATE(kicked_tangent, myriad::dormand_prince_5)
