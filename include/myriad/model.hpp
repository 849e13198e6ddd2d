// SPDX-License-Identifier: MIT
// What the header of a model includes: vectors, elementary functions and selection, and nothing of the host side.
#pragma once

#include "myriad/core/language.hpp"
#include "myriad/core/macros.hpp"
#include "myriad/core/status.hpp"
#include "myriad/core/vec.hpp"
#include "myriad/scalar/math.hpp"
#include "myriad/scalar/matrix_loop.hpp"
#include "myriad/scalar/select.hpp"
