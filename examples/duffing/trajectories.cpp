// SPDX-License-Identifier: MIT
// Trajectories of selected instances of the Duffing sweep, by dense output.
#include <array>
#include <cstdint>
#include <stdexcept>

#include "../common/csv_file.hpp"
#include "../common/integrate.hpp"
#include "sweep.hpp"

namespace {

constexpr std::int64_t grid = 46080;                       // instances of the full sweep
constexpr std::array chosen_instances = {0, 4789, 15479};  // of that grid
constexpr std::int64_t samples_per_phase = 200;

int run(const examples::sweep_options& chosen, const myriad::device& device) {
    using namespace duffing_sweep;
    if (chosen.instances > static_cast<std::int64_t>(chosen_instances.size()))
        throw std::runtime_error(myriad::message("--instances is ", chosen.instances,
                                                 ", but trajectories are known of ", chosen_instances.size(),
                                                 " instances: give so many or fewer"));
    examples::csv_file file(chosen.output);
    // snippet: trajectories
    const Eigen::ArrayXd all = k_grid(grid);
    Eigen::ArrayXd k(chosen.instances);
    for (Eigen::Index i = 0; i < k.size(); ++i) k[i] = all[chosen_instances[static_cast<std::size_t>(i)]];
    auto sweep = prepare(k);
    const myriad::options options = {.phases = chosen.transient + chosen.phases,
                                     .relative_tolerance = tolerance,
                                     .absolute_tolerance = tolerance,
                                     .samples = {.states = {duffing::x, duffing::v},
                                                 .capacity = samples_per_phase * chosen.phases,
                                                 .evenly = samples_per_phase,
                                                 .from_phase = chosen.transient}};
    const auto report = examples::integrate<myriad::dense<myriad::tsitouras_5>>(chosen, device, sweep, options);
    const auto t = sweep.samples().time(), x = sweep.samples().state(duffing::x), v = sweep.samples().state(duffing::v);
    // end of snippet

    using myriad::message;
    file.comment("Duffing oscillator x'' + k x' - x + x^3 = B cos t, v = x'; all quantities are dimensionless");
    file.comment(message("instances of k = linspace(", k_first, ", ", k_last, ", ", grid, "), B = ", forcing,
                         ", x(0) = ", x_start, ", v(0) = ", v_start));
    file.comment(message("phases of length 2 pi: ", chosen.transient, " transient, ", chosen.phases, " sampled, ",
                         samples_per_phase, " samples each; t within the phase, which is counted from 0"));
    file.comment(
        message("Myriad " MYRIAD_VERSION ", method dense<tsitouras_5>, relative and absolute tolerance ", tolerance));
    file.row("instance", "phase", "k", "t", "x", "v", "status");
    for (std::int64_t i = 0; i < sweep.size(); ++i)
        for (std::int64_t s = 0; s < sweep.samples().stored()[i]; ++s)
            file.row(chosen_instances[static_cast<std::size_t>(i)], chosen.transient + s / samples_per_phase, k[i],
                     t(i, s), x(i, s), v(i, s), myriad::name_of(sweep.status(i)));
    file.commit();
    return examples::conclude(chosen, report);
}

}  // namespace

int main(int argc, char** argv) {
    return examples::run_sweep(argc, argv,
                               {.description = "Trajectories of instances 0, 4789 and 15479 of the Duffing sweep",
                                .full = {.instances = 3, .transient = 1024, .phases = 32},
                                .small = {.instances = 3, .transient = 1024, .phases = 8},
                                .output = "results/duffing_trajectories.csv",
                                .instances_help = "How many of the three",
                                .phases_help = "Phases to sample after the transient ones"},
                               run);
}
