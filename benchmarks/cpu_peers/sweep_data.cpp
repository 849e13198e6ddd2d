// SPDX-License-Identifier: MIT
// Runs implementations on the arrays of a sweep, and compares their results with the reference's.
#include "sweep_data.hpp"

#include <algorithm>
#include <cmath>

namespace cpu_peers {
namespace {

// Enough to cover a sweep's range, few enough for long double.
constexpr std::int64_t compared_instances = 64;

std::size_t size(int components, std::int64_t instances) {
    return static_cast<std::size_t>(components) * static_cast<std::size_t>(instances);
}

}  // namespace

sweep_data::sweep_data(const benchmark_case& what, std::int64_t instances, int phases, int threads)
    : start_(size(what.components, instances)), parameters_(size(what.parameters, instances)), states_(start_.size()),
      accepted_(size(1, instances)), endings_(size(1, instances)),
      sweep_{instances,          phases,         threads,          what.tolerance, what.event_tolerance,
             parameters_.data(), states_.data(), accepted_.data(), endings_.data()} {
    what.fill(instances, parameters_.data(), start_.data());
}

outcome sweep_data::run(implementation_function how) {
    states_ = start_;
    std::fill(endings_.begin(), endings_.end(), ending::failed);
    return how(sweep_);
}

void sweep_data::set_tolerances(double tolerance, double event_tolerance) {
    sweep_.tolerance = tolerance;
    sweep_.event_tolerance = event_tolerance;
}

std::int64_t sweep_data::accepted_steps() const {
    std::int64_t sum = 0;
    for (const std::int64_t n : accepted_) sum += n;
    return sum;
}

std::int64_t sweep_data::count(ending which) const { return std::count(endings_.begin(), endings_.end(), which); }

reference_results::reference_results(const benchmark_case& what, int phases, int threads)
    : components_(what.components), data_(what, compared_instances, phases, threads) {
    data_.run(what.reference);
    states_.assign(data_.work().states, data_.work().states + size(components_, compared_instances));
    endings_.assign(data_.work().endings, data_.work().endings + compared_instances);
}

reference_results::difference reference_results::to(implementation_function how, double tolerance,
                                                    double event_tolerance) {
    data_.set_tolerances(tolerance, event_tolerance);
    data_.run(how);
    std::vector<double> worst;
    for (std::size_t i = 0; i < compared_instances; ++i) {
        if (endings_[i] != ending::completed || data_.work().endings[i] != ending::completed) continue;
        double largest = 0;
        for (std::size_t c = 0; c < static_cast<std::size_t>(components_); ++c) {
            const std::size_t at = c * compared_instances + i;
            const double difference =
                std::fabs(data_.work().states[at] - states_[at]) / std::fmax(1, std::fabs(states_[at]));
            largest = std::isnan(difference) ? HUGE_VAL : std::fmax(largest, difference);  // NaN cannot be sorted
        }
        worst.push_back(largest);
    }
    if (worst.empty()) return {};
    const double largest = *std::max_element(worst.begin(), worst.end());
    const auto compared = static_cast<std::int64_t>(worst.size());
    return {largest, median(std::move(worst)), compared};
}

double median(std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
    return values[values.size() / 2];
}

}  // namespace cpu_peers
