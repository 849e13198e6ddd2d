// SPDX-License-Identifier: MIT
// Integrates relief valves over many phases and checks that none passes its seat by more than ten event tolerances, and
// that those whose impacts do not accumulate have as many as CVODE finds. Exit status 0 if all is well, 1 if a check
// fails, 2 for bad arguments.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <string>

#include <CLI/CLI.hpp>
#include <myriad/myriad.hpp>

#include "oracle.hpp"
#include "sweep.hpp"

namespace {

namespace valves = relief_valve_sweep;
using myriad::status;

struct arguments {
    std::int64_t instances = 8192, phases = 64, compared = 256;
    std::string device = "auto";
};

/// No state below the seat, at any step of any phase.
bool check_seat(const arguments& chosen, const myriad::device& device) {
    auto sweep = valves::prepare(chosen.instances);
    const auto report = myriad::solve<myriad::cash_karp>(device, sweep, valves::integration(chosen.phases));
    std::cout << report;
    const auto lowest = sweep.accessory(relief_valve::y_lowest);
    // min() skips NaN, so compare such that NaN counts as wrong
    const auto through = chosen.instances - (lowest >= -10 * valves::event_tolerance).count();
    const auto unexpected = report.failed() - report.count(status::event_accumulation);
    std::cout << "lowest displacement " << lowest.minCoeff() << ", " << through
              << " instances below the seat by more than ten event tolerances\n"
              << report.count(status::event_accumulation) << " instances whose impacts accumulated, " << unexpected
              << " that failed otherwise; " << sweep.integer_accessory(relief_valve::impacts).cast<std::int64_t>().sum()
              << " impacts\n";
    return through == 0 && unexpected == 0;
}

/// Impacts by CVODE, phase by phase, for instances spread over q. Frequent impacts are followed by others that depend
/// on every bit; so CVODE runs twice, the second time with the seat raised by the event tolerance, which the tolerance
/// permits, and phases count as long as this makes little difference.
bool check_impacts(const arguments& chosen, const myriad::device& device) {
    auto sweep = valves::prepare(chosen.compared);
    auto options = valves::integration(chosen.phases);
    options.record = {.states = {relief_valve::y},
                      .integer_accessories = {relief_valve::impacts, relief_valve::steps_at_rest}};
    const auto report = myriad::solve<myriad::cash_karp>(device, sweep, options);
    const auto impacts = report.records.integer_accessory(relief_valve::impacts);
    const auto at_rest = report.records.integer_accessory(relief_valve::steps_at_rest);
    std::int64_t followed = 0, phases = 0, counted = 0, wrong = 0, whole = 0;
    for (std::int64_t i = 0; i < chosen.compared; ++i) {
        if (sweep.status(i) == status::event_accumulation) continue;
        ++followed;
        const double q = sweep.parameter(relief_valve::q)[i];
        const auto expected = follow_valve(q, static_cast<int>(chosen.phases), 0);
        const auto shifted = follow_valve(q, static_cast<int>(chosen.phases), valves::event_tolerance);
        const auto known = std::min(expected.impacts.size(), shifted.impacts.size());
        std::size_t k = 0;
        bool right = true;
        for (; k < known && right; ++k) {
            const auto phase = static_cast<Eigen::Index>(k);
            if (at_rest(i, phase) >= 50) break;  // maxima below the event tolerance, which CVODE still resolves
            if (expected.impacts[k] != shifted.impacts[k]) break;
            if (!(std::abs(expected.state[k][0] - shifted.state[k][0]) < 1e-3)) break;
            ++phases;
            right = impacts(i, phase) == expected.impacts[k];
            if (right) continue;
            std::cout << "instance " << i << " (q = " << q << ") has " << impacts(i, phase)
                      << " impacts by the end of phase " << k << ", CVODE " << expected.impacts[k] << '\n';
        }
        wrong += !right;
        whole += k == static_cast<std::size_t>(chosen.phases) ||
                 (k < known && at_rest(i, static_cast<Eigen::Index>(k)) >= 50);
        if (k > 0) counted += expected.impacts[k - 1];
    }
    std::cout << followed << " of " << chosen.compared << " instances do not accumulate; " << whole
              << " of them were compared with CVODE to the end, the others while they are well-conditioned: " << phases
              << " phases, " << counted << " impacts, " << wrong << " instances with another number\n";
    // a comparison of a few phases would prove nothing
    return wrong == 0 && phases >= 4 * followed && counted >= followed;
}

}  // namespace

int main(int argc, char** argv) {
    arguments chosen;
    CLI::App app("Relief valves: nothing goes through the seat, and impacts are those of CVODE");
    const auto add = [&app](const char* name, std::int64_t& count, std::int64_t least, const char* meaning) {
        app.add_option(name, count, meaning)
            ->check(CLI::Range(least, std::int64_t{10'000'000}).description(""))
            ->type_name("N")
            ->capture_default_str();
    };
    add("--instances", chosen.instances, 2, "Number of instances");
    add("--phases", chosen.phases, 1, "Phases, from one maximum of the displacement to the next");
    add("--compared", chosen.compared, 0, "Instances, spread over q, whose impacts are compared with CVODE's");
    app.add_option("--device", chosen.device, "Where to compute: auto, cpu or cpu:THREADS")
        ->type_name("NAME")
        ->capture_default_str();
    try {
        app.parse(argc, argv);
        const auto device = myriad::device::parse(chosen.device);
        const bool seat = check_seat(chosen, device);
        const bool impacts = chosen.compared == 0 || check_impacts(chosen, device);
        std::cout << (seat && impacts ? "All checks passed.\n" : "A check FAILED.\n");
        return seat && impacts ? 0 : 1;
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? 0 : 2;
    } catch (const std::exception& e) {
        std::cerr << e.what() << '\n';
        return 2;
    }
}
