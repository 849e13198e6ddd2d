// SPDX-License-Identifier: MIT
// Actions that run later, for models with stop times.
#pragma once

#include "myriad/kernel/core/language.hpp"
#include "myriad/kernel/model/action_queue.hpp"
