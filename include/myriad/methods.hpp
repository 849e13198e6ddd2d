// SPDX-License-Identifier: MIT
// All methods of integration.
#pragma once

#include "myriad/controller/choices.hpp"
#include "myriad/core/language.hpp"
#include "myriad/stepper/methods/cash_karp.hpp"
#include "myriad/stepper/methods/dense.hpp"
#include "myriad/stepper/methods/dormand_prince_5.hpp"
#include "myriad/stepper/methods/dormand_prince_8.hpp"
#include "myriad/stepper/methods/rodas_5p.hpp"
#include "myriad/stepper/methods/rosenbrock_23.hpp"
#include "myriad/stepper/methods/runge_kutta_4.hpp"
#include "myriad/stepper/methods/tsitouras_5.hpp"
#include "myriad/stepper/methods/verner_7.hpp"
