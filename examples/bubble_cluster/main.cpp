// SPDX-License-Identifier: MIT
// A cluster of 128 bubbles under sound of growing pressure: the radius of each at the ends of periods.
#include <cstdint>

#include "../common/csv_file.hpp"
#include "../common/grid.hpp"
#include "../common/integrate.hpp"
#include "sweep.hpp"

namespace {

using namespace cluster_sweep;

int run(const examples::sweep_options& chosen, const myriad::device& device) {
    constexpr int n = bubble_cluster::n_unit;
    examples::csv_file file(chosen.output, 50 * static_cast<std::uintmax_t>(chosen.instances * chosen.phases * n));
    const bubbles b = draw_bubbles();
    const Eigen::ArrayXd pressures = examples::linspace(pressure_first, pressure_last, chosen.instances);
    auto sweep = prepare(b, pressures);
    auto options = settings(chosen.transient + chosen.phases);
    options.record.from_phase = chosen.transient;
    for (int i = 0; i < n; ++i) options.record.states.push_back(bubble_cluster::state_of(i, cluster_bubble::y));
    const auto report = examples::integrate<myriad::cash_karp>(chosen, device, sweep, options);

    using myriad::message;
    file.comment(message("Cluster of ", n, " bubbles in water, radii at rest from 3 to 8 um, coordinates normal with ",
                         spread * 1e3, " mm, seed ", seed, "; sound of ", frequency / bubble::kHz, " kHz"));
    file.comment(
        message("phases of one period of the sound: ", chosen.transient, " transient, ", chosen.phases, " recorded"));
    file.comment(message("Myriad " MYRIAD_VERSION ", method cash_karp, relative and absolute tolerance ", tolerance));
    file.comment(
        "pressure: amplitude in bar; radius: at rest, in um; x, y, z: place in mm; y_end: radius at the end of "
        "the phase over that at rest; status: of the cluster");
    file.row("instance", "phase", "pressure", "bubble", "radius", "x", "y", "z", "y_end", "status");
    for (std::int64_t i = 0; i < sweep.size(); ++i)
        for (std::int64_t r = 0; r < chosen.phases; ++r)
            for (int k = 0; k < n; ++k)
                file.row(i, chosen.transient + r, pressures[i] / bubble::bar, k, b.radius[k] * 1e6,
                         b.position(k, 0) * 1e3, b.position(k, 1) * 1e3, b.position(k, 2) * 1e3,
                         report.records.state(bubble_cluster::state_of(k, cluster_bubble::y))(i, r),
                         myriad::name_of(sweep.status(i)));
    file.commit();
    return examples::conclude(chosen, report);
}

}  // namespace

int main(int argc, char** argv) {
    return examples::run_sweep(
        argc, argv,
        {.description = "A cluster of 128 bubbles that feel each other, under sound of growing pressure",
         .full = {.instances = 600, .transient = 512, .phases = 32},
         .small = {.instances = 8, .transient = 0, .phases = 2},
         .output = "results/bubble_cluster.csv"},
        run);
}
