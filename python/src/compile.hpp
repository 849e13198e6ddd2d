// SPDX-License-Identifier: MIT
// The compiler and the cache of compiled models, which the program `myriad` has too.
#pragma once

#include <nanobind/nanobind.h>

namespace myriad::python {

/// Adds class Compiler and the functions of the cache to the module.
void bind_compile(nanobind::module_& m);

}  // namespace myriad::python
