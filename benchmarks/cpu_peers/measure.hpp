// SPDX-License-Identifier: MIT
// Times the implementations of a case in turns, compares their results, and checks what Myriad promises of its speed.
#pragma once

#include <string>
#include <vector>

#include "cases.hpp"

namespace cpu_peers {

struct measure_options {
    double instances_scale = 1;
    int repetitions = 7;
    int threads = 1;
    /// Groups of implementations to run; empty: all.
    std::vector<std::string> implementations;
};

/// What one implementation made of one case.
struct measurement {
    std::string implementation;
    std::int64_t instances = 0, accepted_steps = 0;
    std::int64_t by_ending[ending_count] = {};
    double milliseconds = 0;  ///< CPU time over threads, shortest of all repetitions
    double idle_share = 0;
    double difference = 0;      ///< largest, see benchmark_case::difference
    std::int64_t compared = 0;  ///< instances of which it is
};

std::vector<measurement> measure(const benchmark_case& what, const measure_options& options);

/// Prints one line for each promise; returns whether all are kept.
bool check_promises(bool against_odeint);

}  // namespace cpu_peers
