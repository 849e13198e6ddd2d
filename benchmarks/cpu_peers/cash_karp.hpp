// SPDX-License-Identifier: MIT
// The Cash-Karp step and the controller of the MPGOS package as a careful programmer writes them for one instance: the
// part of the implementation `loop` that the cases share. The algorithm is Myriad's; its kernel body is not used.
#pragma once

#include <cmath>
#include <cstdint>
#include <utility>

#if defined(__GNUC__)
#define CPU_PEERS_INLINE inline __attribute__((always_inline))
#else
#define CPU_PEERS_INLINE inline
#endif

namespace cpu_peers {

/// A trial step: slopes of the stages, the first given, and the new state.
template <int n>
struct trial {
    double k[6][n];
    double y[n];
};

// std::fmax is a call if NaN must be handled, which is not needed here.
CPU_PEERS_INLINE double larger(double a, double b) { return a > b ? a : b; }
CPU_PEERS_INLINE double smaller(double a, double b) { return a < b ? a : b; }

/// Calls `use(c)` for every component.
template <int n, class Use>
CPU_PEERS_INLINE void each(Use&& use) {
#pragma GCC unroll 8
    for (int c = 0; c < n; ++c) use(c);
}

/// Steps from (t, y) over h and returns the largest ratio of error to tolerance, max(tolerance, tolerance * |y|).
template <int n, class F>
CPU_PEERS_INLINE double cash_karp_step(F&& f, double t, double h, const double (&y)[n], double tolerance,
                                       trial<n>& step) {
    // h * weight is computed before the slopes are known, so that one operation separates a slope from the next
    // argument.
    auto& k = step.k;
    double z[n];
    each<n>([&](int c) { z[c] = y[c] + h * (1.0 / 5) * k[0][c]; });
    f(t + h * (1.0 / 5), z, k[1]);
    each<n>([&](int c) { z[c] = y[c] + h * (3.0 / 40) * k[0][c] + h * (9.0 / 40) * k[1][c]; });
    f(t + h * (3.0 / 10), z, k[2]);
    each<n>(
        [&](int c) { z[c] = y[c] + h * (3.0 / 10) * k[0][c] - h * (9.0 / 10) * k[1][c] + h * (6.0 / 5) * k[2][c]; });
    f(t + h * (3.0 / 5), z, k[3]);
    each<n>([&](int c) {
        z[c] = y[c] - h * (11.0 / 54) * k[0][c] + h * (5.0 / 2) * k[1][c] - h * (70.0 / 27) * k[2][c] +
               h * (35.0 / 27) * k[3][c];
    });
    f(t + h, z, k[4]);
    each<n>([&](int c) {
        z[c] = y[c] + h * (1631.0 / 55296) * k[0][c] + h * (175.0 / 512) * k[1][c] + h * (575.0 / 13824) * k[2][c] +
               h * (44275.0 / 110592) * k[3][c] + h * (253.0 / 4096) * k[4][c];
    });
    f(t + h * (7.0 / 8), z, k[5]);
    double worst = 0;
    each<n>([&](int c) {
        step.y[c] = y[c] + h * (37.0 / 378) * k[0][c] + h * (250.0 / 621) * k[2][c] + h * (125.0 / 594) * k[3][c] +
                    h * (512.0 / 1771) * k[5][c];
        const double error = h * (-277.0 / 64512) * k[0][c] + h * (6925.0 / 370944) * k[2][c] -
                             h * (6925.0 / 202752) * k[3][c] - h * (277.0 / 14336) * k[4][c] +
                             h * (277.0 / 7084) * k[5][c];
        const double size = larger(std::fabs(y[c]), std::fabs(step.y[c]));
        const double ratio = std::fabs(error) / larger(tolerance, tolerance * size);
        worst = ratio <= worst ? worst : ratio;  // NaN enters, so that the step is not accepted
    });
    return worst;
}

/// The step size after a step of size h, in single precision, which suffices and is twice as fast.
CPU_PEERS_INLINE double next_step(double h, double worst, bool accepted) {
    const float power = std::exp2((accepted ? -0.2f : -0.25f) * std::log2(static_cast<float>(worst)));
    const double factor = worst < 1e30 ? smaller(larger(0.9 * static_cast<double>(power), 0.1), 5.0) : 0.1;
    return smaller(larger(h * factor, 1e-12), 1e6);
}

/// Integrates from t = 0 to t_end with the first step 1e-2; calls `after_step(y)` for every accepted state. Returns
/// false if the step became too small.
template <int n, class F, class AfterStep>
CPU_PEERS_INLINE bool integrate_phase(F&& f, double (&y)[n], double t_end, double tolerance, std::int64_t& accepted,
                                      AfterStep&& after_step) {
    double t = 0, h = 1e-2;
    trial<n> step;
    f(t, y, step.k[0]);
    for (;;) {
        const double remaining = t_end - t;
        const bool last = remaining <= 1.001 * h;
        const double tried = last ? remaining : h;
        const double worst = cash_karp_step(f, t, tried, y, tolerance, step);
        const bool good = worst <= 1;
        h = next_step(tried, worst, good);
        if (!good) {
            if (tried <= 1e-12) return false;
            continue;
        }
        each<n>([&](int c) { y[c] = step.y[c]; });
        ++accepted;
        after_step(y);
        if (last) return true;
        t += tried;
        f(t, y, step.k[0]);
    }
}

}  // namespace cpu_peers
