// SPDX-License-Identifier: MIT
// One call of `solve` that is made again and again with other values of some components, from Python or from programs
// of XLA's, which do not hold Python's lock.
#pragma once

#include <nanobind/nanobind.h>

namespace myriad::python {

/// Adds RepeatedCall64 and RepeatedCall32 to the module, and `repeated_call`, the address of what XLA's handlers call.
void bind_repeated_call(nanobind::module_& m);

}  // namespace myriad::python
