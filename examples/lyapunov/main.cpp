// SPDX-License-Identifier: MIT
// The Lyapunov spectrum of Lorenz' equations over rho, the Rayleigh number.
#include <cstdint>

#include <myriad/myriad.hpp>

#include "../common/csv_file.hpp"
#include "../common/integrate.hpp"
#include "../common/phases.hpp"
#include "lorenz.hpp"

namespace {

constexpr double rho_first = 0, rho_last = 250, sigma_of_all = 10, beta_of_all = 8.0 / 3;
constexpr double tolerance = 1e-8, phase_length = 0.25;

myriad::ensemble<lorenz_spectrum> prepare(std::int64_t instances, std::int64_t transient) {
    // snippet: ensemble
    myriad::ensemble<lorenz_spectrum> sweep(instances);
    sweep.parameter(lorenz::rho).setLinSpaced(rho_first, rho_last);
    sweep.shared(lorenz::sigma) = sigma_of_all;
    sweep.shared(lorenz::beta) = beta_of_all;
    for (const auto c : {lorenz::x, lorenz::y, lorenz::z}) sweep.state(c) = 1;
    myriad::initial_tangents(sweep);
    sweep.shared_integer(lorenz_spectrum::transient_phases) = static_cast<std::int32_t>(transient);
    sweep.time_domain(0, phase_length);
    // end of snippet
    return sweep;
}

// Nothing here depends on the time, machine or number of threads: equal results give equal files.
void write(examples::csv_file& file, const myriad::ensemble<lorenz_spectrum>& sweep, std::int64_t transient,
           std::int64_t summed) {
    using myriad::message;
    // snippet: exponents
    const Eigen::ArrayXXd lambda = myriad::exponents(sweep);  // one row per instance, the largest exponent first
    // end of snippet
    file.comment(
        "Lyapunov exponents of x' = sigma (y - x), y' = x (rho - z) - y, z' = x y - beta z, per unit of time, "
        "natural logarithm");
    file.comment(message("rho = linspace(", rho_first, ", ", rho_last, ", ", sweep.size(), "), sigma = ", sigma_of_all,
                         ", beta = ", beta_of_all, ", x(0) = y(0) = z(0) = 1"));
    file.comment(message("phases of length ", phase_length, ": ", transient, " transient, ", summed, " summed"));
    file.comment(message("Myriad " MYRIAD_VERSION ", method tsitouras_5, relative and absolute tolerance ", tolerance));
    file.row("instance", "rho", "lambda_1", "lambda_2", "lambda_3", "status");
    for (std::int64_t i = 0; i < sweep.size(); ++i)
        file.row(i, sweep.parameter(lorenz::rho)[i], lambda(i, 0), lambda(i, 1), lambda(i, 2),
                 myriad::name_of(sweep.status(i)));
    file.commit();
}

int run(const examples::sweep_options& chosen, const myriad::device& device) {
    const auto rows = static_cast<std::uintmax_t>(chosen.instances);
    examples::csv_file file(chosen.output, 40 * rows);  // the shortest rows have about 60 characters
    auto sweep = prepare(chosen.instances, chosen.transient);
    const auto report = examples::integrate<myriad::tsitouras_5>(
        chosen, device, sweep, examples::smooth_phases(chosen.transient + chosen.phases, tolerance));
    write(file, sweep, chosen.transient, chosen.phases);
    return examples::conclude(chosen, report);
}

}  // namespace

int main(int argc, char** argv) {
    return examples::run_sweep(argc, argv,
                               {.description = "Lyapunov spectrum of Lorenz' equations over rho",
                                .full = {.instances = 2000, .transient = 400, .phases = 2000},
                                .small = {.instances = 200, .transient = 100, .phases = 200},
                                .output = "results/lyapunov.csv",
                                .phases_help = "Phases to sum after the transient ones"},
                               run);
}
