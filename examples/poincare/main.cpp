// SPDX-License-Identifier: MIT
// Poincare sections of an autonomous system: where and when orbits of Roessler's equations return to a half plane, over
// c.
#include <cstdint>

#include <myriad/myriad.hpp>

#include "../common/csv_file.hpp"
#include "../common/integrate.hpp"
#include "sweep.hpp"

namespace {

double c_first = roessler_sweep::c_first, c_last = roessler_sweep::c_last;

int run(const examples::sweep_options& chosen, const myriad::device& device) {
    using myriad::message;
    const auto rows = static_cast<std::uintmax_t>(chosen.instances) * static_cast<std::uintmax_t>(chosen.phases);
    examples::csv_file file(chosen.output, 40 * rows);  // the shortest rows have about 60 characters
    auto sweep = roessler_sweep::prepare(chosen.instances, c_first, c_last);
    const auto report = examples::integrate<myriad::tsitouras_5>(
        chosen, device, sweep, roessler_sweep::integration(chosen.transient, chosen.phases));

    file.comment(
        "Roessler's equations x' = -y - z, y' = x + a y, z' = b + z (x - c) at returns to the half plane y = 0, x < 0");
    file.comment(message("a = ", roessler_sweep::a, ", b = ", roessler_sweep::b, ", c = linspace(", c_first, ", ",
                         c_last, ", ", chosen.instances, "); start (-5, 0, 0)"));
    file.comment(message(chosen.transient, " returns were let pass; return_time is the time since the one before"));
    file.comment(message("Myriad " MYRIAD_VERSION ", method tsitouras_5, relative and absolute tolerance ",
                         roessler_sweep::tolerance, ", y = 0 to ", roessler_sweep::section_tolerance));
    file.row("instance", "phase", "c", "x", "z", "return_time", "status");
    // snippet: records
    const auto x = report.records.state(roessler::x), z = report.records.state(roessler::z);
    const auto return_time = report.records.time();
    for (std::int64_t i = 0; i < sweep.size(); ++i)
        for (std::int64_t r = 0; r < report.records.phases(); ++r)
            file.row(i, chosen.transient + r, sweep.parameter(roessler::c)[i], x(i, r), z(i, r), return_time(i, r),
                     myriad::name_of(sweep.status(i)));
    // end of snippet
    file.commit();
    return examples::conclude(chosen, report);
}

}  // namespace

int main(int argc, char** argv) {
    return examples::run_sweep(argc, argv,
                               {.description = "Poincare sections of Roessler's equations over c",
                                .full = {.instances = 65536, .transient = 1000, .phases = 64},
                                .small = {.instances = 1024, .transient = 200, .phases = 32},
                                .output = "results/poincare.csv",
                                .phases_help = "Returns to record after the transient ones",
                                .options = {{"--first", &c_first, "Smallest c"}, {"--last", &c_last, "Largest c"}}},
                               run);
}
