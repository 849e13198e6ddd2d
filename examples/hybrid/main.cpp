// SPDX-License-Identifier: MIT
// A hybrid system: the stick-slip oscillation of a block on a belt, over the belt's speed. A phase lasts from one slip
// to the next; the example's test compares its period with a closed form.
#include <cstdint>
#include <limits>

#include <myriad/myriad.hpp>

#include "../common/csv_file.hpp"
#include "../common/grid.hpp"
#include "../common/integrate.hpp"
#include "stick_slip.hpp"

namespace {

constexpr double belt_first = 0.1, belt_last = 1, kinetic = 0.5, breakaway = 1;
constexpr double tolerance = 1e-10;

myriad::ensemble<stick_slip> prepare(std::int64_t instances) {
    myriad::ensemble<stick_slip> sweep(instances);
    sweep.parameter(stick_slip::belt) = examples::linspace(belt_first, belt_last, instances);
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
    const auto report = examples::integrate<myriad::tsitouras_5>(
        chosen, device, sweep,
        {.phases = chosen.transient + chosen.phases,
         .relative_tolerance = tolerance,
         .absolute_tolerance = tolerance,
         .phase_time = myriad::phase_time::carry_on,
         .events = {{.direction = myriad::direction::rising, .tolerance = tolerance},
                    {.direction = myriad::direction::rising, .tolerance = tolerance, .stop_after = 1}},
         .record = {.from_phase = chosen.transient,
                    .accessories = {stick_slip::x_slip, stick_slip::x_stick, stick_slip::period}}});

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
    return examples::conclude(chosen, report);
}

}  // namespace

int main(int argc, char** argv) {
    return examples::run_sweep(argc, argv,
                               {.description = "Stick-slip oscillation of a block on a belt, over the belt's speed",
                                .full = {.instances = 1024, .transient = 1, .phases = 2},
                                .small = {.instances = 64, .transient = 1, .phases = 2},
                                .output = "results/stick_slip.csv"},
                               run);
}
