// SPDX-License-Identifier: MIT
// Times Myriad's solver object on one problem.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <myriad/myriad.hpp>

namespace gpu_ensembles {

struct measure_options {
    myriad::device device = myriad::device::cpu();
    double instances_scale = 1;
    int repetitions = 5;
};

/// One row of the output.
struct measurement {
    std::string implementation;
    std::int64_t instances = 0;
    double kernel_ms = 0, end_to_end_ms = 0;  ///< medians, without counting work
    double counting_kernel_ms = 0;            ///< of the run that counted the work
    std::int64_t accepted_steps = 0, located_steps = 0, rhs_evaluations = 0, failed = 0;
    double max_error = 0, median_error = 0;
    int registers = 0, block_size = 0;
    std::int64_t local_bytes = 0;
};

inline double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

/// A problem: `fill` sets the values that kernels do not write, `start` those that they do.
template <class Model, class R = double>
struct problem {
    myriad::options options;
    void (*fill)(myriad::ensemble<Model, R>&);
    void (*start)(myriad::ensemble<Model, R>&);
};

/// Milliseconds of the kernel alone, and of upload, kernel and download together, for one run from the start.
template <class Model, class Method, class R>
std::pair<double, double> run_once(myriad::solver<Model, Method, R>& solver, const problem<Model, R>& what) {
    auto& instances = solver.instances();
    what.start(instances);
    instances.restart();
    const auto begin = std::chrono::steady_clock::now();
    solver.upload();
    solver.integrate();
    solver.download();
    solver.wait();
    const std::chrono::duration<double, std::milli> all = std::chrono::steady_clock::now() - begin;
    return {1e3 * solver.report().seconds, all.count()};
}

/// Runs until a GPU that was idle is back at its clock rate.
template <class Once>
void warm_up(Once&& once) {
    const auto begin = std::chrono::steady_clock::now();
    do once();
    while (std::chrono::steady_clock::now() - begin < std::chrono::milliseconds(200));
}

/// Times the problem, then counts its work in a separate run. `inspect(instances)` sees the results of the timed runs.
template <class Method, class Model, class R, class Inspect>
measurement measure_myriad(const problem<Model, R>& what, std::int64_t size, const measure_options& how,
                           Inspect&& inspect) {
    measurement m{.implementation = "myriad", .instances = size};
    myriad::options options = what.options;
    {
        options.counting = myriad::counting::off;
        myriad::solver<Model, Method, R> solver(how.device, size, options);
        what.fill(solver.instances());
        warm_up([&] { run_once(solver, what); });
        std::vector<double> kernel, end_to_end;
        for (int i = 0; i < how.repetitions; ++i) {
            const auto [alone, all] = run_once(solver, what);
            kernel.push_back(alone);
            end_to_end.push_back(all);
        }
        m.kernel_ms = median(kernel);
        m.end_to_end_ms = median(end_to_end);
        const auto& report = solver.report();
        m.failed = report.failed();
        m.registers = report.kernel.registers;
        m.block_size = report.kernel.block_size;
        m.local_bytes = report.kernel.local_bytes;
        inspect(std::as_const(solver.instances()), m);
    }
    options.counting = myriad::counting::on;
    myriad::solver<Model, Method, R> solver(how.device, size, options);
    what.fill(solver.instances());
    m.counting_kernel_ms = run_once(solver, what).first;
    m.accepted_steps = solver.report().accepted_steps;
    m.located_steps = solver.report().located_steps;
    m.rhs_evaluations = solver.report().rhs_evaluations;
    return m;
}

}  // namespace gpu_ensembles
