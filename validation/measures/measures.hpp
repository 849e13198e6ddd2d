// SPDX-License-Identifier: MIT
// The measures: each compares runs of a problem with its references and adds rows to the report.
#pragma once

#include <algorithm>
#include <cmath>
#include <exception>
#include <string>
#include <vector>

#include "../problem.hpp"
#include "../report.hpp"
#include "arithmetic.hpp"
#include "recorded.hpp"

namespace validation {

enum class extent { whole, quick };

/// The data common to all measures.
struct session {
    myriad::device device;
    extent how_much;
    report& rows;
    recorder* record = nullptr;         // results to store
    const recorded* compare = nullptr;  // results of another backend to compare with

    bool quick() const { return how_much == extent::quick; }
    std::string device_name() const { return device.which() == myriad::device::kind::cpu ? "cpu" : "cuda"; }
    subject about(const problem& p, const method_entry& m, double setting) const {
        return {p.name, m.name, m.precision, device_name(), setting};
    }
};

/// The best known solution of every instance, its error and its conditioning.
struct references {
    std::vector<solution> known;
    std::vector<double> error;  // of the end state: the difference of two CVODE runs, or 0 for closed forms
    std::vector<conditioning> conditions;
};

/// CVODE at two tolerances, and closed forms, compared with each other.
references measure_references(session&, const problem&);
/// Work, and errors of end states, events, samples, accessories and invariants, over a range of tolerances.
void measure_tolerances(session&, const problem&, const method_entry&, const references&);
/// One step against the same step computed from published coefficients.
void measure_step(session&, const problem&, const method_entry&);
/// Order and error constant with fixed steps.
void measure_order(session&, const problem&, const method_entry&, const references&);
/// Order of the error estimate.
void measure_estimate(session&, const problem&, const method_entry&);
/// Error against evaluations and time, beside CVODE and Boost.odeint.
void measure_work(session&, const problem&, const references&);
/// Lyapunov exponents and statistics of chaotic solutions.
void measure_chaos(session&);
/// Accumulated rounding errors: over long times, far from t = 0, and in single precision.
void measure_rounding(session&);

// What several measures use ------------------------------------------------------------------------------------------

/// Calls f(i) for every i below count, on all cores; rethrows exceptions of f.
template <class F>
void for_each_in_parallel(std::size_t count, F&& f) {
    std::exception_ptr failure;
#pragma omp parallel for schedule(dynamic)
    for (std::size_t i = 0; i < count; ++i) {
        try {
            f(i);
        } catch (...) {
#pragma omp critical
            failure = std::current_exception();
        }
    }
    if (failure) std::rethrow_exception(failure);
}

/// The problem with its events switched off, so that no step is shortened.
inline problem without_events(problem p) {
    for (auto& e : p.events) e.direction = myriad::direction::none;
    return p;
}

/// Steps of length h only, for every method: tolerances that no error exceeds.
inline myriad::options fixed_steps(const problem& p, double h) {
    myriad::options o;
    o.step = o.minimum_step = o.maximum_step = h;
    o.relative_tolerance = 0;
    o.absolute_tolerance = 1e30;
    o.events = p.events;
    return o;
}

}  // namespace validation
