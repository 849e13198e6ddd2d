// SPDX-License-Identifier: MIT
// The log of hook calls.
#include "tests/support/recorder.hpp"

#include <utility>

namespace recorder {
namespace {
std::vector<call> log_of_calls;
}

void add(const call& c) { log_of_calls.push_back(c); }
std::vector<call> take() { return std::exchange(log_of_calls, {}); }

}  // namespace recorder
