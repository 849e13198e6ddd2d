// SPDX-License-Identifier: MIT
// Constructs that the OpenMP backend may use, free of races: atomic counter, critical section, reduction, omp atomic,
// and data written in one parallel region and read in the next. The thread sanitizer must stay silent.
#include <atomic>
#include <cstdio>
#include <vector>

namespace {
constexpr long n = 20000;
}

int main() {
    std::vector<long> values(n, 0);
    std::atomic<long> next{0};
    long by_critical = 0;
    long by_atomic = 0;
    long by_reduction = 0;
    long by_next_region = 0;
#pragma omp parallel num_threads(4) default(none) shared(values, next, by_critical)
    {
        long taken = 0;
        for (long i = next.fetch_add(1, std::memory_order_relaxed); i < n;
             i = next.fetch_add(1, std::memory_order_relaxed)) {
            values[static_cast<std::size_t>(i)] = 1;
            ++taken;
        }
#pragma omp critical
        by_critical += taken;
    }
#pragma omp parallel for num_threads(4) schedule(dynamic, 16) default(none) shared(by_atomic)
    for (long i = 0; i < n; ++i) {
#pragma omp atomic
        by_atomic += 1;
    }
#pragma omp parallel for num_threads(4) reduction(+ : by_reduction) default(none) shared(values)
    for (long i = 0; i < n; ++i) by_reduction += values[static_cast<std::size_t>(i)];
#pragma omp parallel num_threads(4) default(none) shared(values, by_next_region)
    {
#pragma omp single
        for (long value : values) by_next_region += value;
#pragma omp barrier
    }
    std::printf("%ld %ld %ld %ld\n", by_critical, by_atomic, by_reduction, by_next_region);
}
