// SPDX-License-Identifier: MIT
// The count of evaluations.
#include <atomic>

#include "tests/support/counted.hpp"

namespace counted {
namespace {
std::atomic<std::int64_t> evaluations{0};
}

void add() { evaluations.fetch_add(1, std::memory_order_relaxed); }
std::int64_t take() { return evaluations.exchange(0); }

}  // namespace counted
