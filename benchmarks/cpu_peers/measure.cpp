// SPDX-License-Identifier: MIT
// Times the implementations of a case in turns, so that a disturbance affects all of them, and compares them within
// each turn. In CPU time, as on shared cores wall time mostly shows how busy the others are.
#include "measure.hpp"

#include <algorithm>

#include "fma_rate.hpp"
#include "sweep_data.hpp"

namespace cpu_peers {
namespace {

/// For every repetition of one implementation.
struct times {
    std::vector<double> cpu, wall;  // milliseconds
};

std::vector<double> quotients(const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> result = a;
    for (std::size_t i = 0; i < result.size(); ++i) result[i] /= b[i];
    return result;
}

}  // namespace

std::int64_t instances_of(const benchmark_case& what, const measure_options& options) {
    if (options.instances > 0) return options.instances;
    return std::max(static_cast<std::int64_t>(options.instances_scale * static_cast<double>(what.instances)),
                    std::int64_t{1});
}

std::vector<measurement> measure(const benchmark_case& what, const measure_options& options) {
    std::vector<implementation> chosen;
    for (const implementation& i : what.implementations) {
        const auto& wanted = options.implementations;
        if (wanted.empty() || std::find(wanted.begin(), wanted.end(), i.group) != wanted.end()) chosen.push_back(i);
    }
    std::vector<measurement> results(chosen.size());
    if (chosen.empty()) return results;
    reference_results reference(what, what.compared_phases, options.threads);
    const bool counts_instructions =
        std::any_of(chosen.begin(), chosen.end(), [](const auto& i) { return i.instructions_per_step > 0; });

    sweep_data data(what, instances_of(what, options), what.phases, options.threads);
    std::vector<times> taken(chosen.size());
    std::vector<double> fma_per_ms;
    for (int repetition = 0; repetition < options.repetitions + 1; ++repetition) {
        if (counts_instructions && repetition > 0) fma_per_ms.push_back(1e-3 * fma_rate(options.threads));
        for (std::size_t j = 0; j < chosen.size(); ++j) {
            const outcome o = data.run(chosen[j].run);
            if (repetition > 0) {
                taken[j].cpu.push_back(1e3 * o.cpu_seconds / options.threads);
                taken[j].wall.push_back(1e3 * o.wall_seconds);
                continue;
            }
            // The first repetition warms up and gives the counts.
            measurement& m = results[j];
            m.implementation = chosen[j].name;
            m.instances = data.work().instances;
            m.idle_share = o.idle_share;
            m.accepted_steps = data.accepted_steps();
            for (int e = 0; e < ending_count; ++e) m.by_ending[e] = data.count(static_cast<ending>(e));
        }
    }
    const auto odeint = std::find_if(chosen.begin(), chosen.end(), [](const auto& i) { return i.name == "odeint"; });
    for (std::size_t j = 0; j < chosen.size(); ++j) {
        measurement& m = results[j];
        const auto difference = reference.to(chosen[j].run, what.tolerance, what.event_tolerance);
        m.difference = difference.largest;
        m.median_difference = difference.median;
        m.compared = difference.compared;
        m.milliseconds = median(taken[j].cpu);
        m.wall_milliseconds = *std::min_element(taken[j].wall.begin(), taken[j].wall.end());
        if (odeint != chosen.end())
            m.ratio_to_odeint =
                median(quotients(taken[static_cast<std::size_t>(odeint - chosen.begin())].cpu, taken[j].cpu));
        if (chosen[j].instructions_per_step > 0) {
            const double issued = chosen[j].instructions_per_step * static_cast<double>(m.accepted_steps) /
                                  (fma_lanes() * options.threads);
            std::vector<double> milliseconds_of_fma = fma_per_ms;
            for (double& rate : milliseconds_of_fma) rate = issued / rate;
            m.fma_per_nanosecond = 1e-6 * median(fma_per_ms);
            m.fma_peak_share = median(quotients(milliseconds_of_fma, taken[j].cpu));
        }
    }
    return results;
}

double ratio_of_times(const benchmark_case& what, std::int64_t instances, implementation_function one,
                      implementation_function other, int pairs) {
    sweep_data data(what, instances, what.phases, 1);
    std::vector<double> ratios;
    for (int i = 0; i < pairs + 1; ++i) {
        const double first = data.run(one).cpu_seconds;
        const double ratio = first / data.run(other).cpu_seconds;
        if (i > 0) ratios.push_back(ratio);  // the first pair warms up
    }
    return median(ratios);
}

}  // namespace cpu_peers
