// SPDX-License-Identifier: MIT
// The Keller-Miksis bubble as the peers integrate it.
#pragma once

#include <algorithm>
#include <cmath>

#include "../cash_karp.hpp"
#include "../sweep.hpp"

namespace cpu_peers::keller_miksis {

inline constexpr int n = 2, constants = 13;
inline constexpr double first_step = 1e-2;

/// The dimensionless radius y and its slope v over time tau in periods of the first forcing; C[12] is the phase of the
/// second forcing in half turns.
template <class T>
CPU_PEERS_INLINE void slopes(T tau, T y, T v, const T* C, T& dy, T& dv) {
    const T pi = T(3.14159265358979323846264338327950288L);
    const T first = T(2) * pi * tau, second = pi * (T(2) * C[11] * tau + C[12]);
    const T inverse = T(1) / y;
    const T numerator = (C[0] + C[1] * v) * std::pow(y, -C[10]) - C[2] * (T(1) + C[9] * v) - C[3] * inverse -
                        C[4] * v * inverse - (T(1.5) - T(0.5) * C[9] * v) * v * v -
                        (C[5] * std::sin(first) + C[6] * std::sin(second)) * (T(1) + C[9] * v) -
                        y * (C[7] * std::cos(first) + C[8] * std::cos(second));
    const T denominator = y - C[9] * y * v + C[4] * C[9];
    dy = v;
    dv = numerator / denominator;
}

outcome run_odeint(const sweep&);
outcome run_loop(const sweep&);
outcome run_reference(const sweep&);
__attribute__((weak)) outcome run_cvode(const sweep&);  // null if SUNDIALS was not found

}  // namespace cpu_peers::keller_miksis
