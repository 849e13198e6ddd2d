// SPDX-License-Identifier: MIT
// The arrays of one sweep over a case, and the differences of a run's results from the reference's.
#pragma once

#include <vector>

#include "cases.hpp"

namespace cpu_peers {

/// The arrays of one sweep, with room for the results of one run.
class sweep_data {
public:
    sweep_data(const benchmark_case& what, std::int64_t instances, int phases, int threads);

    outcome run(implementation_function how);
    /// For subsequent runs.
    void set_tolerances(double tolerance, double event_tolerance);
    const sweep& work() const { return sweep_; }
    std::int64_t accepted_steps() const;
    std::int64_t count(ending) const;

private:
    std::vector<double> start_, parameters_, states_;
    std::vector<std::int64_t> accepted_;
    std::vector<ending> endings_;
    sweep sweep_;
};

/// Results of instances spread over a sweep's range, with which other runs are compared.
class reference_results {
public:
    reference_results(const benchmark_case& what, int phases, int threads);

    /// Over instances that completed in both runs: the worst component's |difference| / max(1, |value|).
    struct difference {
        double largest = 0, median = 0;
        std::int64_t compared = 0;
    };
    /// The difference for `how` on the same instances at the given tolerances.
    difference to(implementation_function how, double tolerance, double event_tolerance);

private:
    int components_;
    sweep_data data_;
    std::vector<double> states_;
    std::vector<ending> endings_;
};

double median(std::vector<double> values);

}  // namespace cpu_peers
