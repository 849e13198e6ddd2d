// SPDX-License-Identifier: MIT
// A model together with its variational equations: myriad::with_tangents.
#pragma once

#include "myriad/kernel/core/language.hpp"
#include "myriad/kernel/model/tangent.hpp"
