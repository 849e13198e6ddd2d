// SPDX-License-Identifier: MIT
// The Duffing oscillator by CVODE, which passes the ends of forcing periods without a restart.
#include "../adams.hpp"
#include "../peer.hpp"
#include "equations.hpp"

namespace cpu_peers::duffing {
namespace {

struct oscillator {
    double k = 0;
    int slopes(double t, const double* y, double* dy) const {
        duffing::slopes(t, y[0], y[1], k, dy[0], dy[1]);
        return 0;
    }
};

struct thread {
    adams<n, oscillator> solver;

    template <class ParameterOf>
    ending operator()(double (&y)[n], ParameterOf&& parameter_of, std::int64_t& accepted) {
        solver.system.k = parameter_of(0);
        for (int c = 0; c < n; ++c) solver.y()[c] = y[c];
        solver.start(0);
        solver.advance(phases * period, CV_NORMAL);
        for (int c = 0; c < n; ++c) y[c] = solver.y()[c];
        accepted = solver.steps();
        return ending::completed;
    }

    int phases;
};

}  // namespace

outcome run_cvode(const sweep& work) {
    return run_by_threads<n>(work, [&] { return thread{adams<n, oscillator>(work.tolerance), work.phases}; });
}

}  // namespace cpu_peers::duffing
