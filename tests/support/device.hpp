// SPDX-License-Identifier: MIT
// The device of the tests: the CPU, or the one that the environment variable MYRIAD_TEST_DEVICE names, so that the same
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

/// False if tests of threads, lanes or progress have no meaning.
inline bool tests_cpu() { return test_device().which() == myriad::device::kind::cpu; }

}  // namespace tests
