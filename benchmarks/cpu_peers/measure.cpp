// SPDX-License-Identifier: MIT
// Times the implementations of a case in turns, so that a disturbance meets all of them, and compares them within each
// turn. CPU time and not the clock on the wall, which on shared cores shows above all how busy the others are.
#include "measure.hpp"

#include <algorithm>
#include <cmath>

namespace cpu_peers {
namespace {

/// The arrays of one sweep, with room for the results of one run.
class sweep_data {
public:
    sweep_data(const benchmark_case& what, std::int64_t instances, int phases, int threads)
        : start_(size(what.components, instances)), parameters_(size(what.parameters, instances)),
          states_(start_.size()), accepted_(size(1, instances)),
          endings_(size(1, instances)), sweep_{instances,      phases,           threads,        parameters_.data(),
                                               states_.data(), accepted_.data(), endings_.data()} {
        what.fill(instances, parameters_.data(), start_.data());
    }

    outcome run(implementation_function how) {
        states_ = start_;
        std::fill(endings_.begin(), endings_.end(), ending::failed);
        return how(sweep_);
    }
    const std::vector<double>& states() const { return states_; }
    const std::vector<std::int64_t>& accepted() const { return accepted_; }
    const std::vector<ending>& endings() const { return endings_; }

private:
    static std::size_t size(int components, std::int64_t instances) {
        return static_cast<std::size_t>(components) * static_cast<std::size_t>(instances);
    }

    std::vector<double> start_, parameters_, states_;
    std::vector<std::int64_t> accepted_;
    std::vector<ending> endings_;
    sweep sweep_;
};

// Enough to cover a sweep's range, few enough for long double.
constexpr std::int64_t compared_instances = 64;

void compare(const benchmark_case& what, const std::vector<implementation>& chosen, int threads,
             std::vector<measurement>& results) {
    sweep_data data(what, compared_instances, what.compared_phases, threads);
    data.run(what.reference);
    const std::vector<double> reference = data.states();
    const std::vector<ending> reference_endings = data.endings();
    for (std::size_t j = 0; j < chosen.size(); ++j) {
        data.run(chosen[j].run);
        double largest = 0;
        for (std::size_t i = 0; i < compared_instances; ++i) {
            if (reference_endings[i] != ending::completed || data.endings()[i] != ending::completed) continue;
            ++results[j].compared;
            for (std::size_t c = 0; c < static_cast<std::size_t>(what.components); ++c) {
                const std::size_t at = c * compared_instances + i;
                const double difference =
                    std::fabs(data.states()[at] - reference[at]) / std::fmax(1, std::fabs(reference[at]));
                if (!(difference <= largest) && !std::isnan(largest)) largest = difference;  // NaN stays
            }
        }
        results[j].difference = largest;
    }
}

double median(std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
    return values[values.size() / 2];
}

}  // namespace

std::vector<measurement> measure(const benchmark_case& what, const measure_options& options) {
    std::vector<implementation> chosen;
    for (const implementation& i : what.implementations) {
        const auto& wanted = options.implementations;
        if (wanted.empty() || std::find(wanted.begin(), wanted.end(), i.group) != wanted.end()) chosen.push_back(i);
    }
    std::vector<measurement> results(chosen.size());
    if (chosen.empty()) return results;
    compare(what, chosen, options.threads, results);

    const auto instances = std::max(
        static_cast<std::int64_t>(options.instances_scale * static_cast<double>(what.instances)), std::int64_t{1});
    sweep_data data(what, instances, what.phases, options.threads);
    std::vector<std::vector<double>> milliseconds(chosen.size());
    for (int repetition = 0; repetition < options.repetitions + 1; ++repetition) {
        for (std::size_t j = 0; j < chosen.size(); ++j) {
            const outcome o = data.run(chosen[j].run);
            if (repetition > 0) {
                milliseconds[j].push_back(1e3 * o.cpu_seconds / options.threads);
                continue;
            }
            // The first one warms up, and says what was done.
            measurement& m = results[j];
            m.implementation = chosen[j].name;
            m.instances = instances;
            m.idle_share = o.idle_share;
            for (const std::int64_t n : data.accepted()) m.accepted_steps += n;
            for (const ending e : data.endings()) ++m.by_ending[static_cast<int>(e)];
        }
    }
    const auto odeint = std::find_if(chosen.begin(), chosen.end(), [](const auto& i) { return i.name == "odeint"; });
    for (std::size_t j = 0; j < chosen.size(); ++j) {
        results[j].milliseconds = median(milliseconds[j]);
        if (odeint == chosen.end()) continue;
        std::vector<double> ratios = milliseconds[static_cast<std::size_t>(odeint - chosen.begin())];
        for (std::size_t r = 0; r < ratios.size(); ++r) ratios[r] /= milliseconds[j][r];
        results[j].ratio_to_odeint = median(ratios);
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
