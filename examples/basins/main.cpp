// SPDX-License-Identifier: MIT
// Basins of attraction of the magnetic pendulum: over which of three magnets does it come to rest? The model's
// `after_step` ends an instance as soon as its energy is below the barrier between the wells.
#include <algorithm>
#include <cstdint>
#include <iostream>

#include <myriad/myriad.hpp>

#include "../common/csv_file.hpp"
#include "../common/integrate.hpp"
#include "sweep.hpp"

namespace {

using namespace basins;

// snippet: magnet
/// The magnet of an instance, or 0 if at the end of its time it still had the energy to leave.
int magnet(const myriad::ensemble<pendulum>& sweep, std::int64_t i) {
    if (sweep.status(i) != myriad::status::stopped_by_user) return 0;
    return nearest_magnet(sweep.state(pendulum::x)[i], sweep.state(pendulum::y)[i]);
}
// end of snippet

// Nothing here depends on the time, machine or number of threads: equal results give equal files.
void write(examples::csv_file& file, const examples::sweep_options& chosen, const myriad::ensemble<pendulum>& sweep) {
    using myriad::message;
    file.comment(
        "Magnetic pendulum, released at rest at (x, y): x'' = -omega^2 x - damping x' + sum of (x_i - x) / D_i^3");
    file.comment(message("omega = ", omega, ", damping = ", damping, ", height = ", height,
                         "; lengths in sides of the triangle of magnets, time such that their strength is one"));
    file.comment(message("barrier between the wells: ", barrier(), "; duration at most: ", chosen.phases,
                         " natural periods of ", natural_period));
    file.comment(
        message("Myriad " MYRIAD_VERSION ", method dormand_prince_8, relative and absolute tolerance ", tolerance));
    file.comment(
        "magnet: 1 at (0.577, 0), 2 at (-0.289, 0.5), 3 at (-0.289, -0.5), 0 none; t: when the energy fell below "
        "the barrier");
    file.row("x", "y", "magnet", "t");
    const Eigen::ArrayXd axis = places(chosen.instances);
    const auto t = sweep.t();
    for (std::int64_t i = 0; i < sweep.size(); ++i)
        file.row(axis[i % axis.size()], axis[i / axis.size()], magnet(sweep, i), static_cast<float>(t[i]));
    file.commit();
}

/// Integrates all instances once more, to the end. Returns 1 if a captured one then ends over another magnet.
int compare(const examples::sweep_options& chosen, const myriad::device& device,
            const myriad::ensemble<pendulum>& stopped, std::int64_t steps) {
    auto sweep = grid(chosen.instances, never, static_cast<double>(chosen.phases) * natural_period);
    const auto report = examples::integrate<myriad::dormand_prince_8>(chosen, device, sweep, integration());
    const auto x = sweep.state(pendulum::x), y = sweep.state(pendulum::y);
    std::int64_t captured = 0, left = 0;
    for (std::int64_t i = 0; i < sweep.size(); ++i) {
        if (magnet(stopped, i) == 0) continue;
        ++captured;
        left += nearest_magnet(x[i], y[i]) != magnet(stopped, i);
    }
    const std::int64_t all = report.accepted_steps + report.rejected_steps;
    if (!chosen.quiet || left > 0)
        std::cout << "Steps: " << steps << " with the criterion, " << all << " without, "
                  << 100 * static_cast<double>(all - steps) / static_cast<double>(all) << " % saved\n"
                  << "Of " << captured << " captured instances " << left << " are over another magnet at the end\n";
    return left > 0 || report.failed() > 0 ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
    bool to_the_end = false;
    return examples::run_sweep(
        argc, argv,
        {.description = "Basins of attraction of the magnetic pendulum",
         .full = {.instances = 2048, .phases = 4},
         .small = {.instances = 160, .phases = 4},
         .output = "results/basins.csv",
         .instances_help = "Places in x, and as many in y: a grid of N x N instances",
         .phases_help = "Natural periods, 2 pi / omega, after which an instance ends at the latest",
         .has_transient = false,
         .options = {{"--to-the-end", &to_the_end, "Integrate all once more without the criterion, and compare"}}},
        [&](const examples::sweep_options& chosen, const myriad::device& device) {
            const auto side = static_cast<std::uintmax_t>(chosen.instances);
            examples::csv_file file(chosen.output, 20 * side * side);
            // snippet: solve
            auto sweep = grid(chosen.instances, barrier(), static_cast<double>(chosen.phases) * natural_period);
            const auto report = examples::integrate<myriad::dormand_prince_8>(chosen, device, sweep, integration());
            // end of snippet
            write(file, chosen, sweep);
            const int status = examples::conclude(chosen, report);
            if (!to_the_end) return status;
            return std::max(status, compare(chosen, device, sweep, report.accepted_steps + report.rejected_steps));
        });
}
