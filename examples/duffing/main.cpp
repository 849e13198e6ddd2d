// SPDX-License-Identifier: MIT
// The first example: a bifurcation diagram of the Duffing oscillator over its damping, as in the MPGOS paper.
#include <cstdint>
#include <string>

#include <myriad/myriad.hpp>

#include "../common/csv_file.hpp"
#include "../common/integrate.hpp"
#include "sweep.hpp"

namespace {

using records = myriad::phase_records<duffing, double>;

using namespace duffing_sweep;

myriad::options integration(const examples::sweep_options& chosen) {
    return {.phases = chosen.transient + chosen.phases,
            .relative_tolerance = tolerance,
            .absolute_tolerance = tolerance,
            .step = 1e-2,
            .minimum_step = 1e-12,
            .maximum_step = 1e6,
            .phase_step = myriad::phase_step::restart,
            // snippet: events
            .events = {{.direction = myriad::direction::falling, .tolerance = event_tolerance},
                       {.direction = myriad::direction::either, .tolerance = event_tolerance}},
            // end of snippet
            .record = {.from_phase = chosen.transient,
                       .states = {duffing::x, duffing::v},
                       .accessories = {duffing::x_local_max, duffing::v_second_zero, duffing::x_global_max},
                       .integer_accessories = {duffing::zeros}}};
}

// Nothing here depends on the time, machine or number of threads: equal results give equal files.
void write(examples::csv_file& file, const myriad::ensemble<duffing>& sweep, const records& recorded,
           std::int64_t transient) {
    using myriad::message;
    file.comment("Duffing oscillator x'' + k x' - x + x^3 = B cos t, v = x'; all quantities are dimensionless");
    file.comment(message("k = linspace(", k_first, ", ", k_last, ", ", sweep.size(), "), B = ", forcing,
                         ", x(0) = ", x_start, ", v(0) = ", v_start));
    file.comment(message("phases of length 2 pi: ", transient, " transient, ", recorded.phases(), " recorded"));
    file.comment(message("Myriad " MYRIAD_VERSION ", method cash_karp, relative and absolute tolerance ", tolerance,
                         ", event tolerance ", event_tolerance));
    for (const char* line :
         {"One row per instance and recorded phase; phases that a failed instance did not complete hold nan and 0 "
          "zeros.",
          "instance, phase: counted from 0, transient phases included; x, v: at the end of the phase (Poincare "
          "section);",
          "x_local_max: largest of x at the start of the phase and at its local maxima;",
          "v_second_zero: v where x crosses zero for the second time, or v at the start of the phase if it does not;",
          "x_global_max: largest of x at the start of the phase and after each step; zeros: zero crossings of x;",
          "status: how the last phase of the instance ended"})
        file.comment(line);
    file.row("instance", "phase", "k", "B", "x", "v", "x_local_max", "v_second_zero", "x_global_max", "zeros",
             "status");

    const auto k = sweep.parameter(duffing::k);
    const auto x = recorded.state(duffing::x), v = recorded.state(duffing::v);
    const auto x_local_max = recorded.accessory(duffing::x_local_max);
    const auto v_second_zero = recorded.accessory(duffing::v_second_zero);
    const auto x_global_max = recorded.accessory(duffing::x_global_max);
    const auto zeros = recorded.integer_accessory(duffing::zeros);
    for (std::int64_t i = 0; i < sweep.size(); ++i) {
        for (std::int64_t r = 0; r < recorded.phases(); ++r) {
            file.row(i, transient + r, k[i], forcing, x(i, r), v(i, r), x_local_max(i, r), v_second_zero(i, r),
                     x_global_max(i, r), zeros(i, r), myriad::name_of(sweep.status(i)));
        }
    }
    file.commit();
}

int run(const examples::sweep_options& chosen, const myriad::device& device) {
    const auto rows = static_cast<std::uintmax_t>(chosen.instances) * static_cast<std::uintmax_t>(chosen.phases);
    examples::csv_file file(chosen.output, 80 * rows);  // the shortest rows have about 100 characters
    auto sweep = prepare(k_grid(chosen.instances));
    const auto report = examples::integrate<myriad::cash_karp>(chosen, device, sweep, integration(chosen));
    write(file, sweep, report.records, chosen.transient);
    return examples::conclude(chosen, report);
}

}  // namespace

int main(int argc, char** argv) {
    return examples::run_sweep(argc, argv,
                               {.description = "Bifurcation diagram of the Duffing oscillator over its damping k",
                                .full = {.instances = 46080, .transient = 1024, .phases = 32},
                                .small = {.instances = 1000, .transient = 128, .phases = 16},
                                .output = "results/duffing.csv"},
                               run);
}
