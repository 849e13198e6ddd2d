// SPDX-License-Identifier: MIT
// Random numbers for the hooks of a model: myriad::random_numbers.
#pragma once

#include "myriad/kernel/core/language.hpp"
#include "myriad/kernel/model/random.hpp"
