// SPDX-License-Identifier: MIT
// The case relief_valve: events, impacts and rest.
#include "cases.hpp"
#include "reference.hpp"
#include "sweeps.hpp"

namespace gpu_ensembles {
namespace {

problem<relief_valve> sixty_four_phases() { return {valve_options(64, 1e-10, 1e-6), &fill_valves, &start_valves}; }

std::vector<measurement> measure(std::int64_t size, const measure_options& how) {
    const auto what = sixty_four_phases();
    return {measure_myriad<myriad::cash_karp>(what, size, how, [&](const auto&, measurement& m) {
        set_errors(m, differences_from_cpu<myriad::cash_karp>(what, size, how.device));
    })};
}

}  // namespace

benchmark_case relief_valve_case() {
    return {.name = "relief_valve",
            .work =
                "64 phases from one fall of the velocity through zero to the next, from (0.2, 0, 0), step restarted in "
                "each, Cash-Karp, tolerances 1e-10, of events 1e-6, impacts with restitution 0.8, q = linspace(0.2, "
                "10, N); instances whose impacts accumulate end early, as failed",
            .error = "difference of 64 instances from the CPU backend after 1 phase, over max(1, |value|)",
            .allowed_error = 1e-4,
            .sizes = {8192, 30720, 768'000},
            .measure = &measure};
}

std::vector<check_value> check_relief_valve(const myriad::device& device) {
    using model = relief_valve;
    const auto what = sixty_four_phases();
    myriad::ensemble<model> instances(1);
    what.fill(instances);
    instances.parameter(model::q) = 10;
    what.start(instances);
    myriad::solve<myriad::cash_karp>(device, instances, what.options);
    return {{"relief valve at q = 10, y", instances.state(model::y)[0], 2.795573212718, 1e-6},
            {"relief valve at q = 10, v", instances.state(model::v)[0], 0, 1e-6},
            {"relief valve at q = 10, u", instances.state(model::u)[0], 12.79553458079, 1e-5}};
}

}  // namespace gpu_ensembles
