// SPDX-License-Identifier: MIT
// How fast the cores can compute at all: fused multiply-adds that wait for nothing but their turn.
#pragma once

namespace cpu_peers {

/// Fused multiply-adds of one SIMD batch that a core issues per second of CPU time, with that many threads at it.
double fma_rate(int threads);
/// Lanes of that batch, the one that models are compiled for.
int fma_lanes();

}  // namespace cpu_peers
