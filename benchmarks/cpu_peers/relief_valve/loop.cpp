// SPDX-License-Identifier: MIT
// The pressure relief valve by a hand-written scalar loop: Myriad's step and controller, with events estimated on the
// cubic Hermite interpolant and confirmed by a repeated step.
#include "../peer.hpp"
#include "equations.hpp"

namespace cpu_peers::relief_valve_case {
namespace {

/// The root of the cubic Hermite polynomial through value and slope at both ends of a step, as a fraction of the step,
/// for g_start > 0 > g_end; 0, for no guess, if g_start is not positive.
double hermite_root(double g_start, double d_start, double g_end, double d_end, double h, double allowed) {
    if (!(g_start > 0)) return 0;
    double low = 0, high = 1, g_low = g_start, g_high = g_end, x = 0;
    int same_side = 0;
    for (int i = 0; i < 20; ++i) {
        x = high - g_high * (high - low) / (g_high - g_low);
        const double rest = 1 - x, difference = g_end - g_start;
        const double g =
            g_start + x * (difference - rest * (h * (x * d_end - rest * d_start) + (1 - 2 * x) * difference));
        if (std::fabs(g) <= 0.1 * allowed) break;
        if (g < 0) {
            if (same_side < 0) g_low *= 0.5;
            high = x;
            g_high = g;
            same_side = -1;
        } else {
            if (same_side > 0) g_high *= 0.5;
            low = x;
            g_low = g;
            same_side = 1;
        }
    }
    return x;
}

}  // namespace

outcome run_loop(const sweep& work) {
    return run_instances<n>(work, [&](double(&y)[n], auto&& parameter_of, std::int64_t& accepted) {
        const double q = parameter_of(0);
        const auto f = [q](double, const double(&u)[n], double(&du)[n]) __attribute__((always_inline)) {
            slopes(u, q, du);
        };
        ending how = ending::completed;
        valve<double> memory;
        memory.begin(y, work.event_tolerance);
        trial<n> step;
        for (int phase = 0; phase < work.phases && how == ending::completed; ++phase) {
            memory.begin_phase(y);
            double h = first_step;
            f(0, y, step.k[0]);
            for (std::int64_t trials = 0;; ++trials) {
                if (trials == most_steps) return ending::failed;
                const double worst = cash_karp_step(f, 0, h, y, work.tolerance, step), tried = h;
                h = next_step(tried, worst, worst <= 1);
                if (!(worst <= 1)) {
                    if (tried <= 1e-12) return ending::failed;
                    continue;
                }
                bool fired[events] = {};
                const bool crossed[events] = {memory.crosses(section, step.y), memory.crosses(seat, step.y)};
                if (crossed[section] || crossed[seat]) {
                    double length = tried, end[n], first[n] = {};
                    for (int e = 0; e < events; ++e) {
                        if (!crossed[e]) continue;
                        const double guess = tried * hermite_root(value(e, y), slope(e, y), value(e, step.y),
                                                                  slope(e, step.y), tried, work.event_tolerance);
                        trial<n> again;
                        for (int c = 0; c < n; ++c) again.k[0][c] = step.k[0][c];
                        const double found = locate(e, y, tried, value(e, step.y), work.event_tolerance, guess, end,
                                                    [&](double l, double* to) {
                                                        cash_karp_step(f, 0, l, y, work.tolerance, again);
                                                        for (int c = 0; c < n; ++c) to[c] = again.y[c];
                                                    });
                        if (found >= length) continue;
                        length = found;
                        for (int c = 0; c < n; ++c) first[c] = end[c];
                        fired[section] = e == section;
                        fired[seat] = e == seat;
                    }
                    for (int c = 0; c < n; ++c) step.y[c] = first[c];
                }
                double before[n];
                for (int c = 0; c < n; ++c) before[c] = y[c];
                for (int c = 0; c < n; ++c) y[c] = step.y[c];
                ++accepted;
                if (memory.after_step(before, y, fired, how)) break;
                f(0, y, step.k[0]);
            }
        }
        return how;
    });
}

}  // namespace cpu_peers::relief_valve_case
