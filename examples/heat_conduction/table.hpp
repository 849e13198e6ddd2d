// SPDX-License-Identifier: MIT
// The table of heat flows and temperatures.
#pragma once

#include <cstdint>
#include <string>

#include <myriad/myriad.hpp>

#include "../common/csv_file.hpp"
#include "shell.hpp"

namespace shell {

constexpr int depths = 33;  // number of depths in the table

/// One row per instance at the end of its last phase, and one per recorded phase for the instances with the first,
/// middle and last diffusivity.
template <class Model>
void write_table(examples::csv_file& file, const myriad::ensemble<Model>& sweep,
                 const myriad::phase_records<Model, double>& recorded, std::int64_t transient) {
    using myriad::message;
    file.comment(
        "dT/dt + u dT/dr = a / r^2 d/dr(r^2 dT/dr), u = (through + pulse cos 2 pi t) / r^2, T(1) = 1, "
        "T(outer) = 0; unit of length: the bubble's radius; of time: the period; of T: that of the wall");
    file.comment(message("outer = ", outer, "; phases of 1/", Model::phases_per_period, " period: ", transient,
                         " transient, ", recorded.phases(), " recorded; instances by diffusivity a, with ", flows,
                         " flows of liquid each"));
    file.comment(
        "One row per instance, for the end of its last phase, and one for each recorded phase of the instances with "
        "the first, middle and last diffusivity");
    file.comment(
        "heat_flow: conducted from the wall into the liquid in this phase over its length, mean_heat_flow: in all "
        "recorded phases; both over 4 pi conductivity T(1)");
    file.comment(
        message("T_k: temperature at r = 1 + (outer - 1) (k / ", depths - 1, ")^2; status: of the last phase"));
    std::string header = "instance,phase,t,diffusivity,through,pulse,mean_heat_flow,heat_flow";
    for (int k = 0; k < depths; ++k) header += message(",T_", k);
    file.row(header + ",status");

    const Eigen::ArrayXd r = chebyshev::points(1, outer, Model::inner + 2);
    const Eigen::ArrayXd depth = Eigen::ArrayXd::LinSpaced(depths, 0, 1);
    const Eigen::MatrixXd P = chebyshev::interpolation_matrix(r, 1 + (outer - 1) * depth * depth);
    const Eigen::ArrayXXd heat = recorded.state(Model::heat) * double{Model::phases_per_period};
    const std::int64_t last_of_all = (sweep.size() - 1) / flows;
    Eigen::VectorXd T = Eigen::VectorXd::Zero(r.size());
    T[0] = 1;
    for (std::int64_t i = 0; i < sweep.size(); ++i) {
        const bool shown = i / flows == 0 || i / flows == last_of_all / 2 || i / flows == last_of_all;
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

}  // namespace shell
