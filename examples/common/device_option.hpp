// SPDX-License-Identifier: MIT
// The option `--device`: its values, and the device chosen.
#pragma once

#include <iostream>
#include <string>

#include "myriad/device.hpp"
#include "myriad/host/backend/backend.hpp"

namespace examples {

/// The values that `--device` accepts in this program.
inline std::string device_help() {
    const bool with_cuda = myriad::host::if_defined(&myriad::cuda::list_devices) != nullptr;
    return with_cuda ? "Where to compute: auto (a GPU if there is one), cpu, cpu:THREADS, cuda or cuda:NUMBER"
                     : "Where to compute: auto, cpu or cpu:THREADS (built without the CUDA backend)";
}

/// Prints where the sweep is computed and, if a GPU was wanted, why there is none.
inline void announce(const std::string& wanted, const myriad::device& device) {
    std::cerr << "Computing on " << device.name();
    if (device.which() == myriad::device::kind::cuda) {
        std::cerr << " (" << device.description() << ')';
    } else if (wanted == "auto") {
        std::cerr << "; no GPU: " << myriad::device::no_gpu();
    }
    std::cerr << '\n';
}

}  // namespace examples
