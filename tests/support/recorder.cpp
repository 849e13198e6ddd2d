// SPDX-License-Identifier: MIT
// The log of hook calls.
#include "tests/support/recorder.hpp"

#include <stdexcept>
#include <utility>

namespace recorder {
namespace {
std::vector<call> log_of_calls;
}

void add(const call& c) { log_of_calls.push_back(c); }

std::vector<call> take() {
    tests::for_each_kernel_variable<kernel_log>([](kernel_log& log) {
        const unsigned int size = std::exchange(log.size, 0u);
        if (size > kernel_log::capacity) throw std::length_error("more calls in a kernel than its log can hold");
        log_of_calls.insert(log_of_calls.end(), log.calls, log.calls + size);
    });
    return std::exchange(log_of_calls, {});
}

}  // namespace recorder
