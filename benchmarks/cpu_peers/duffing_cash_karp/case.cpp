// SPDX-License-Identifier: MIT
// The case duffing_cash_karp: its sweep, and Myriad's call.
#include "../cases.hpp"
#include "../myriad_run.hpp"
#include "equations.hpp"
#include "model.hpp"

namespace cpu_peers {
namespace {

using dormand_prince_8_pi = myriad::controlled<myriad::dormand_prince_8, myriad::pi_control>;

template <class Method>
outcome run(const sweep& work) {
    return run_myriad<Method, duffing_model>(work,
                                             {.phases = work.phases,
                                              .relative_tolerance = work.tolerance,
                                              .absolute_tolerance = work.tolerance,
                                              .step = duffing::first_step,
                                              .minimum_step = 1e-12,
                                              .maximum_step = 1e6},
                                             [](auto& instances) {
                                                 instances.shared(duffing_model::B) = duffing::B;
                                                 instances.time_domain(0, duffing::period);
                                             });
}

void fill(std::int64_t instances, double* parameters, double* states) {
    using column = Eigen::Map<Eigen::ArrayXd>;
    column(parameters, instances) = Eigen::ArrayXd::LinSpaced(instances, 0.2, 0.3);
    column(states, instances) = -0.5;
    column(states + instances, instances) = -0.1;
}

}  // namespace

benchmark_case duffing_cash_karp() {
    return {
        .name = "duffing_cash_karp",
        .work =
            "64 periods of the forcing, t and step restarted in each, tolerances 1e-9, "
            "k = linspace(0.2, 0.3, N), B = 0.3, start (-0.5, -0.1)",
        .difference = "state after 2 periods (many instances are chaotic), against order 8 in long double at 1e-16",
        .allowed_difference = 1e-7,
        .tolerance = 1e-9,
        .event_tolerance = 0,
        .components = 2,
        .parameters = 1,
        .instances = 1024,
        .phases = 64,
        .compared_phases = 2,
        .fill = fill,
        .reference = duffing::run_reference,
        .implementations = {{"odeint", "odeint", duffing::run_odeint},
                            {"loop", "loop", duffing::run_loop},
                            {"myriad", "myriad", run<myriad::cash_karp>}},
        .at_equal_error = {
            .phases = 8,
            .contenders = {{"cvode_adams", "cvode", duffing::run_cvode},
                           {"odeint", "odeint", duffing::run_odeint},
                           {"cash_karp", "myriad", run<myriad::cash_karp>},
                           {"verner_7", "myriad", if_compiled<myriad::verner_7, duffing_model>(run<myriad::verner_7>)},
                           {"dormand_prince_8 pi", "myriad",
                            if_compiled<dormand_prince_8_pi, duffing_model>(run<dormand_prince_8_pi>)}}}};
}

}  // namespace cpu_peers
