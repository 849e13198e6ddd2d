// SPDX-License-Identifier: MIT
// The pressure relief valve by CVODE with root finding; it restarts after every impact.
#include "../adams.hpp"
#include "../peer.hpp"
#include "equations.hpp"

namespace cpu_peers::relief_valve_case {
namespace {

struct watched_valve {
    double q = 0;
    int slopes(double, const double* y, double* dy) const {
        if (!(y[2] >= 0)) return 1;
        relief_valve_case::slopes(y, q, dy);
        return 0;
    }
    void values(const double* y, double* g) const {
        for (int e = 0; e < events; ++e) g[e] = value(e, y);
    }
};

struct thread {
    adams<n, watched_valve, events> solver;

    template <class ParameterOf>
    ending operator()(double (&y)[n], ParameterOf&& parameter_of, std::int64_t& accepted) {
        // After a restart, steps are tiny and so many that they would be taken for rest; flights last longer.
        constexpr double never = 1e6, starting = 0.02;
        double started = 0;
        solver.system.q = parameter_of(0);
        for (int c = 0; c < n; ++c) solver.y()[c] = y[c];
        solver.start(0);
        ending how = ending::completed;
        valve<double> memory;
        memory.begin(y, event_tolerance);
        for (int phase = 0; phase < phases && how == ending::completed; ++phase) {
            memory.begin_phase(solver.y());
            for (std::int64_t steps = 0;; ++steps) {
                if (steps == most_steps) return ending::failed;
                const double before[n] = {solver.y()[0], solver.y()[1], solver.y()[2]};
                bool fired[events] = {};
                if (solver.advance(never, CV_ONE_STEP) == CV_ROOT_RETURN) {
                    int which[events];
                    solver.found(which);
                    for (int e = 0; e < events; ++e) fired[e] = which[e] != 0;
                }
                if (solver.t() - started < starting) memory.steps_at_rest = 0;
                const bool over = memory.after_step(before, solver.y(), fired, how);
                if (fired[seat]) {
                    accepted += solver.steps();
                    started = solver.t();
                    solver.start(started);
                }
                if (over) break;
            }
        }
        for (int c = 0; c < n; ++c) y[c] = solver.y()[c];
        accepted += solver.steps();
        return how;
    }

    int phases;
    double event_tolerance;
};

}  // namespace

outcome run_cvode(const sweep& work) {
    return run_by_threads<n>(work, [&] {
        return thread{adams<n, watched_valve, events>(work.tolerance), work.phases, work.event_tolerance};
    });
}

}  // namespace cpu_peers::relief_valve_case
