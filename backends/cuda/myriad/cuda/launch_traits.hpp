// SPDX-License-Identifier: MIT
// What the launch of a kernel depends on besides its compiled resources: for host code and for what compiles kernels.
#pragma once

#include "myriad/kernel/state/kernel_arguments.hpp"

namespace myriad::cuda {

/// The places for which a model's kernel is compiled: the constant bank for few shared parameters, the others for many.
constexpr bool is_compiled(shared_placement placement, int shared_bytes) {
    return (shared_bytes <= 1024) == (placement == shared_placement::constant_bank);
}

/// What the launch of a kernel depends on besides its compiled resources.
struct kernel_traits {
    int n_shared, n_shared_integer;
    int shared_bytes;    // of both
    int max_block_size;  // as the model or the library limits it
    bool costs_differ;   // whether instances may differ in cost
};

}  // namespace myriad::cuda
