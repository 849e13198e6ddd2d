// SPDX-License-Identifier: MIT
// A traced model's functions for single instances.
#pragma once

#include "myriad/host/checks/instance_functions.hpp"
#include "tape.hpp"

namespace myriad::python {

/// The functions of the model of a tape, which must be the calling thread's when they are called; `stability_limit`: as
/// in `instance_functions`.
template <class R>
detail::instance_functions<R> functions_of_tape(const tape& model, double (*stability_limit)());

/// What studies call of single instances of an interpreted model: as in `kernel_library`.
struct called_instances {
    const void *functions, *behaviour;
};
called_instances instances_of_tape(const tape& model);

}  // namespace myriad::python
