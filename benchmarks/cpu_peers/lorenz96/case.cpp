// SPDX-License-Identifier: MIT
// The cases lorenz96_32 and lorenz96_128: states that do not fit the registers, and at 128 not the first cache.
#include <string>

#include "../cases.hpp"
#include "../myriad_run.hpp"
#include "benchmarks/gpu_ensembles/lorenz96.hpp"
#include "equations.hpp"

namespace cpu_peers {
namespace {

template <int n>
outcome run(const sweep& work) {
    return run_myriad<myriad::dormand_prince_5, gpu_ensembles::lorenz96<n>>(
        work, {.relative_tolerance = work.tolerance, .absolute_tolerance = work.tolerance, .step = 1e-3},
        [&](auto& instances) { instances.time_domain(0, work.phases); });
}

template <int n>
void fill(std::int64_t instances, double* parameters, double* states) {
    using column = Eigen::Map<Eigen::ArrayXd>;
    column(parameters, instances) = Eigen::ArrayXd::LinSpaced(instances, 0, 16);
    for (int c = 0; c < n; ++c) column(states + c * instances, instances) = c == 0 ? 9 : 8;
}

}  // namespace

template <int n>
benchmark_case lorenz96_case() {
    return {.name = "lorenz96_" + std::to_string(n),
            .work = "Lorenz 96 with " + std::to_string(n) +
                    " states to t = 4, Dormand and Prince's method of order 5, tolerances 1e-6, F = linspace(0, 16, N)",
            .difference = "state at t = 1 (many instances are chaotic), against order 8 in long double at 1e-14",
            .allowed_difference = 0.05,
            .tolerance = 1e-6,
            .event_tolerance = 0,
            .components = n,
            .parameters = 1,
            .instances = 1024,
            .phases = 4,
            .compared_phases = 1,
            .fill = fill<n>,
            .reference = lorenz96::run_reference<n>,
            .implementations = {{"odeint", "odeint", lorenz96::run_odeint<n>}, {"myriad", "myriad", run<n>}}};
}
template benchmark_case lorenz96_case<32>();
template benchmark_case lorenz96_case<128>();

}  // namespace cpu_peers
