// SPDX-License-Identifier: MIT
// Where an ensemble is integrated: myriad::device.
#pragma once

#include "myriad/host/backend/device.hpp"
