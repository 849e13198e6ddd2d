// SPDX-License-Identifier: MIT
// Heat conduction around a bubble, with steady or oscillating flow of liquid through its wall, over the diffusivity.
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <myriad/myriad.hpp>

#include "../common/csv_file.hpp"
#include "../common/grid.hpp"
#include "../common/integrate.hpp"
#include "shell.hpp"
#include "table.hpp"

namespace {

constexpr double diffusivity_first = 0.05, diffusivity_last = 2;
constexpr double tolerance = 1e-7;
// The flows of liquid: instance i has number i % flows.
constexpr std::array<double, shell::flows> through{0.5, -0.5, 0, 0}, pulse{0, 0, 0.5, 1};

int points = 24;
std::string method = "tsitouras_5";
const std::map<std::string, myriad::shared_placement> placements{{"automatic", myriad::shared_placement::automatic},
                                                                 {"constant", myriad::shared_placement::constant_bank},
                                                                 {"shared", myriad::shared_placement::shared_memory},
                                                                 {"cache", myriad::shared_placement::cache}};
std::string placement = "automatic";

template <class Model>
myriad::ensemble<Model> prepare(std::int64_t instances) {
    const Eigen::ArrayXd diffusivity =
        examples::geomspace(diffusivity_first, diffusivity_last, (instances + shell::flows - 1) / shell::flows);
    const Eigen::ArrayXd start = shell::still_temperature(chebyshev::points(1, shell::outer, Model::inner + 2));
    // snippet: ensemble
    myriad::ensemble<Model> sweep(instances);
    const Eigen::ArrayXd shared = shell::shared_values<Model::inner + 2>(1);
    for (int s = 0; s < Model::n_shared; ++s) sweep.shared(s) = shared[s];
    // end of snippet
    for (int c = 0; c < Model::inner; ++c) sweep.state(Model::temperature + c) = start[c + 1];
    sweep.state(Model::heat) = 0;
    for (std::int64_t i = 0; i < instances; ++i) {
        sweep.parameter(Model::diffusivity)[i] = diffusivity[i / shell::flows];
        const auto flow = static_cast<std::size_t>(i % shell::flows);
        sweep.parameter(Model::through)[i] = through[flow];
        sweep.parameter(Model::pulse)[i] = pulse[flow];
    }
    sweep.time_domain(0, 1.0 / Model::phases_per_period);
    return sweep;
}

template <class Method, class Model>
int run(const examples::sweep_options& chosen, const myriad::device& device) {
    examples::csv_file file(chosen.output, 200 * static_cast<std::uintmax_t>(chosen.instances));
    auto sweep = prepare<Model>(chosen.instances);
    std::vector<int> states;
    for (int c = 0; c < Model::n_state; ++c) states.push_back(c);
    // snippet: solve
    const auto report = examples::integrate<Method>(chosen, device, sweep,
                                                    {.phases = chosen.transient + chosen.phases,
                                                     .relative_tolerance = tolerance,
                                                     .absolute_tolerance = tolerance,
                                                     .phase_step = myriad::phase_step::carry_on,
                                                     .record = {.from_phase = chosen.transient, .states = states},
                                                     .shared_placement = placements.at(placement)});
    // end of snippet
    file.comment(myriad::message("Myriad " MYRIAD_VERSION ", method ", method, ", relative and absolute tolerance ",
                                 tolerance, "; ", points, " Chebyshev points"));
    shell::write_table(file, sweep, report.records, chosen.transient);
    return examples::conclude(chosen, report);
}

}  // namespace

int main(int argc, char** argv) {
    using examples::own_option;
    return examples::run_sweep(
        argc, argv,
        {.description = "Heat conduction around a bubble over the diffusivity of the liquid",
         .full = {.instances = 16384, .transient = 32 * 16, .phases = 16},
         .small = {.instances = 64, .transient = 16 * 16, .phases = 16},
         .output = "results/heat_conduction.csv",
         .phases_help = "Phases to record after the transient ones, sixteen to a period",
         .options = {{"--points", &points, "Chebyshev points: 24 or 77", "N", own_option::names{"24", "77"}},
                     {"--method", &method, "tsitouras_5, or for 24 points rodas_5p, a stiff one", "NAME",
                      own_option::names{"tsitouras_5", "rodas_5p"}},
                     {"--shared-placement", &placement,
                      "Where a GPU keeps the matrix: automatic, constant, shared or cache", "PLACE",
                      examples::names_of(placements)}}},
        [](const auto& chosen, const auto& device) {
            using myriad::rodas_5p, myriad::tsitouras_5;
            if (method == "tsitouras_5")
                return points == 24 ? run<tsitouras_5, heat_24>(chosen, device)
                                    : run<tsitouras_5, heat_77>(chosen, device);
            myriad::require(points == 24,
                            "rodas_5p was compiled for 24 points only, as its Jacobians "
                            "of 77 points take long: leave --points out");
            return run<rodas_5p, heat_24>(chosen, device);
        });
}
