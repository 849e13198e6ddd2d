// SPDX-License-Identifier: MIT
// Compiles the kernels of the equations with delays.
#include <myriad/instantiate.hpp>
#include <myriad/methods.hpp>

#include "problems/delayed.hpp"

MYRIAD_INSTANTIATE(problems::delayed_lorenz, myriad::runge_kutta_4, myriad::dormand_prince_5)
MYRIAD_INSTANTIATE(problems::delayed_logistic, myriad::runge_kutta_4)
MYRIAD_INSTANTIATE(problems::twice_delayed_logistic, myriad::runge_kutta_4)
MYRIAD_INSTANTIATE(problems::delayed_ball, myriad::dormand_prince_5)
