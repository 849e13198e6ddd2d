// SPDX-License-Identifier: MIT
// Rings of 14 Duffing oscillators, of which one starts otherwise than the rest, as in MPGOS's tutorial.
#include <cstdint>

#include "../common/csv_file.hpp"
#include "../common/integrate.hpp"
#include "sweep.hpp"

namespace {

using namespace ring_sweep;

int run(const examples::sweep_options& chosen, const myriad::device& device) {
    const auto rows = static_cast<std::uintmax_t>(chosen.instances * chosen.phases * ring::n_unit);
    examples::csv_file file(chosen.output, 60 * rows);
    auto sweep = prepare(chosen.instances);
    Eigen::ArrayXd x_start = sweep.state(ring::state_of(odd_one, oscillator::x)),
                   v_start = sweep.state(ring::state_of(odd_one, oscillator::v));
    auto options = settings(chosen.transient + chosen.phases);
    // snippet: record
    options.record.from_phase = chosen.transient;
    for (int i = 0; i < ring::n_unit; ++i) {
        options.record.states.push_back(ring::state_of(i, oscillator::x));
        options.record.states.push_back(ring::state_of(i, oscillator::v));
        options.record.accessories.push_back(ring::accessory_of(i, oscillator::second_maximum));
        options.record.integer_accessories.push_back(ring::integer_accessory_of(i, oscillator::maxima));
    }
    // end of snippet
    const auto report = examples::integrate<myriad::cash_karp>(chosen, device, sweep, options);

    using myriad::message;
    file.comment(message("Ring of ", ring::n_unit, " Duffing oscillators, all from x = v = ", start, " but oscillator ",
                         odd_one, ", which starts at (x_start, v_start); all quantities are dimensionless"));
    file.comment(message("c = ", damping, ", B = ", amplitude, ", omega = ", frequency, ", s = ", strength,
                         "; phases of one period of the forcing"));
    file.comment(message("Myriad " MYRIAD_VERSION ", method cash_karp, relative and absolute tolerance ", tolerance));
    file.comment(
        "x, v: at the end of the phase; maxima: local maxima of x since the start; second_maximum: x at the "
        "second of them, or at the start until then; status: of the ring");
    file.row("instance", "phase", "x_start", "v_start", "unit", "x", "v", "second_maximum", "maxima", "status");
    const auto& records = report.records;
    for (std::int64_t i = 0; i < sweep.size(); ++i)
        for (std::int64_t r = 0; r < chosen.phases; ++r)
            for (int unit = 0; unit < ring::n_unit; ++unit)
                file.row(i, chosen.transient + r, x_start[i], v_start[i], unit,
                         records.state(ring::state_of(unit, oscillator::x))(i, r),
                         records.state(ring::state_of(unit, oscillator::v))(i, r),
                         records.accessory(ring::accessory_of(unit, oscillator::second_maximum))(i, r),
                         records.integer_accessory(ring::integer_accessory_of(unit, oscillator::maxima))(i, r),
                         myriad::name_of(sweep.status(i)));
    file.commit();
    if (!chosen.quiet)
        std::cout << "Steps from " << sweep.accessory(oscillator::shortest_step).minCoeff() << " to "
                  << sweep.accessory(oscillator::longest_step).maxCoeff() << " long\n";
    return examples::conclude(chosen, report);
}

}  // namespace

int main(int argc, char** argv) {
    return examples::run_sweep(
        argc, argv,
        {.description = "Rings of coupled Duffing oscillators, of which one starts otherwise than the rest",
         .full = {.instances = 25, .transient = 0, .phases = 10},
         .small = {.instances = 9, .transient = 0, .phases = 4},
         .output = "results/coupled_duffing.csv"},
        run);
}
