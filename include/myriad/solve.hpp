// SPDX-License-Identifier: MIT
// One call that integrates an ensemble: myriad::solve.
#pragma once

#include "myriad/host/solve/solve.hpp"
#include "myriad/kernel/core/language.hpp"
