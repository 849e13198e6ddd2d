// SPDX-License-Identifier: MIT
// Where the tests integrate: on the CPU, or wherever the environment variable MYRIAD_TEST_DEVICE says, so that the same
// programs test each backend.
#pragma once

#include <cstdlib>

#include "myriad/device.hpp"

namespace tests {

/// The device under test; on the CPU, with that number of threads.
inline myriad::device test_device(int threads = 1) {
    const char* const name = std::getenv("MYRIAD_TEST_DEVICE");
    return name == nullptr ? myriad::device::cpu(threads) : myriad::device::parse(name);
}

/// False where a test of threads, lanes or progress has no meaning.
inline bool tests_cpu() { return test_device().which() == myriad::device::kind::cpu; }

}  // namespace tests
