// SPDX-License-Identifier: MIT
// Lorenz' equations of 1996 as the peers integrate them.
#pragma once

#include "../sweep.hpp"

namespace cpu_peers::lorenz96 {

/// x_i' = (x_(i+1) - x_(i-2)) x_(i-1) - x_i + F in a ring of n.
template <class T, class State>
void slopes(int n, T F, const State& x, State& dx) {
    for (int i = 0; i < n; ++i) {
        const int next = i + 1 == n ? 0 : i + 1, before = i == 0 ? n - 1 : i - 1, second = i < 2 ? i + n - 2 : i - 2;
        const auto at = [&](int c) { return x[static_cast<std::size_t>(c)]; };
        dx[static_cast<std::size_t>(i)] = (at(next) - at(second)) * at(before) - at(i) + F;
    }
}

template <int n>
outcome run_odeint(const sweep&);
template <int n>
outcome run_reference(const sweep&);

}  // namespace cpu_peers::lorenz96
