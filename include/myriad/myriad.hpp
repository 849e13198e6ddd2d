// SPDX-License-Identifier: MIT
// The library for host code: ensembles, devices, options, solve and reports.
#pragma once

#include "myriad/host/backend/device.hpp"
#include "myriad/host/ensemble/couplings.hpp"
#include "myriad/host/ensemble/ensemble.hpp"
#include "myriad/host/ensemble/exponents.hpp"
#include "myriad/host/ensemble/sensitivities.hpp"
#include "myriad/host/model/describe.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/host/report/progress.hpp"
#include "myriad/host/report/report.hpp"
#include "myriad/host/solve/solve.hpp"
#include "myriad/host/solve/solver.hpp"
#include "myriad/kernel/core/language.hpp"
#include "myriad/methods.hpp"
#include "myriad/model.hpp"
#include "myriad/version.hpp"
