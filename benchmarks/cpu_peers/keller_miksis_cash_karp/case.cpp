// SPDX-License-Identifier: MIT
// The case keller_miksis_cash_karp: its sweep, and Myriad's call.
#include <cmath>

#include "../cases.hpp"
#include "../myriad_run.hpp"
#include "equations.hpp"
#include "examples/keller_miksis/constants.hpp"
#include "model.hpp"

namespace cpu_peers {
namespace {

using dormand_prince_8_pi = myriad::controlled<myriad::dormand_prince_8, myriad::pi_control>;

using model = keller_miksis_model;

template <class Method>
outcome run(const sweep& work) {
    return run_myriad<Method, model>(work,
                                     {.phases = work.phases,
                                      .relative_tolerance = work.tolerance,
                                      .absolute_tolerance = work.tolerance,
                                      .step = keller_miksis::first_step,
                                      .minimum_step = 1e-12,
                                      .maximum_step = 1e6},
                                     [](auto& instances) { instances.time_domain(0, 1); });
}

// Driven with 1.5 bar at f1 and not driven at f2.
void fill(std::int64_t instances, double* parameters, double* states) {
    const Eigen::ArrayXd logarithm =
        Eigen::ArrayXd::LinSpaced(instances, std::log10(20e3), std::log10(1000e3));  // of f1 in Hz
    for (std::int64_t i = 0; i < instances; ++i) {
        const double f = std::pow(10.0, logarithm[i]);
        const auto C = bubble::constants({1.5e5, f}, {0, f});
        static_assert(C.size() == model::n_parameter);
        for (int c = 0; c < model::n_parameter; ++c) parameters[c * instances + i] = C[static_cast<std::size_t>(c)];
        states[i] = 1;
        states[instances + i] = 0;
    }
}

}  // namespace

benchmark_case keller_miksis_cash_karp() {
    return {.name = "keller_miksis_cash_karp",
            .work =
                "4 phases tau in [0, 1], t and step restarted in each, tolerances 1e-10, one frequency f1 = "
                "geomspace(20 kHz, 1000 kHz, N) at 1.5 bar, start (1, 0), largest radius kept",
            .difference = "state after 1 phase (some instances are chaotic), against order 8 in long double at 1e-16",
            .allowed_difference = 1e-8,
            .tolerance = 1e-10,
            .event_tolerance = 0,
            .components = 2,
            .parameters = model::n_parameter,
            .instances = 1024,
            .phases = 4,
            .compared_phases = 1,
            .fill = fill,
            .reference = keller_miksis::run_reference,
            .implementations = {{"odeint", "odeint", keller_miksis::run_odeint},
                                {"loop", "loop", keller_miksis::run_loop},
                                {"myriad", "myriad", run<myriad::cash_karp>}},
            .at_equal_error = {
                .phases = 2,
                .contenders = {{"cvode_adams", "cvode", keller_miksis::run_cvode},
                               {"odeint", "odeint", keller_miksis::run_odeint},
                               {"cash_karp", "myriad", run<myriad::cash_karp>},
                               {"verner_7", "myriad", if_compiled<myriad::verner_7, model>(run<myriad::verner_7>)},
                               {"dormand_prince_8 pi", "myriad",
                                if_compiled<dormand_prince_8_pi, model>(run<dormand_prince_8_pi>)}}}};
}

}  // namespace cpu_peers
