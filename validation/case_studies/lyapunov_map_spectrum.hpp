// SPDX-License-Identifier: MIT
// The forced Duffing oscillator with both of its tangents.
#pragma once

#include "../../examples/lyapunov_map/forced_duffing.hpp"

using duffing_spectrum = myriad::with_tangents<forced_duffing, 2>;
