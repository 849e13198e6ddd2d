// SPDX-License-Identifier: MIT
// The GPU's runtime on top of the driver: gpu/runtime.hpp, and programs that are loaded.
#pragma once

#include "myriad/gpu/runtime.hpp"

namespace myriad::gpu {

/// Loads a program, machine code or PTX, on the current device.
result load_module(void** module, const void* image);
/// A kernel of it.
result find_kernel(const void** kernel, void* module, const char* name);
/// The version of CUDA that the driver has, 13000 for 13.0; 0 without a driver.
int driver_version();

}  // namespace myriad::gpu
