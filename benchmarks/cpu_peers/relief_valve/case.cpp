// SPDX-License-Identifier: MIT
// The case relief_valve: its sweep, and Myriad's call.
#include <limits>

#include "../cases.hpp"
#include "../myriad_run.hpp"
#include "equations.hpp"
#include "model.hpp"

namespace cpu_peers {
namespace {

using dormand_prince_8_pi = myriad::controlled<myriad::dormand_prince_8, myriad::pi_control>;

namespace valve = relief_valve_case;

template <class Method>
outcome run(const sweep& work) {
    using model = relief_valve_model;
    return run_myriad<Method, model>(
        work,
        {.phases = work.phases,
         .relative_tolerance = work.tolerance,
         .absolute_tolerance = work.tolerance,
         .step = valve::first_step,
         .minimum_step = 1e-12,
         .maximum_step = 1e6,
         .max_steps = valve::most_steps,
         .events = {{.direction = myriad::direction::falling, .tolerance = work.event_tolerance, .stop_after = 1},
                    {.direction = myriad::direction::falling, .tolerance = work.event_tolerance}},
         .accumulation_limit = valve::accumulation_limit},
        [](auto& instances) {
            instances.shared(model::kappa) = valve::kappa;
            instances.shared(model::delta) = valve::delta;
            instances.shared(model::beta) = valve::beta;
            instances.shared(model::restitution) = valve::restitution;
            instances.shared(model::rest_band) = valve::rest_band;
            instances.time_domain(0, std::numeric_limits<double>::infinity());
        });
}

void fill(std::int64_t instances, double* parameters, double* states) {
    using column = Eigen::Map<Eigen::ArrayXd>;
    column(parameters, instances) = Eigen::ArrayXd::LinSpaced(instances, 0.2, 10);
    column(states, 3 * instances) = 0.0;
    column(states, instances) = 0.2;
}

}  // namespace

benchmark_case relief_valve() {
    return {.name = "relief_valve",
            .work =
                "64 phases from one fall of the velocity through zero to the next, step restarted in each, tolerances "
                "1e-10, of events 1e-6, impacts with restitution 0.8, q = linspace(0.2, 10, N), start (0.2, 0, 0)",
            .difference =
                "state after 4 phases of the instances that get so far (chaos amplifies what events leave open), "
                "against order 8 in long double at 1e-16 with events at 1e-15; the tolerance of events rules",
            .allowed_difference = 1e-4,
            .tolerance = 1e-10,
            .event_tolerance = 1e-6,
            .components = 3,
            .parameters = 1,
            .instances = 512,
            .phases = 64,
            .compared_phases = 4,
            .fill = fill,
            .reference = valve::run_reference,
            .implementations = {{"odeint", "odeint", valve::run_odeint},
                                {"loop", "loop", valve::run_loop},
                                {"myriad", "myriad", run<myriad::cash_karp>}},
            .at_equal_error = {
                .phases = 4,
                .contenders = {
                    {"cvode_adams", "cvode", valve::run_cvode},
                    {"odeint", "odeint", valve::run_odeint},
                    {"cash_karp", "myriad", run<myriad::cash_karp>},
                    {"verner_7", "myriad", if_compiled<myriad::verner_7, relief_valve_model>(run<myriad::verner_7>)},
                    {"dormand_prince_8 pi", "myriad",
                     if_compiled<dormand_prince_8_pi, relief_valve_model>(run<dormand_prince_8_pi>)}}}};
}

}  // namespace cpu_peers
