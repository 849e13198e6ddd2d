// SPDX-License-Identifier: MIT
// The library for host code: ensembles, devices, options, solve and reports.
#pragma once

#include "myriad/core/language.hpp"
#include "myriad/device.hpp"
#include "myriad/ensemble/ensemble.hpp"
#include "myriad/ensemble/exponents.hpp"
#include "myriad/ensemble/report.hpp"
#include "myriad/integrator/options.hpp"
#include "myriad/methods.hpp"
#include "myriad/model.hpp"
#include "myriad/model/describe.hpp"
#include "myriad/solve.hpp"
#include "myriad/solver.hpp"
