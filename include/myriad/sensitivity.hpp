// SPDX-License-Identifier: MIT
// A model together with the derivatives of its solution: myriad::with_sensitivities.
#pragma once

#include "myriad/kernel/core/language.hpp"
#include "myriad/kernel/model/sensitivity.hpp"
