// SPDX-License-Identifier: MIT
// The largest Lyapunov exponent of the forced Duffing oscillator over its damping k and forcing B, with the tangent
// linearised by hand and by the library. A row of the table is a point of the plane.
#include <algorithm>
#include <cstdint>

#include <myriad/myriad.hpp>

#include "../common/csv_file.hpp"
#include "../common/grid.hpp"
#include "../common/integrate.hpp"
#include "../common/phases.hpp"
#include "sweep.hpp"

namespace {

using namespace lyapunov_map;

myriad::ensemble<library_tangent> plane(std::int64_t side, std::int64_t transient) {
    auto sweep = by_library(side * side, transient);
    // snippet: plane
    examples::fill_plane(sweep.parameter(forced_duffing::k), examples::linspace(k_first, k_last, side),
                         sweep.parameter(forced_duffing::B), examples::linspace(B_first, B_last, side));
    // end of snippet
    return sweep;
}

// Nothing here depends on the time, machine or number of threads: equal results give equal files.
void write(examples::csv_file& file, const examples::sweep_options& chosen, const myriad::ensemble<hand_tangent>& hand,
           const myriad::ensemble<library_tangent>& library) {
    using myriad::message;
    // snippet: exponents
    const Eigen::ArrayXd lambda_hand =
        hand.accessory(hand_tangent::growth) / (period * static_cast<double>(chosen.phases));
    const Eigen::ArrayXXd lambda_library = myriad::exponents(library);
    // end of snippet
    file.comment(
        "Largest Lyapunov exponent of x'' + k x' - x + x^3 = B cos t, per unit of time, natural logarithm; all "
        "quantities are dimensionless");
    file.comment(message("k = linspace(", k_first, ", ", k_last, ", ", chosen.instances, ") in rows, B = linspace(",
                         B_first, ", ", B_last, ", ", chosen.instances, "), x(0) = ", x_start, ", x'(0) = ", v_start));
    file.comment(message("periods of the forcing: ", chosen.transient, " transient, ", chosen.phases, " summed"));
    file.comment(
        message("Myriad " MYRIAD_VERSION ", method dormand_prince_8, relative and absolute tolerance ", tolerance));
    file.comment("lambda_hand: linearised by hand; lambda_library: with_tangents; status: that of the latter");
    file.row("k", "B", "lambda_hand", "lambda_library", "status");
    const auto k = library.parameter(forced_duffing::k), B = library.parameter(forced_duffing::B);
    for (std::int64_t i = 0; i < library.size(); ++i)
        file.row(k[i], B[i], lambda_hand[i], lambda_library(i, 0), myriad::name_of(library.status(i)));
    file.commit();
}

int run(const examples::sweep_options& chosen, const myriad::device& device) {
    const auto side = static_cast<std::uintmax_t>(chosen.instances);
    examples::csv_file file(chosen.output, 50 * side * side);
    const auto options = examples::smooth_phases(chosen.transient + chosen.phases, tolerance);
    auto library = plane(chosen.instances, chosen.transient);
    auto hand = by_hand(library, chosen.transient);
    const auto of_hand = examples::integrate<myriad::dormand_prince_8>(chosen, device, hand, options);
    const auto of_library = examples::integrate<myriad::dormand_prince_8>(chosen, device, library, options);
    write(file, chosen, hand, library);
    return std::max(examples::conclude(chosen, of_hand), examples::conclude(chosen, of_library));
}

}  // namespace

int main(int argc, char** argv) {
    return examples::run_sweep(
        argc, argv,
        {.description = "Largest Lyapunov exponent of the forced Duffing oscillator over a plane",
         .full = {.instances = 1024, .transient = 256, .phases = 512},
         .small = {.instances = 48, .transient = 64, .phases = 128},
         .output = "results/lyapunov_map.csv",
         .instances_help = "Values of k, and as many of B: a plane of N x N instances",
         .phases_help = "Periods to sum after the transient ones"},
        run);
}
