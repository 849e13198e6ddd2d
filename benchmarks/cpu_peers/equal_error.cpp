// SPDX-License-Identifier: MIT
// Times the contenders of a case at tolerances two powers of ten apart.
#include "equal_error.hpp"

#include <algorithm>
#include <cmath>

#include "sweep_data.hpp"

namespace cpu_peers {

std::vector<contest_result> hold_contest(const benchmark_case& what, const measure_options& options) {
    const contest& c = what.at_equal_error;
    reference_results reference(what, c.phases, options.threads);
    sweep_data data(what, instances_of(what, options), c.phases, options.threads);
    std::vector<contest_result> results;
    std::vector<implementation> built;
    for (const implementation& i : c.contenders) {
        if (i.run == nullptr) continue;
        built.push_back(i);
        results.push_back({i.name, {}});
    }
    for (const double tolerance : {1e-5, 1e-7, 1e-9, 1e-11, 1e-13}) {
        // The event tolerance follows that of steps, down to the limit set by the rounding of velocities around ten.
        const double event_tolerance = what.event_tolerance > 0 ? std::max(tolerance, 1e-13) : 0;
        data.set_tolerances(tolerance, event_tolerance);
        std::vector<std::vector<double>> cpu(built.size());
        for (std::size_t j = 0; j < built.size(); ++j) {
            const auto difference = reference.to(built[j].run, tolerance, event_tolerance);  // also warms up
            results[j].points.push_back({.tolerance = tolerance,
                                         .wall_milliseconds = HUGE_VAL,
                                         .median_difference = difference.median,
                                         .largest_difference = difference.largest});
        }
        for (int repetition = 0; repetition < options.repetitions; ++repetition)
            for (std::size_t j = 0; j < built.size(); ++j) {
                const outcome o = data.run(built[j].run);
                contest_point& p = results[j].points.back();
                cpu[j].push_back(1e3 * o.cpu_seconds / options.threads);
                p.wall_milliseconds = std::min(p.wall_milliseconds, 1e3 * o.wall_seconds);
                p.accepted_steps = data.accepted_steps();
                p.idle_share = o.idle_share;
            }
        for (std::size_t j = 0; j < built.size(); ++j) results[j].points.back().milliseconds = median(cpu[j]);
    }
    return results;
}

double milliseconds_at(const contest_result& of, double error) {
    const auto& points = of.points;
    if (points.front().median_difference <= error) return points.front().milliseconds;
    for (std::size_t i = 1; i < points.size(); ++i) {
        const double high = points[i - 1].median_difference, low = points[i].median_difference;
        if (!(low <= error && low < high)) continue;
        const double share = std::log(high / error) / std::log(high / low);
        return std::exp((1 - share) * std::log(points[i - 1].milliseconds) + share * std::log(points[i].milliseconds));
    }
    return 0;
}

}  // namespace cpu_peers
