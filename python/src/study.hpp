// SPDX-License-Identifier: MIT
// The library's studies, of models that are known only at run time.
#pragma once

#include <nanobind/nanobind.h>

namespace myriad::python {

/// Adds classes Study, HandedOut, Results and their functions to the module, after `Library` and `Options`.
void bind_study(nanobind::module_& m);

}  // namespace myriad::python
