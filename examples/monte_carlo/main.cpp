// SPDX-License-Identifier: MIT
// A Monte Carlo study: how many are infectious at the peak of an epidemic with uncertain parameters, and when.
#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <myriad/myriad.hpp>

#include "../common/csv_file.hpp"
#include "../common/integrate.hpp"
#include "epidemic.hpp"
#include "peak.hpp"

namespace {

constexpr double R0_mean = 2.5, R0_deviation = 0.4, duration_least = 4, duration_most = 10;  // days
constexpr double i_start = 1e-4, s_start = 1 - i_start, last_day = 20'000, tolerance = 1e-9;

myriad::ensemble<epidemic> prepare(std::int64_t instances, std::int32_t seed) {
    myriad::ensemble<epidemic> sweep(instances);
    sweep.state(epidemic::s) = s_start;
    sweep.state(epidemic::i) = i_start;
    for (const auto c : {epidemic::R0, epidemic::duration}) sweep.parameter(c) = 0;  // the hook draws them
    sweep.shared(epidemic::R0_mean) = R0_mean;
    sweep.shared(epidemic::R0_deviation) = R0_deviation;
    sweep.shared(epidemic::duration_least) = duration_least;
    sweep.shared(epidemic::duration_most) = duration_most;
    sweep.shared_integer(epidemic::seed) = seed;
    sweep.time_domain(0, last_day);
    return sweep;
}

/// Number of instances whose parameters differ in any bit from those that the host draws.
std::int64_t drawn_differently(const myriad::ensemble<epidemic>& sweep, std::int32_t seed) {
    std::int64_t different = 0;
    // snippet: host
    for (std::int64_t i = 0; i < sweep.size(); ++i) {
        myriad::random_numbers<double> random(static_cast<std::uint64_t>(seed), i, 0);
        different += sweep.parameter(epidemic::R0)[i] != random.normal(R0_mean, R0_deviation) ||
                     sweep.parameter(epidemic::duration)[i] != random.uniform(duration_least, duration_most);
    }
    // end of snippet
    return different;
}

/// Estimates from the sample, and the exact values.
std::vector<std::string> findings(const myriad::ensemble<epidemic>& sweep, std::int32_t seed) {
    const Eigen::ArrayXd peaks = sweep.accessory(epidemic::peak);
    const peak_distribution exact{R0_mean, R0_deviation, s_start, i_start};
    std::vector<std::string> lines;
    const auto add = [&lines](const std::string& what, const estimate& e) {
        lines.push_back(myriad::message(what, ": found ", e.found, ", expected ", e.expected, ", ", e.deviation(),
                                        " standard deviations apart"));
    };
    add("mean of the peak", mean_of(peaks, exact));
    add("variance of the peak", variance_of(peaks, exact));
    for (const double p : {0.05, 0.5, 0.95, 0.99})
        add(myriad::message("share of peaks below ", exact.quantile(p)), share_below(peaks, exact, p));
    Eigen::ArrayXd errors(sweep.size());
    for (std::int64_t i = 0; i < sweep.size(); ++i)
        errors[i] = std::abs(peaks[i] - exact_peak(sweep.parameter(epidemic::R0)[i], s_start, i_start));
    const double worst = errors.maxCoeff<Eigen::PropagateNaN>();
    lines.push_back(myriad::message("largest error of a peak: ", worst));
    lines.push_back(myriad::message("parameters drawn differently by the host: ", drawn_differently(sweep, seed)));
    return lines;
}

void write(examples::csv_file& file, const myriad::ensemble<epidemic>& sweep, std::int32_t seed,
           const std::vector<std::string>& found) {
    using myriad::message;
    file.comment(
        "Epidemics with uncertain parameters, s' = -R0 s i / duration, i' = (R0 s - 1) i / duration: the largest "
        "share i of infectious people, and its day");
    file.comment(message("R0 normal, mean ", R0_mean, ", standard deviation ", R0_deviation, "; duration uniform from ",
                         duration_least, " to ", duration_most, " days; i(0) = ", i_start, ", s(0) = 1 - i(0)"));
    file.comment(message("Myriad " MYRIAD_VERSION ", Philox4x32-10 with seed ", seed,
                         ", method tsitouras_5, relative and absolute tolerance ", tolerance));
    for (const std::string& line : found) file.comment(line);
    file.row("instance", "R0", "duration", "peak", "day", "status");
    for (std::int64_t i = 0; i < sweep.size(); ++i)
        file.row(i, sweep.parameter(epidemic::R0)[i], sweep.parameter(epidemic::duration)[i],
                 sweep.accessory(epidemic::peak)[i], sweep.accessory(epidemic::day)[i],
                 myriad::name_of(sweep.status(i)));
    file.commit();
}

}  // namespace

int main(int argc, char** argv) {
    std::int32_t seed = 1;
    const auto run = [&seed](const examples::sweep_options& chosen, const myriad::device& device) {
        examples::csv_file file(chosen.output, 60 * static_cast<std::uintmax_t>(chosen.instances));
        auto sweep = prepare(chosen.instances, seed);
        const auto report = examples::integrate<myriad::tsitouras_5>(
            chosen, device, sweep,
            {.relative_tolerance = tolerance,
             .absolute_tolerance = tolerance,
             .events = {{.direction = myriad::direction::falling, .tolerance = 1e-9, .stop_after = 1}}});
        const auto found = findings(sweep, seed);
        if (!chosen.quiet)
            for (const std::string& line : found) std::cout << line << '\n';
        write(file, sweep, seed, found);
        return examples::conclude(chosen, report);
    };
    return examples::run_sweep(argc, argv,
                               {.description = "Monte Carlo study of an epidemic whose parameters are uncertain",
                                .full = {.instances = 1 << 20},
                                .small = {.instances = 1 << 14},
                                .output = "results/monte_carlo.csv",
                                .instances_help = "Number of epidemics to draw",
                                .has_transient = false,
                                .options = {{"--seed", &seed, "Key of the random numbers", "N"}}},
                               run);
}
