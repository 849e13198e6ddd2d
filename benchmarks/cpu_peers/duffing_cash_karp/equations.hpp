// SPDX-License-Identifier: MIT
// The Duffing oscillator as the peers integrate it.
#pragma once

#include <cmath>

#include "../cash_karp.hpp"
#include "../sweep.hpp"

namespace cpu_peers::duffing {

inline constexpr int n = 2;
inline constexpr double B = 0.3, period = 6.283185307179586, first_step = 1e-2;

/// x' = v, v' = x - x^3 - k v + B cos t.
template <class T>
CPU_PEERS_INLINE void slopes(T t, T x, T v, T k, T& dx, T& dv) {
    dx = v;
    dv = x - x * x * x - k * v + T(B) * std::cos(t);
}

outcome run_odeint(const sweep&);
outcome run_loop(const sweep&);
outcome run_reference(const sweep&);
__attribute__((weak)) outcome run_cvode(const sweep&);  // null if SUNDIALS was not found

}  // namespace cpu_peers::duffing
