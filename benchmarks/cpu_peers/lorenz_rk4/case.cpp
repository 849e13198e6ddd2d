// SPDX-License-Identifier: MIT
// The case lorenz_rk4: its sweep, and Myriad's call.
#include "../cases.hpp"
#include "../myriad_run.hpp"
#include "equations.hpp"
#include "problems/lorenz.hpp"

namespace cpu_peers {
namespace {

outcome run(const sweep& work) {
    return run_myriad<myriad::runge_kutta_4, problems::fused_lorenz>(
        work, {.step = lorenz::h}, [](auto& instances) { instances.time_domain(0, lorenz::h * lorenz::steps); });
}

void fill(std::int64_t instances, double* parameters, double* states) {
    Eigen::Map<Eigen::ArrayXd>(parameters, instances) = Eigen::ArrayXd::LinSpaced(instances, 0, 21);
    Eigen::Map<Eigen::ArrayXd>(states, 3 * instances) = 10.0;
}

}  // namespace

benchmark_case lorenz_rk4() {
    return {
        .name = "lorenz_rk4",
        .work = "1000 steps of 1e-3, p = linspace(0, 21, N), start (10, 10, 10)",
        .difference = "end state, against the same steps in long double: rounding alone",
        .allowed_difference = 1e-12,
        .tolerance = 0,
        .event_tolerance = 0,
        .components = 3,
        .parameters = 1,
        .instances = 16384,
        .phases = 1,
        .compared_phases = 1,
        .fill = fill,
        .reference = lorenz::run_reference,
        .implementations = {{"odeint", "odeint", lorenz::run_odeint},
                            {"loop", "loop", lorenz::run_loop},
                            {"packs_1", "packs", lorenz::run_packs_1, lorenz::instructions_per_step},
                            {"packs_2", "packs", lorenz::run_packs_2, lorenz::instructions_per_step},
                            {"packs_3", "packs", lorenz::run_packs_3, lorenz::instructions_per_step},
                            {"packs_4", "packs", lorenz::run_packs_4, lorenz::instructions_per_step},
                            {"packs_as_models", "packs", lorenz::run_packs_as_models, lorenz::instructions_per_step},
                            {"myriad", "myriad", run, lorenz::instructions_per_step}}};
}

}  // namespace cpu_peers
