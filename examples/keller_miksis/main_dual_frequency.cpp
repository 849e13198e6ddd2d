// SPDX-License-Identifier: MIT
// A bubble in water under sound of two frequencies: how far it expands, how hard and fast it collapses, and how often.
#include <cstdint>
#include <limits>
#include <vector>

#include <myriad/myriad.hpp>

#include "../common/csv_file.hpp"
#include "../common/grid.hpp"
#include "../common/integrate.hpp"
#include "dual_frequency.hpp"

namespace {

using bubble::kHz, bubble::bar, bubble::us, bubble::f_first, bubble::f_last;
using dual_frequency::model, dual_frequency::waves;

/// Pressure amplitudes in bar; options of the command line.
std::vector<double> first_amplitudes{0.5, 1.1}, second_amplitudes{0.7, 1.2};

/// The two waves of every instance: f1 varies fastest, then f2, then the second amplitude.
std::vector<waves> prepare_waves(std::int64_t frequencies) {
    const Eigen::ArrayXd f = examples::geomspace(f_first, f_last, frequencies);
    std::vector<waves> all;
    for (const double p1 : first_amplitudes)
        for (const double p2 : second_amplitudes)
            for (const double f2 : f)
                for (const double f1 : f) all.push_back({{p1 * bar, f1}, {p2 * bar, f2}});
    return all;
}

void write(examples::csv_file& file, const myriad::ensemble<model>& sweep, const std::vector<waves>& driven_by,
           const examples::sweep_options& chosen) {
    using myriad::message;
    file.comment("Keller-Miksis bubble in water at 25 C, radius at rest RE = 10 um, under sound of two frequencies");
    file.comment(message("f1, f2 = geomspace(", f_first / kHz, ", ", f_last / kHz, ", ", chosen.instances,
                         ") kHz, no phase between them, start at rest"));
    file.comment(message("eigenfrequency ", bubble::eigenfrequency() / kHz, " kHz"));
    file.comment(message("phases from one maximum of the radius to the next: ", chosen.transient, " transient, ",
                         chosen.phases, " recorded"));
    file.comment(message("Myriad " MYRIAD_VERSION ", method cash_karp, relative and absolute tolerance ",
                         dual_frequency::tolerance, ", event tolerance ", dual_frequency::maximum_tolerance,
                         " (maximum) and ", dual_frequency::minimum_tolerance, " (minimum)"));
    file.comment(
        "expansion: (Rmax - RE) / RE over the recorded phases; compression, collapse_us: ratio of the maximum to "
        "the minimum");
    file.comment(
        "that follows it, in the strongest collapse, and the time between them in us; winding: maxima per "
        "period of f1; failed instances: nan");
    file.row("instance", "pa1_bar", "pa2_bar", "f1_kHz", "f2_kHz", "expansion", "compression", "collapse_us", "winding",
             "status");
    const auto largest = sweep.accessory(model::largest), compression = sweep.accessory(model::compression);
    const auto collapse_time = sweep.accessory(model::collapse_time), winding = sweep.accessory(model::winding);
    for (std::int64_t i = 0; i < sweep.size(); ++i) {
        const waves& w = driven_by[static_cast<std::size_t>(i)];
        const auto status = sweep.status(i);
        const double valid = myriad::is_failure(status) ? std::numeric_limits<double>::quiet_NaN() : 1;
        file.row(i, w.first.pressure / bar, w.second.pressure / bar, w.first.frequency / kHz, w.second.frequency / kHz,
                 valid * (largest[i] - 1), valid * compression[i], valid * collapse_time[i] / w.first.frequency / us,
                 valid * winding[i], myriad::name_of(status));
    }
    file.commit();
}

int run(const examples::sweep_options& chosen, const myriad::device& device) {
    const auto driven_by = prepare_waves(chosen.instances);
    examples::csv_file file(chosen.output, 80 * driven_by.size());
    auto sweep = dual_frequency::prepare(driven_by, chosen.transient);
    const auto report = examples::integrate<myriad::cash_karp>(
        chosen, device, sweep, dual_frequency::integration(chosen.transient + chosen.phases));
    write(file, sweep, driven_by, chosen);
    return examples::conclude(chosen, report);
}

}  // namespace

int main(int argc, char** argv) {
    const examples::own_option::range pressures{0.0, 10.0};
    return examples::run_sweep(argc, argv,
                               {.description = "A bubble under sound of two frequencies, over both",
                                .full = {.instances = 128, .transient = 1024, .phases = 64},
                                .small = {.instances = 12, .transient = 16, .phases = 16},
                                .output = "results/bubble_dual_frequency.csv",
                                .instances_help = "Values of each frequency: all pairs, for each pair of pressures",
                                .phases_help = "Maxima to record after the transient ones",
                                .options = {{"--pressures-1", &first_amplitudes,
                                             "Pressure amplitudes of the first wave in bar", "BAR", pressures},
                                            {"--pressures-2", &second_amplitudes,
                                             "Pressure amplitudes of the second wave in bar", "BAR", pressures}}},
                               run);
}
