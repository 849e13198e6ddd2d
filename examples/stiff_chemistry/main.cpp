// SPDX-License-Identifier: MIT
// Where the Belousov-Zhabotinsky reaction oscillates, and with what period: the Oregonator over f and epsilon.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>

#include <myriad/myriad.hpp>

#include "../common/csv_file.hpp"
#include "../common/integrate.hpp"
#include "sweep.hpp"

namespace {

namespace plane = oregonator_sweep;
using myriad::message;

/// The fraction of iterations in which lanes would idle if groups of neighbours waited for their slowest member.
double idle_in_groups(const Eigen::ArrayXd& steps, Eigen::Index width) {
    double turns = 0;
    for (Eigen::Index first = 0; first < steps.size(); first += width) {
        const Eigen::Index size = std::min(width, steps.size() - first);
        turns += static_cast<double>(width) * steps.segment(first, size).maxCoeff();
    }
    return 1 - steps.sum() / turns;
}

Eigen::ArrayXd steps_of(const myriad::ensemble<oregonator>& sweep) {
    return (sweep.accepted_steps() + sweep.rejected_steps() + sweep.located_steps()).cast<double>();
}

void describe(const myriad::report<oregonator, double>& report, const Eigen::ArrayXd& steps) {
    std::cout << "trial steps per instance: " << steps.minCoeff() << " to " << steps.maxCoeff() << ", mean "
              << steps.mean() << '\n';
    for (const int width : {8, 32})
        std::cout << "idle lanes if " << width
                  << " neighbours waited for each other: " << 100 * idle_in_groups(steps, width) << " %\n";
    if (report.lane_turns > 0) std::cout << "idle lanes in this run: " << 100 * report.idle_share() << " %\n";
}

void write(examples::csv_file& file, const myriad::ensemble<oregonator>& sweep,
           const myriad::report<oregonator, double>& report, const examples::sweep_options& chosen) {
    file.comment(
        "Oregonator: epsilon x' = q y - x y + x (1 - x), epsilon' y' = f z - q y - x y, z' = x - z, all scaled");
    file.comment(message("q = ", plane::q, ", epsilon' = ", plane::ratio, " epsilon; started ", plane::perturbation,
                         " of z off its equilibrium"));
    file.comment(message("period, least and largest z of cycle ", chosen.transient + chosen.phases,
                         "; 0 where there was no maximum of z in a time of ", plane::longest_cycle));
    file.comment("growth, frequency: of small deviations from equilibrium, leading eigenvalue, per unit of time");
    file.comment(message("Myriad " MYRIAD_VERSION ", method rodas_5p, relative tolerance ", plane::tolerance,
                         ", absolute tolerance ", plane::absolute_tolerance));
    file.row("instance", "f", "epsilon", "period", "z_least", "z_largest", "growth", "frequency", "steps", "status");
    const Eigen::ArrayXd steps = steps_of(sweep);
    const Eigen::Index last = report.records.phases() - 1;
    for (std::int64_t i = 0; i < sweep.size(); ++i) {
        const double f = sweep.parameter(oregonator::f)[i], epsilon = sweep.parameter(oregonator::epsilon)[i];
        const bool turned = sweep.status(i) == myriad::status::stopped_by_event;
        const plane::growth at_rest = plane::growth_at(f, epsilon);
        file.row(i, f, epsilon, turned ? report.records.time()(i, last) : 0, sweep.accessory(oregonator::z_least)[i],
                 sweep.state(oregonator::z)[i], at_rest.rate, at_rest.frequency, steps[i],
                 myriad::name_of(sweep.status(i)));
    }
    file.commit();
}

}  // namespace

int main(int argc, char** argv) {
    const std::map<std::string, myriad::schedule> schedules{{"automatic", myriad::schedule::automatic},
                                                            {"in_order", myriad::schedule::in_order},
                                                            {"dynamic", myriad::schedule::dynamic},
                                                            {"by_cost", myriad::schedule::by_cost}};
    std::string schedule = "automatic";
    const auto run = [&](const examples::sweep_options& chosen, const myriad::device& device) {
        const auto side = static_cast<std::int64_t>(std::sqrt(static_cast<double>(chosen.instances)));
        examples::csv_file file(chosen.output, 80 * static_cast<std::uintmax_t>(side * side));
        // snippet: run
        auto sweep = plane::prepare(side);
        auto options = plane::integration(chosen.transient + chosen.phases);
        options.record = {.from_phase = options.phases - 1, .time = true};
        options.schedule = schedules.at(schedule);
        const auto report = examples::integrate<myriad::rodas_5p>(chosen, device, sweep, options);
        // end of snippet
        if (!chosen.quiet) describe(report, steps_of(sweep));
        write(file, sweep, report, chosen);
        return examples::conclude(chosen, report);
    };
    return examples::run_sweep(
        argc, argv,
        {.description = "Periods of the Oregonator over its parameters f and epsilon",
         .full = {.instances = 512 * 512, .transient = 63, .phases = 1},
         .small = {.instances = 32 * 32, .transient = 63, .phases = 1},
         .output = "results/stiff_chemistry.csv",
         .instances_help = "Number of instances, a square grid: rounded down to a square number",
         .phases_help = "Cycles after the transient ones, the last of which is written",
         .options = {{"--schedule", &schedule, "Order of the instances: in_order, dynamic, by_cost or automatic",
                      "NAME", examples::names_of(schedules)}}},
        run);
}
