// SPDX-License-Identifier: MIT
// The kernels of models with sensitivities, and of some without.
#include <myriad/instantiate.hpp>

#include "tests/kernel/model/sensitivity_models.hpp"

MYRIAD_INSTANTIATE(sensitivities::decay, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(sensitivities::decay_by_all, myriad::dense<myriad::tsitouras_5>, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(sensitivities::decay_by_domain, myriad::dense<myriad::tsitouras_5>)
MYRIAD_INSTANTIATE(sensitivities::uncontrolled_decay, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(sensitivities::ball_by_all, myriad::dense<myriad::tsitouras_5>)
MYRIAD_INSTANTIATE(sensitivities::ramp_by_all, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(sensitivities::ramp_by_times, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(sensitivities::dose_by_all, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(sensitivities::inflection_by_c, myriad::tsitouras_5)
MYRIAD_INSTANTIATE(sensitivities::saw_by_domain, myriad::tsitouras_5)
