// SPDX-License-Identifier: MIT
// Measures the rate of fused multiply-adds with the models' flags and batches.
#include "fma_rate.hpp"

#include <cstdint>

#include <myriad/kernel/scalar/pack.hpp>

#include "sweep.hpp"

namespace cpu_peers {
namespace {

using batch = myriad::pack<double, 1>;

// Eight chains fill two pipes of latency four; three times four fit sixteen registers with the factors.
constexpr int chains = 12;
constexpr std::int64_t rounds = 2'000'000;

/// `rounds` fused multiply-adds in each chain; returns a value that depends on all of them.
double issue(double start) {
    batch sum[chains];
    const batch factor(0.5), term(1.0);
    for (int i = 0; i < chains; ++i) sum[i] = batch(start + i);
    for (std::int64_t k = 0; k < rounds; ++k) {
        MYRIAD_UNROLL
        for (int i = 0; i < chains; ++i) sum[i] = myriad::fma(sum[i], factor, term);
    }
    batch total = sum[0];
    for (int i = 1; i < chains; ++i) total = total + sum[i];
    return myriad::detail::get_lane(total, 0);
}

}  // namespace

double fma_rate(int threads) {
    double all = 0;
    const outcome o = timed([&] {
#pragma omp parallel num_threads(threads) reduction(+ : all)
        all += issue(threads);
    });
    asm volatile("" : : "x"(all));  // makes the result count as used
    return static_cast<double>(rounds) * chains * threads / o.cpu_seconds;
}

int fma_lanes() { return batch::lanes; }

}  // namespace cpu_peers
