// SPDX-License-Identifier: MIT
// Heat conduction around a bubble whose wall liquid crosses, steadily or to and fro, over the liquid's diffusivity.
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <myriad/myriad.hpp>

#include "../common/csv_file.hpp"
#include "../common/grid.hpp"
#include "../common/integrate.hpp"
#include "heat_conduction.hpp"
#include "shell.hpp"

namespace {

constexpr double diffusivity_first = 0.05, diffusivity_last = 2, tolerance = 1e-7;
constexpr int depths = 33;  // at which temperatures are written
// The flows of liquid: instance i has number i % 4.
constexpr std::array<double, 4> through{0.5, -0.5, 0, 0}, pulse{0, 0, 0.5, 1};

int points = 24;
myriad::shared_placement placement = myriad::shared_placement::automatic;

template <class Model>
myriad::ensemble<Model> prepare(std::int64_t instances) {
    const Eigen::ArrayXd diffusivity = examples::logspace(diffusivity_first, diffusivity_last, (instances + 3) / 4);
    const Eigen::ArrayXd start = shell::still_temperature(chebyshev::points(1, shell::outer, Model::inner + 2));
    // snippet: ensemble
    myriad::ensemble<Model> sweep(instances);
    const Eigen::ArrayXd shared = shell::shared_values<Model::inner + 2>(1);
    for (int s = 0; s < Model::n_shared; ++s) sweep.shared(s) = shared[s];
    // end of snippet
    for (int c = 0; c < Model::inner; ++c) sweep.state(Model::temperature + c) = start[c + 1];
    sweep.state(Model::heat) = 0;
    for (std::int64_t i = 0; i < instances; ++i) {
        sweep.parameter(Model::diffusivity)[i] = diffusivity[i / 4];
        sweep.parameter(Model::through)[i] = through[static_cast<std::size_t>(i % 4)];
        sweep.parameter(Model::pulse)[i] = pulse[static_cast<std::size_t>(i % 4)];
    }
    sweep.time_domain(0, 1.0 / Model::phases_per_period);
    return sweep;
}

template <class Model>
void write(examples::csv_file& file, const myriad::ensemble<Model>& sweep,
           const myriad::phase_records<Model, double>& recorded, std::int64_t transient) {
    using myriad::message;
    file.comment("dT/dt + u dT/dr = a / r^2 d/dr(r^2 dT/dr), u = (through + pulse cos 2 pi t) / r^2, T(1) = 1, "
                 "T(outer) = 0; unit of length: the bubble's radius; of time: the period; of T: that of the wall");
    file.comment(message("outer = ", shell::outer, ", ", points, " Chebyshev points, a = diffusivity = logspace(",
                         diffusivity_first, ", ", diffusivity_last, ", ", (sweep.size() + 3) / 4, ")"));
    file.comment(message("phases of 1/", Model::phases_per_period, " period: ", transient, " transient, ",
                         recorded.phases(), " recorded; Myriad " MYRIAD_VERSION
                         ", method tsitouras_5, relative and absolute tolerance ", tolerance));
    for (const char* line :
         {"One row per instance, for the end of its last phase, and one for each recorded phase of the instances with the "
          "first, middle and last diffusivity.",
          "heat_flow: conducted from the wall into the liquid in this phase over its length, mean_heat_flow: in all "
          "recorded phases, both over 4 pi conductivity T(1);"})
        file.comment(line);
    file.comment(message("T_k: temperature at r = 1 + (outer - 1) (k / ", depths - 1, ")^2; status: of the last phase"));
    std::string header = "instance,phase,t,diffusivity,through,pulse,mean_heat_flow,heat_flow";
    for (int k = 0; k < depths; ++k) header += message(",T_", k);
    file.row(header + ",status");

    const Eigen::ArrayXd r = chebyshev::points(1, shell::outer, Model::inner + 2);
    const Eigen::ArrayXd depth = Eigen::ArrayXd::LinSpaced(depths, 0, 1);
    const Eigen::MatrixXd P = chebyshev::interpolation_matrix(r, 1 + (shell::outer - 1) * depth * depth);
    const Eigen::ArrayXXd heat = recorded.state(Model::heat) * double{Model::phases_per_period};
    const std::int64_t last_of_all = (sweep.size() - 1) / 4;
    Eigen::VectorXd T = Eigen::VectorXd::Zero(r.size());
    T[0] = 1;
    for (std::int64_t i = 0; i < sweep.size(); ++i) {
        const bool shown = i / 4 == 0 || i / 4 == last_of_all / 2 || i / 4 == last_of_all;
        for (std::int64_t k = shown ? 0 : recorded.phases() - 1; k < recorded.phases(); ++k) {
            for (int c = 0; c < Model::inner; ++c) T[c + 1] = recorded.state(Model::temperature + c)(i, k);
            const Eigen::VectorXf written = (P * T).cast<float>();
            std::string profile;
            for (const float value : written) profile += message(value, ',');
            file.row(i, transient + k, static_cast<double>(transient + k + 1) / Model::phases_per_period,
                     sweep.parameter(Model::diffusivity)[i], sweep.parameter(Model::through)[i],
                     sweep.parameter(Model::pulse)[i], heat.row(i).mean(), heat(i, k),
                     profile + myriad::name_of(sweep.status(i)));
        }
    }
    file.commit();
}

template <class Model>
int run(const examples::sweep_options& chosen, const myriad::device& device) {
    examples::csv_file file(chosen.output, 200 * static_cast<std::uintmax_t>(chosen.instances));
    auto sweep = prepare<Model>(chosen.instances);
    std::vector<int> states;
    for (int c = 0; c < Model::n_state; ++c) states.push_back(c);
    // snippet: solve
    const auto report = examples::integrate<myriad::tsitouras_5>(
        chosen, device, sweep,
        {.phases = chosen.transient + chosen.phases,
         .relative_tolerance = tolerance,
         .absolute_tolerance = tolerance,
         .phase_step = myriad::phase_step::carry_on,
         .record = {.from_phase = chosen.transient, .states = states},
         .shared_placement = placement});
    // end of snippet
    write(file, sweep, report.records, chosen.transient);
    return examples::conclude(chosen, report);
}

}  // namespace

int main(int argc, char** argv) {
    using myriad::shared_placement;
    const std::map<std::string, shared_placement> places{{"automatic", shared_placement::automatic},
                                                         {"constant", shared_placement::constant_bank},
                                                         {"shared", shared_placement::shared_memory},
                                                         {"cache", shared_placement::cache}};
    const auto add_options = [&](CLI::App& app) {
        app.add_option("--points", points, "Chebyshev points: 24 or 77")->check(CLI::IsMember({24, 77}).description(""))->capture_default_str();
        app.add_option("--shared-placement", placement, "Where a GPU keeps the matrix: automatic, constant, shared or cache")
            ->transform(CLI::CheckedTransformer(places).description(""))
            ->type_name("PLACE")
            ->default_str("automatic");
    };
    return examples::run_sweep(argc, argv,
                               {.description = "Heat conduction around a bubble over the diffusivity of the liquid",
                                .full = {.instances = 16384, .transient = 48 * 16, .phases = 16},
                                .small = {.instances = 64, .transient = 16 * 16, .phases = 16},
                                .output = "results/heat_conduction.csv",
                                .phases_help = "Phases to record after the transient ones, sixteen to a period",
                                .add_options = add_options},
                               [](const auto& chosen, const auto& device) {
                                   return points == 24 ? run<heat_24>(chosen, device) : run<heat_77>(chosen, device);
                               });
}
