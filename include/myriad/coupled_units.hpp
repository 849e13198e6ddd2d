// SPDX-License-Identifier: MIT
// A model of units that are alike, written for one of them: myriad::coupled_units.
#pragma once

#include "myriad/kernel/core/language.hpp"
#include "myriad/kernel/model/coupled_units.hpp"
