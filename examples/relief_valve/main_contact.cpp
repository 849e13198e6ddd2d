// SPDX-License-Identifier: MIT
// Impact dynamics with resting contact: maxima of a pressure relief valve over its flow, where impacts accumulate and
// the valve rests on its seat until the pressure lifts it.
#include <cstdint>

#include <myriad/myriad.hpp>

#include "../common/csv_file.hpp"
#include "../common/integrate.hpp"
#include "sweep.hpp"

namespace {

namespace valves = relief_valve_sweep;
using model = relief_valve_contact;

double q_first = 0.001, q_last = 0.12;

int run(const examples::sweep_options& chosen, const myriad::device& device) {
    using myriad::message;
    const auto rows = static_cast<std::uintmax_t>(chosen.instances) * static_cast<std::uintmax_t>(chosen.phases);
    examples::csv_file file(chosen.output, 40 * rows);  // the shortest rows have about 60 characters
    auto sweep = valves::prepare_contact(chosen.instances, q_first, q_last);
    auto options = valves::integration_with_contact(chosen.transient + chosen.phases);
    options.record = {.from_phase = chosen.transient,
                      .accessories = {model::y_min, model::y_max, model::u_contact, model::time_at_rest}};
    const auto report = examples::integrate<myriad::cash_karp>(chosen, device, sweep, options);

    file.comment("Pressure relief valve that may rest on its seat, phase by phase from one maximum of y to the next");
    file.comment(message(valves::constants(), "; q = linspace(", q_first, ", ", q_last, ", ", chosen.instances, "); ",
                         chosen.transient, " phases were let pass"));
    file.comment(message("last impact: speed after it below ", valves::slowest));
    file.comment("u_contact: u where a rest began; time_at_rest: how long it lasted; both 0 in phases without one");
    file.comment(message("Myriad " MYRIAD_VERSION ", method cash_karp, relative and absolute tolerance ",
                         valves::tolerance, ", of the seat and the opening ", valves::contact_tolerance));
    file.row("instance", "phase", "q", "y_min", "y_max", "u_contact", "time_at_rest", "status");
    const auto y_min = report.records.accessory(model::y_min), y_max = report.records.accessory(model::y_max),
               u_contact = report.records.accessory(model::u_contact),
               at_rest = report.records.accessory(model::time_at_rest);
    for (std::int64_t i = 0; i < sweep.size(); ++i)
        for (std::int64_t r = 0; r < report.records.phases(); ++r)
            file.row(i, chosen.transient + r, sweep.parameter(model::q)[i], y_min(i, r), y_max(i, r), u_contact(i, r),
                     at_rest(i, r), myriad::name_of(sweep.status(i)));
    file.commit();
    return examples::conclude(chosen, report);
}

}  // namespace

int main(int argc, char** argv) {
    return examples::run_sweep(
        argc, argv,
        {.description = "Maxima of a pressure relief valve that may rest on its seat, over its flow q",
         .full = {.instances = 30720, .transient = 512, .phases = 64},
         .small = {.instances = 512, .transient = 128, .phases = 64},
         .output = "results/relief_valve_contact.csv",
         .options = {{"--first", &q_first, "Smallest q"}, {"--last", &q_last, "Largest q"}}},
        run);
}
