// SPDX-License-Identifier: MIT
// What a report says of a kernel on a GPU.
#pragma once

#include <cstdint>

#include "myriad/host/options/schedule.hpp"
#include "myriad/kernel/state/kernel_arguments.hpp"

namespace myriad::cuda {

/// A CUDA kernel and how it is launched.
struct kernel_facts {
    int block_size = 0;             ///< of the last launch; before the first, the size with the best occupancy
    int registers = 0;              ///< per thread
    std::int64_t local_bytes = 0;   ///< per thread: stack frame and spilled registers
    std::int64_t shared_bytes = 0;  ///< of shared memory per block
    /// Where the kernel read the shared parameters.
    myriad::shared_placement shared_placement = myriad::shared_placement::constant_bank;
    myriad::schedule schedule = myriad::schedule::in_order;  ///< of the last call of `integrate`
    int blocks_per_multiprocessor = 0;  ///< resident at the same time, for the size with the best occupancy
    int threads_per_instance = 1;       ///< that integrate one together: a team, of coupled units
};

}  // namespace myriad::cuda
