// SPDX-License-Identifier: MIT
// The count of evaluations.
#include <atomic>

#include "tests/support/counted.hpp"

namespace counted {
namespace {
std::atomic<std::int64_t> evaluations{0};
}

void add() { evaluations.fetch_add(1, std::memory_order_relaxed); }
std::int64_t take() {
    std::int64_t sum = evaluations.exchange(0);
    tests::for_each_kernel_variable<kernel_count>([&](kernel_count& count) {
        sum += static_cast<std::int64_t>(count.evaluations);
        count.evaluations = 0;
    });
    return sum;
}

}  // namespace counted
