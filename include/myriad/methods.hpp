// SPDX-License-Identifier: MIT
// All methods of integration.
#pragma once

#include "myriad/kernel/core/language.hpp"
#include "myriad/kernel/methods/cash_karp.hpp"
#include "myriad/kernel/methods/controller_policies.hpp"
#include "myriad/kernel/methods/dense.hpp"
#include "myriad/kernel/methods/dormand_prince_5.hpp"
#include "myriad/kernel/methods/dormand_prince_8.hpp"
#include "myriad/kernel/methods/dri1.hpp"
#include "myriad/kernel/methods/euler_maruyama.hpp"
#include "myriad/kernel/methods/linearly_implicit_euler_maruyama.hpp"
#include "myriad/kernel/methods/method_list.hpp"
#include "myriad/kernel/methods/milstein.hpp"
#include "myriad/kernel/methods/rodas_5p.hpp"
#include "myriad/kernel/methods/rosenbrock_23.hpp"
#include "myriad/kernel/methods/runge_kutta_4.hpp"
#include "myriad/kernel/methods/sra1.hpp"
#include "myriad/kernel/methods/sriw1.hpp"
#include "myriad/kernel/methods/stochastic_heun.hpp"
#include "myriad/kernel/methods/tsitouras_5.hpp"
#include "myriad/kernel/methods/verner_7.hpp"
#include "myriad/kernel/methods/verner_9.hpp"
