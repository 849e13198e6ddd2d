// SPDX-License-Identifier: MIT
// The Keller-Miksis bubble by CVODE, which passes the ends of the first forcing's periods without a restart: the second
// forcing, whose phase would jump there, has no amplitude.
#include "../adams.hpp"
#include "../peer.hpp"
#include "equations.hpp"

namespace cpu_peers::keller_miksis {
namespace {

struct bubble {
    double C[constants] = {};
    int slopes(double tau, const double* y, double* dy) const {
        if (!(y[0] > 0)) return 1;
        keller_miksis::slopes(tau, y[0], y[1], C, dy[0], dy[1]);
        return 0;
    }
};

struct thread {
    adams<n, bubble> solver;

    template <class ParameterOf>
    ending operator()(double (&y)[n], ParameterOf&& parameter_of, std::int64_t& accepted) {
        for (int c = 0; c < constants; ++c) solver.system.C[c] = parameter_of(c);
        for (int c = 0; c < n; ++c) solver.y()[c] = y[c];
        solver.start(0);
        double y_max = y[0];
        while (solver.advance(phases, CV_ONE_STEP) != CV_TSTOP_RETURN) y_max = std::max(y_max, solver.y()[0]);
        asm volatile("" : : "x"(y_max));  // makes the result count as used
        for (int c = 0; c < n; ++c) y[c] = solver.y()[c];
        accepted = solver.steps();
        return ending::completed;
    }

    int phases;
};

}  // namespace

outcome run_cvode(const sweep& work) {
    return run_by_threads<n>(work, [&] { return thread{adams<n, bubble>(work.tolerance), work.phases}; });
}

}  // namespace cpu_peers::keller_miksis
