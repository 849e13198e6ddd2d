// SPDX-License-Identifier: MIT
// Lorenz' equations of 1996 as the peers integrate them.
#pragma once

#include <array>
#include <cstddef>

#include "../sweep.hpp"

namespace cpu_peers::lorenz96 {

/// x_i' = (x_(i+1) - x_(i-2)) x_(i-1) - x_i + F in a ring of n. Without tests for the ends of the ring in the loop, g++
/// vectorises it.
template <class T, std::size_t n>
void slopes(T F, const std::array<T, n>& x, std::array<T, n>& dx) {
    dx[0] = (x[1] - x[n - 2]) * x[n - 1] - x[0] + F;
    dx[1] = (x[2] - x[n - 1]) * x[0] - x[1] + F;
    for (std::size_t i = 2; i < n - 1; ++i) dx[i] = (x[i + 1] - x[i - 2]) * x[i - 1] - x[i] + F;
    dx[n - 1] = (x[0] - x[n - 3]) * x[n - 2] - x[n - 1] + F;
}

template <int n>
outcome run_odeint(const sweep&);
template <int n>
outcome run_reference(const sweep&);

}  // namespace cpu_peers::lorenz96
