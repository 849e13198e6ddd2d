// SPDX-License-Identifier: MIT
// The response of a bubble in water to a sound wave: its largest radius over the frequency, as in the MPGOS paper.
#include <cstdint>

#include <myriad/myriad.hpp>

#include "../common/csv_file.hpp"
#include "../common/grid.hpp"
#include "../common/integrate.hpp"
#include "constants.hpp"
#include "keller_miksis.hpp"

namespace {

using bubble::kHz, bubble::bar, bubble::f_first, bubble::f_last;
using records = myriad::phase_records<bubble_response, double>;

constexpr double tolerance = 1e-10, event_tolerance = 1e-6;

double amplitude = 1.5;  // of the pressure, in bar; an option of the command line

myriad::ensemble<bubble_response> prepare(const Eigen::ArrayXd& f) {
    myriad::ensemble<bubble_response> sweep(f.size());
    for (std::int64_t i = 0; i < sweep.size(); ++i) {
        const auto C = bubble::constants({amplitude * bar, f[i]}, {0, f[i]});
        for (int c = 0; c < bubble_response::n_parameter; ++c) sweep.parameter(c)[i] = C[static_cast<std::size_t>(c)];
    }
    sweep.state(bubble_response::y) = 1;
    sweep.state(bubble_response::v) = 0;
    sweep.accessory(bubble_response::y_max) = 1;
    sweep.time_domain(0, 1);
    return sweep;
}

myriad::options integration(const examples::sweep_options& chosen) {
    return {.phases = chosen.transient + chosen.phases,
            .relative_tolerance = tolerance,
            .absolute_tolerance = tolerance,
            .step = 1e-2,
            .minimum_step = 1e-12,
            .phase_step = myriad::phase_step::carry_on,
            .events = {{.direction = myriad::direction::falling, .tolerance = event_tolerance}},
            .record = {.from_phase = chosen.transient,
                       .accessories = {bubble_response::y_max},
                       .integer_accessories = {bubble_response::maxima}}};
}

void write(examples::csv_file& file, const myriad::ensemble<bubble_response>& sweep, const Eigen::ArrayXd& f,
           const records& recorded, std::int64_t transient) {
    using myriad::message;
    file.comment("Keller-Miksis bubble in water at 25 C, radius at rest 10 um, under a sound wave of one frequency");
    file.comment(message("f = geomspace(", f_first / kHz, ", ", f_last / kHz, ", ", sweep.size(),
                         ") kHz, pressure amplitude ", amplitude, " bar, start at rest"));
    file.comment(message("eigenfrequency ", bubble::eigenfrequency() / kHz, " kHz"));
    file.comment(message("phases of one period: ", transient, " transient, ", recorded.phases(), " recorded"));
    file.comment(message("Myriad " MYRIAD_VERSION ", method cash_karp, relative and absolute tolerance ", tolerance,
                         ", event tolerance ", event_tolerance));
    file.comment(
        "One row per instance and recorded phase. y_max: largest radius over that at rest, at local maxima and "
        "at the start of the phase;");
    file.comment("maxima: number of local maxima in the phase; phases that a failed instance did not complete: nan, 0");
    file.row("instance", "phase", "f_kHz", "y_max", "maxima", "status");
    const auto y_max = recorded.accessory(bubble_response::y_max);
    const auto maxima = recorded.integer_accessory(bubble_response::maxima);
    for (std::int64_t i = 0; i < sweep.size(); ++i)
        for (std::int64_t r = 0; r < recorded.phases(); ++r)
            file.row(i, transient + r, f[i] / kHz, y_max(i, r), maxima(i, r), myriad::name_of(sweep.status(i)));
    file.commit();
}

int run(const examples::sweep_options& chosen, const myriad::device& device) {
    const auto rows = static_cast<std::uintmax_t>(chosen.instances) * static_cast<std::uintmax_t>(chosen.phases);
    examples::csv_file file(chosen.output, 40 * rows);
    const Eigen::ArrayXd f = examples::geomspace(f_first, f_last, chosen.instances);
    auto sweep = prepare(f);
    const auto report = examples::integrate<myriad::cash_karp>(chosen, device, sweep, integration(chosen));
    write(file, sweep, f, report.records, chosen.transient);
    return examples::conclude(chosen, report);
}

}  // namespace

int main(int argc, char** argv) {
    return examples::run_sweep(argc, argv,
                               {.description = "Largest radius of a bubble over the frequency of the sound wave",
                                .full = {.instances = 46080, .transient = 1024, .phases = 64},
                                .small = {.instances = 200, .transient = 64, .phases = 16},
                                .output = "results/bubble_response.csv",
                                .options = {{"--pressure", &amplitude, "Pressure amplitude of the wave in bar", "BAR",
                                             examples::own_option::range{1e-9, 10.0}}}},
                               run);
}
