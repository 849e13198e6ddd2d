// SPDX-License-Identifier: MIT
// The options of an integration: myriad::options.
#pragma once

#include "myriad/host/options/options.hpp"
