// SPDX-License-Identifier: MIT
// Impact dynamics: largest and smallest displacement of a pressure relief valve over its flow, as in the MPGOS paper.
#include <cstdint>

#include <myriad/myriad.hpp>

#include "../common/csv_file.hpp"
#include "../common/integrate.hpp"
#include "sweep.hpp"

namespace {

namespace valves = relief_valve_sweep;

int run(const examples::sweep_options& chosen, const myriad::device& device) {
    const auto rows = static_cast<std::uintmax_t>(chosen.instances) * static_cast<std::uintmax_t>(chosen.phases);
    examples::csv_file file(chosen.output, 40 * rows);
    auto sweep = valves::prepare(chosen.instances);
    auto options = valves::integration(chosen.transient + chosen.phases);
    options.record = {.from_phase = chosen.transient,
                      .accessories = {relief_valve::y_min, relief_valve::y_max},
                      .integer_accessories = {relief_valve::impacts}};
    const auto report = examples::integrate<myriad::cash_karp>(chosen, device, sweep, options);

    file.comment(
        "Pressure relief valve: smallest and largest y in each recorded phase, which goes from one maximum to the "
        "next");
    file.comment(myriad::message(valves::constants(), "; q = linspace(", valves::q_first, ", ", valves::q_last, ", ",
                                 chosen.instances, "); ", chosen.transient, " phases were let pass"));
    file.comment("impacts: from the start on. Valves whose impacts accumulate hold nan from there on.");
    file.comment(myriad::message("Myriad " MYRIAD_VERSION ", method cash_karp, relative and absolute tolerance ",
                                 valves::tolerance, ", of the seat ", valves::event_tolerance));
    file.row("instance", "phase", "q", "y_min", "y_max", "impacts", "status");
    const auto y_min = report.records.accessory(relief_valve::y_min),
               y_max = report.records.accessory(relief_valve::y_max);
    const auto impacts = report.records.integer_accessory(relief_valve::impacts);
    for (std::int64_t i = 0; i < sweep.size(); ++i)
        for (std::int64_t r = 0; r < report.records.phases(); ++r)
            file.row(i, chosen.transient + r, sweep.parameter(relief_valve::q)[i], y_min(i, r), y_max(i, r),
                     impacts(i, r), myriad::name_of(sweep.status(i)));
    file.commit();
    return examples::conclude(chosen, report, myriad::status::event_accumulation);
}

}  // namespace

int main(int argc, char** argv) {
    return examples::run_sweep(argc, argv,
                               {.description = "Displacement of a pressure relief valve over its flow q",
                                .full = {.instances = 30720, .transient = 1024, .phases = 32},
                                .small = {.instances = 512, .transient = 64, .phases = 16},
                                .output = "results/relief_valve.csv"},
                               run);
}
