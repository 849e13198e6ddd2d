// SPDX-License-Identifier: MIT
// A hybrid system: the stick-slip oscillation of a block on a belt over the belt's speed. A phase goes from one slip to the
// next; its period has a closed form, with which the example's test compares it.
#include <cstdint>
#include <iostream>
#include <limits>

#include <myriad/myriad.hpp>

#include "../common/command_line.hpp"
#include "../common/csv_file.hpp"
#include "../common/progress.hpp"
#include "stick_slip.hpp"

namespace {

constexpr double belt_first = 0.1, belt_last = 1, kinetic = 0.5, breakaway = 1;
constexpr double tolerance = 1e-10;

myriad::ensemble<stick_slip> prepare(std::int64_t instances) {
    myriad::ensemble<stick_slip> sweep(instances);
    sweep.parameter(stick_slip::belt) = belt_first;  // LinSpaced would give a single one the last value
    if (instances > 1) sweep.parameter(stick_slip::belt) = Eigen::ArrayXd::LinSpaced(instances, belt_first, belt_last);
    sweep.shared(stick_slip::kinetic) = kinetic;
    sweep.shared(stick_slip::breakaway) = breakaway;
    sweep.state(stick_slip::x) = 0;
    sweep.state(stick_slip::v) = sweep.parameter(stick_slip::belt);
    sweep.integer_accessory(stick_slip::sticks) = 1;
    sweep.accessory(stick_slip::t_slip) = 0;
    sweep.time_domain(0, std::numeric_limits<double>::infinity());  // the slip ends a phase
    return sweep;
}

int run(const examples::sweep_options& chosen, const myriad::device& device) {
    examples::csv_file file(chosen.output);
    auto sweep = prepare(chosen.instances);
    examples::progress shown(chosen.quiet ? examples::progress::style::none : examples::progress::style::automatic);
    const auto report = myriad::solve<myriad::tsitouras_5>(
        device, sweep,
        {.phases = chosen.transient + chosen.recorded,
         .relative_tolerance = tolerance,
         .absolute_tolerance = tolerance,
         .phase_time = myriad::phase_time::carry_on,
         .events = {{.direction = myriad::direction::rising, .tolerance = tolerance},
                    {.direction = myriad::direction::rising, .tolerance = tolerance, .stop_after = 1}},
         .record = {.from_phase = chosen.transient,
                    .accessories = {stick_slip::x_slip, stick_slip::x_stick, stick_slip::period}},
         .progress = [&shown](std::int64_t begun, std::int64_t total) { shown(begun, total); }});
    shown.finish();
    if (!chosen.quiet) std::cout << report;

    file.comment(
        myriad::message("Block on a belt: x'' = -x + friction; kinetic friction ", kinetic, ", breakaway ", breakaway));
    file.comment(
        "One row per instance and recorded phase, which goes from one slip to the next; the first has no period.");
    file.comment("x_slip, x_stick: where the block begins to slide and to stick; period: time from slip to slip");
    file.row("instance", "phase", "belt", "x_slip", "x_stick", "period", "status");
    const auto x_slip = report.records.accessory(stick_slip::x_slip),
               x_stick = report.records.accessory(stick_slip::x_stick);
    const auto period = report.records.accessory(stick_slip::period);
    for (std::int64_t i = 0; i < sweep.size(); ++i)
        for (std::int64_t r = 0; r < report.records.phases(); ++r)
            file.row(i, chosen.transient + r, sweep.parameter(stick_slip::belt)[i], x_slip(i, r), x_stick(i, r),
                     period(i, r), myriad::name_of(sweep.status(i)));
    file.commit();
    return report.failed() == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    return examples::run_sweep(argc, argv, "Stick-slip oscillation of a block on a belt, over the belt's speed",
                               {.instances = 1024, .transient = 1, .recorded = 2, .output = "results/stick_slip.csv"},
                               run);
}
