// SPDX-License-Identifier: MIT
// The maximum response diagram of a forced oscillator, from accessories, and again from dense output.
#include <chrono>
#include <cstdint>
#include <iostream>

#include "../common/csv_file.hpp"
#include "../common/integrate.hpp"
#include "../common/phases.hpp"
#include "sweep.hpp"

namespace {

using clock = std::chrono::steady_clock;

double seconds_since(clock::time_point begin) { return std::chrono::duration<double>(clock::now() - begin).count(); }

int run(const examples::sweep_options& chosen, const myriad::device& device) {
    examples::csv_file file(chosen.output, 100 * static_cast<std::uintmax_t>(resonance::curves * chosen.instances));
    auto options = examples::smooth_phases(1, resonance::tolerance);
    examples::sweep_options call = chosen;  // each call takes phases of one kind
    call.transient = 0;

    auto hooked = resonance::prepare<response>(chosen.instances);
    options.events = {{.tolerance = resonance::event_tolerance}};
    resonance::begin_response(hooked);
    options.phases = chosen.transient;
    if (chosen.transient > 0) examples::integrate<myriad::tsitouras_5>(call, device, hooked, options);
    options.phases = chosen.phases;
    auto begin = clock::now();
    resonance::begin_response(hooked);
    const auto report = examples::integrate<myriad::tsitouras_5>(call, device, hooked, options);
    const double by_hooks = seconds_since(begin);

    auto sampled = resonance::prepare<oscillator>(chosen.instances);
    options.events = {};
    options.phases = chosen.transient;
    if (chosen.transient > 0) examples::integrate<myriad::dense<myriad::tsitouras_5>>(call, device, sampled, options);
    options.phases = chosen.phases;
    // snippet: samples
    options.samples = {.states = {oscillator::x},
                       .capacity = resonance::samples_per_phase * chosen.phases,
                       .evenly = resonance::samples_per_phase};
    // end of snippet
    begin = clock::now();
    examples::integrate<myriad::dense<myriad::tsitouras_5>>(call, device, sampled, options);
    const auto found = resonance::evaluate(sampled);
    const double by_samples = seconds_since(begin);

    if (!chosen.quiet) {
        const auto numbers = static_cast<std::int64_t>(sizeof(double)) * hooked.size();
        const std::int64_t in_hooks = response::n_accessory * numbers;
        const std::int64_t in_samples = 2 * sampled.samples().capacity() * numbers;  // times and values
        std::cout << "By hooks: " << in_hooks << " bytes of accessories, " << by_hooks << " s\n"
                  << "By dense output: " << in_samples << " bytes of samples, " << by_samples << " s\n";
    }
    using myriad::message;
    file.comment(
        "Response of x'' + 2 zeta x' + x + beta x^3 = cos(omega t); x in units of the static deflection of the "
        "linear spring, time in units of 1/omega_0");
    file.comment(message("zeta = ", resonance::zeta, ", omega = linspace(", resonance::omega_first, ", ",
                         resonance::omega_last, ", ", chosen.instances,
                         "); start 0: at rest, 1: on the backbone curve"));
    file.comment(message("phases of one period of the forcing: ", chosen.transient, " transient, ", chosen.phases,
                         " evaluated"));
    file.comment(message("Myriad " MYRIAD_VERSION ", method tsitouras_5, relative and absolute tolerance ",
                         resonance::tolerance, ", event tolerance ", resonance::event_tolerance));
    file.comment(message("maximum, minimum, mean square of x: from accessories; ..._sampled: from ",
                         resonance::samples_per_phase, " samples per phase; status: of the first"));
    file.row("beta", "start", "omega", "maximum", "minimum", "mean_square", "maximum_sampled", "minimum_sampled",
             "mean_square_sampled", "status");
    for (std::int64_t i = 0; i < hooked.size(); ++i) {
        const double duration = static_cast<double>(chosen.phases) * hooked.t_end()[i];
        file.row(hooked.parameter(response::beta)[i], i / chosen.instances % resonance::starts,
                 hooked.parameter(response::omega)[i], hooked.accessory(response::maximum)[i],
                 hooked.accessory(response::minimum)[i], hooked.accessory(response::integral)[i] / duration,
                 found(i, 0), found(i, 1), found(i, 2) / duration, myriad::name_of(hooked.status(i)));
    }
    file.commit();
    return examples::conclude(chosen, report);
}

}  // namespace

int main(int argc, char** argv) {
    return examples::run_sweep(
        argc, argv,
        {.description = "Maximum response diagram of a forced oscillator, by hooks and by dense output",
         .full = {.instances = 10000, .transient = 200, .phases = 8},
         .small = {.instances = 100, .transient = 200, .phases = 8},
         .output = "results/resonance.csv",
         .instances_help = "Frequencies of each of the six curves",
         .phases_help = "Phases to evaluate after the transient ones"},
        run);
}
