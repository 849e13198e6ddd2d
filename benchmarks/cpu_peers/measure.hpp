// SPDX-License-Identifier: MIT
// Times the implementations of a case in turns and compares their results.
#pragma once

#include <string>
#include <vector>

#include "cases.hpp"

namespace cpu_peers {

struct measure_options {
    std::int64_t instances = 0;  ///< 0: the case's number times instances_scale
    double instances_scale = 1;
    int repetitions = 7;
    int threads = 1;
    /// Groups of implementations to run; empty: all.
    std::vector<std::string> implementations;
};

/// The results of one implementation on one case.
struct measurement {
    std::string implementation;
    std::int64_t instances = 0, accepted_steps = 0;
    std::int64_t by_ending[ending_count] = {};
    double milliseconds = 0;       ///< CPU time over threads, median of the repetitions
    double wall_milliseconds = 0;  ///< wall time, shortest of the repetitions
    /// Median over repetitions of odeint's time over this one's; 0 if odeint did not run.
    double ratio_to_odeint = 0;
    double idle_share = 0;
    /// Median over repetitions of the rate of floating-point instructions over that of fused multiply-adds; 0 if the
    /// instructions are not counted.
    double fma_peak_share = 0;
    double fma_per_nanosecond = 0;                 ///< that rate, for one core and batch; 0 if not measured
    double difference = 0, median_difference = 0;  ///< see benchmark_case::difference
    std::int64_t compared = 0;                     ///< number of instances compared
};

/// The number of instances requested by the options.
std::int64_t instances_of(const benchmark_case& what, const measure_options& options);

std::vector<measurement> measure(const benchmark_case& what, const measure_options& options);

/// Ratio of the CPU time of `one` to that of `other` on one thread: the median over pairs of consecutive runs, so that
/// anything that slows the core down affects both.
double ratio_of_times(const benchmark_case& what, std::int64_t instances, implementation_function one,
                      implementation_function other, int pairs);

}  // namespace cpu_peers
