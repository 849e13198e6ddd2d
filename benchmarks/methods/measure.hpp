// SPDX-License-Identifier: MIT
// Measures methods on a study: work by counts, time, and error against the reference.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "benchmarks/cpu_peers/sweep.hpp"
#include "benchmarks/gpu_ensembles/measure.hpp"
#include "study.hpp"

namespace methods {

struct settings {
    myriad::device device = myriad::device::cpu(1);
    std::int64_t instances = 0;  ///< 0: the study's
    int repetitions = 3;
    std::vector<double> tolerances = {};  ///< empty: the study's
};

struct row {
    std::string study, method;
    std::int64_t instances;
    double tolerance;
    double milliseconds;  ///< shortest run: kernel time on a GPU, processor time on the CPU
    std::int64_t accepted, rejected, evaluations, failed;
    errors error;
};

/// Receives comments for readers, and rows.
struct output {
    std::function<void(const std::string&)> comment;
    std::function<void(const row&)> result;
};

/// A method, its name, and the finest tolerance at which it is worth measuring.
template <class Method>
struct named {
    const char* name;
    double finest = 0;
};

inline constexpr std::int64_t compared = 256;  // instances compared with the reference, spread evenly over the ensemble

/// One method at one tolerance. The first run warms up and gives counts, errors and the complaint.
template <class Method, class Model>
row measure(const study<Model>& of, const named<Method>& method, double tolerance, std::int64_t size,
            const settings& chosen, const myriad::ensemble<Model>& reference, std::string& complaint) {
    const auto what = of.at(tolerance);
    myriad::solver<Model, Method> solver(chosen.device, size, what.options);
    what.fill(solver.instances());
    gpu_ensembles::run_once(solver, what);
    const auto& report = solver.report();
    row r{.study = of.name,
          .method = method.name,
          .instances = size,
          .tolerance = tolerance,
          .milliseconds = 0,
          .accepted = report.accepted_steps,
          .rejected = report.rejected_steps,
          .evaluations = report.rhs_evaluations,
          .failed = report.failed(),
          .error = compare(of, solver.results(), reference, tolerance)};
    complaint = of.complaint(solver.results(), tolerance);
    std::vector<double> times;
    for (int i = 0; i < chosen.repetitions; ++i) {
        const double begin = cpu_peers::cpu_clock();
        const double kernel_ms = gpu_ensembles::run_once(solver, what).first;
        const bool on_gpu = chosen.device.which() == myriad::device::kind::cuda;
        times.push_back(on_gpu ? kernel_ms : 1e3 * (cpu_peers::cpu_clock() - begin));
    }
    r.milliseconds = *std::min_element(times.begin(), times.end());  // other processes can only increase it
    return r;
}

/// All methods at all tolerances. Returns whether there were no complaints.
template <class Reference, class Model, class... Methods>
bool run(const study<Model>& of, const settings& chosen, const output& out, const named<Methods>&... methods) {
    const bool on_gpu = chosen.device.which() == myriad::device::kind::cuda;
    const std::int64_t size = chosen.instances > 0 ? chosen.instances : on_gpu ? of.on_gpu : of.on_cpu;
    const std::int64_t count = std::min(compared, size);
    const auto reference = integrated<Reference>(of, size, count, of.reference_tolerance);
    // Errors below this tell nothing.
    const double coarser = 10 * of.reference_tolerance;
    const errors doubt = compare(of, integrated<Reference>(of, size, count, coarser), reference, coarser);
    std::ostringstream about;
    about << of.name << ": " << of.work << "; reference for " << count << " instances: " << of.reference << " at "
          << of.reference_tolerance << ", which differs from itself at ten times that by " << doubt.median
          << " (median) and " << doubt.largest << " (largest)";
    out.comment(about.str());
    bool right = true;
    for (const double tolerance : chosen.tolerances.empty() ? of.tolerances : chosen.tolerances) {
        const auto one = [&](const auto& method) {
            if (tolerance < 0.99 * method.finest) return;
            std::string complaint;
            out.result(measure(of, method, tolerance, size, chosen, reference, complaint));
            if (complaint.empty()) return;
            right = false;
            std::ostringstream wrong;
            wrong << "WRONG: " << of.name << ", " << method.name << " at " << tolerance << ": " << complaint;
            out.comment(wrong.str());
        };
        (one(methods), ...);
    }
    return right;
}

}  // namespace methods
