// SPDX-License-Identifier: MIT
// The names of the methods, once. Declarations, the program, validation, the scripts and the Python package have them
// from here.
#pragma once

#define MYRIAD_EXPLICIT_METHODS(DO) \
    DO(runge_kutta_4) DO(cash_karp) DO(tsitouras_5) DO(dormand_prince_5) DO(verner_7) DO(dormand_prince_8) DO(verner_9)
#define MYRIAD_STIFF_METHODS(DO) DO(rosenbrock_23) DO(rodas_5p)
#define MYRIAD_STOCHASTIC_METHODS(DO) \
    DO(euler_maruyama) DO(milstein) DO(stochastic_heun) DO(sra1) DO(sriw1) DO(dri1) DO(linearly_implicit_euler_maruyama)
#define MYRIAD_METHODS(DO) MYRIAD_EXPLICIT_METHODS(DO) MYRIAD_STIFF_METHODS(DO) MYRIAD_STOCHASTIC_METHODS(DO)
