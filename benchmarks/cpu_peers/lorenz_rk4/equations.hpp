// SPDX-License-Identifier: MIT
// The Lorenz system as the peers integrate it, for any kind of number.
#pragma once

#include "../cash_karp.hpp"
#include "../sweep.hpp"

namespace cpu_peers::lorenz {

inline constexpr int n = 3, steps = 1000;
inline constexpr double h = 1e-3;

/// A step's instructions with packs: four evaluations of six, nine for the stages' arguments, twelve for their sum.
inline constexpr double instructions_per_step = 4 * 6 + 9 + 12;

/// x' = 10 (y - x), y' = p x - y - x z, z' = x y - 8/3 z.
template <class T>
CPU_PEERS_INLINE void slopes(const T& x, const T& y, const T& z, const T& p, T& dx, T& dy, T& dz) {
    dx = T(10) * (y - x);
    dy = p * x - y - x * z;
    dz = x * y - T(8) / T(3) * z;
}

outcome run_odeint(const sweep&);
outcome run_loop(const sweep&);
outcome run_reference(const sweep&);
outcome run_packs_1(const sweep&);
outcome run_packs_2(const sweep&);
outcome run_packs_3(const sweep&);
outcome run_packs_4(const sweep&);
/// With the flags of models, and as many batches as Myriad uses.
outcome run_packs_as_models(const sweep&);
/// The instruction set for which models are compiled.
const char* instruction_set();

}  // namespace cpu_peers::lorenz
