// SPDX-License-Identifier: MIT
// What the header of a model includes: vectors, elementary functions and selection, and nothing of the host side.
#pragma once

#include "myriad/kernel/core/language.hpp"
#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/core/status.hpp"
#include "myriad/kernel/core/vec.hpp"
#include "myriad/kernel/model/jacobian_pattern.hpp"
#include "myriad/kernel/model/mass_matrix.hpp"
#include "myriad/kernel/model/recurring.hpp"
#include "myriad/kernel/model/summaries.hpp"
#include "myriad/kernel/model/tables.hpp"
#include "myriad/kernel/scalar/floored_division.hpp"
#include "myriad/kernel/scalar/math.hpp"
#include "myriad/kernel/scalar/matrix_loop.hpp"
#include "myriad/kernel/scalar/select.hpp"
#include "myriad/kernel/scalar/wrapping.hpp"
