// SPDX-License-Identifier: MIT
// What a model that was compiled for GPUs tells of itself and of its launches.
#pragma once

#include "myriad/cuda/launch_traits.hpp"
#include "myriad/python/compiled_facts.hpp"

namespace myriad::python {

/// What a compiled program tells of itself, by its kernel `myriad_tell_facts`.
struct device_facts {
    compiled_facts facts;
    cuda::kernel_traits traits;
    myriad::shared_placement shared_placement;
};

}  // namespace myriad::python
