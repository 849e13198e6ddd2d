// SPDX-License-Identifier: MIT
// The peak rate of the cores: fused multiply-adds limited only by the pipes.
#pragma once

namespace cpu_peers {

/// Fused multiply-adds of one SIMD batch that a core issues per second of CPU time, with that many threads running.
double fma_rate(int threads);
/// Lanes of that batch, which is the one for which models are compiled.
int fma_lanes();

}  // namespace cpu_peers
