// SPDX-License-Identifier: MIT
// Compiles the kernels of the stochastic equations.
#include <myriad/instantiate.hpp>
#include <myriad/methods.hpp>

#include "problems/geometric_brownian_motion.hpp"
#include "problems/stress_response.hpp"

MYRIAD_INSTANTIATE(problems::geometric_brownian_motion, myriad::euler_maruyama)
MYRIAD_INSTANTIATE_FLOAT(problems::geometric_brownian_motion, myriad::euler_maruyama)
MYRIAD_INSTANTIATE(problems::stress_response, myriad::euler_maruyama)
MYRIAD_INSTANTIATE_FLOAT(problems::stress_response, myriad::euler_maruyama)
