// SPDX-License-Identifier: MIT
// The first example: a bifurcation diagram of the Duffing oscillator over its damping, as in the MPGOS paper, as a
// study whose results are one file.
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <numbers>
#include <string>
#include <vector>

#include <myriad/study.hpp>

#include "../common/command_line.hpp"
#include "../common/csv_file.hpp"
#include "sweep.hpp"

namespace {

using namespace duffing_sweep;

std::string folder;  // for results that are kept while it runs; empty: they are in memory

/// One instance per damping; a phase is one period of the forcing.
void set_up(myriad::any_study& sweep, std::int64_t instances, std::int64_t transient, std::int64_t phases) {
    // snippet: study
    sweep.axis("k", myriad::linspace(k_first, k_last, instances));
    sweep.set("B", forcing);
    sweep.set("x", x_start);
    sweep.set("v", v_start);
    sweep.time_domain(0, 2 * std::numbers::pi);
    sweep.title("Duffing oscillator x'' + k x' - x + x^3 = B cos t, v = x'; all quantities are dimensionless");
    // end of snippet
    sweep.options = {.phases = transient + phases,
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
                     .record = {.from_phase = transient,
                                .states = {duffing::x, duffing::v},
                                .accessories = {duffing::x_local_max, duffing::v_second_zero, duffing::x_global_max},
                                .integer_accessories = {duffing::zeros}}};
}

// A row for each instance and recorded phase. Nothing here depends on the time, machine or number of threads: equal
// results give equal files.
void write(examples::csv_file& file, const myriad::study_result& result, std::int64_t transient, std::int64_t phases) {
    using myriad::message;
    const std::int64_t instances = result.content().instances();
    file.comment("Duffing oscillator x'' + k x' - x + x^3 = B cos t, v = x'; all quantities are dimensionless");
    file.comment(message("k = linspace(", k_first, ", ", k_last, ", ", instances, "), B = ", forcing,
                         ", x(0) = ", x_start, ", v(0) = ", v_start));
    file.comment(message("phases of length 2 pi: ", transient, " transient, ", phases, " recorded"));
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

    const myriad::axis_values k = myriad::linspace(k_first, k_last, instances);
    for (std::int64_t i = 0; i < instances; ++i) {
        const auto of = [&](const char* name) { return result.values_of<double>(name, i, 1); };
        const auto x = of("x"), v = of("v"), x_local_max = of("x_local_max"), v_second_zero = of("v_second_zero"),
                   x_global_max = of("x_global_max");
        const auto zeros = result.values_of<std::int32_t>("zeros", i, 1);
        const auto status = static_cast<myriad::status>(result.values_of<std::uint8_t>("status", i, 1)[0]);
        for (std::size_t r = 0; r < x.size(); ++r)
            file.row(i, transient + static_cast<std::int64_t>(r), k[i], forcing, x[r], v[r], x_local_max[r],
                     v_second_zero[r], x_global_max[r], zeros[r], myriad::name_of(status));
    }
    file.commit();
}

int run(const examples::sweep_options& chosen, const myriad::device& device) {
    const bool is_table = std::filesystem::path(chosen.output).extension() == ".csv";
    const auto rows = static_cast<std::uintmax_t>(chosen.instances) * static_cast<std::uintmax_t>(chosen.phases);
    // The shortest rows have about 100 characters. How far the other file is compressed, is not known.
    examples::csv_file file(chosen.output, is_table ? 80 * rows : 0);

    myriad::study<duffing, myriad::cash_karp> sweep;
    set_up(sweep, chosen.instances, chosen.transient, chosen.phases);
    sweep.devices = {device};
    if (!folder.empty()) sweep.store(folder);
    if (!chosen.quiet) {
        std::cerr << "Integrating " << chosen.instances << " instances over " << chosen.transient << " + "
                  << chosen.phases << " phases\n";
        sweep.progress = myriad::progress_line();
    }
    const myriad::study_result result = sweep.run();
    sweep.progress = {};
    if (!chosen.quiet) std::cout << result;
    if (is_table) {
        write(file, result, chosen.transient, chosen.phases);
    } else {
        myriad::export_netcdf(result.results(), file.path().string());
        examples::csv_file::set_any_is_there();
    }
    if (!chosen.quiet) std::cout << "Written to " << chosen.output << '\n';
    if (result.failed() == 0) return 0;
    std::cerr << result.failed() << " of " << result.instances
              << " instances failed; what they did not complete is nan in " << chosen.output << '\n';
    return 1;
}

}  // namespace

int main(int argc, char** argv) {
    return examples::run_sweep(
        argc, argv,
        {.description = "Bifurcation diagram of the Duffing oscillator over its damping k",
         .full = {.instances = 46080, .transient = 1024, .phases = 32},
         .small = {.instances = 1000, .transient = 128, .phases = 16},
         .output = "results/duffing.nc",
         .output_help = "File to write: netCDF, or with the ending .csv a table",
         .options = {{"--folder", &folder, "Keep results there while it runs, and go on with them if it is run again",
                      "FOLDER"}}},
        run);
}
