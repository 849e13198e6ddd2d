// SPDX-License-Identifier: MIT
// Compares methods at equal achieved error: times each at several tolerances and derives the time for a given error.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "measure.hpp"

namespace cpu_peers {

/// One contender at one tolerance.
struct contest_point {
    double tolerance = 0;
    double milliseconds = 0;  ///< CPU time over threads, median of the repetitions
    double wall_milliseconds = 0;
    double median_difference = 0, largest_difference = 0;
    std::int64_t accepted_steps = 0;
    double idle_share = 0;
};
struct contest_result {
    std::string contender;
    std::vector<contest_point> points;  ///< from the coarsest tolerance to the finest
};

/// Times all contenders in turn, tolerance by tolerance; those that were not built are skipped.
std::vector<contest_result> hold_contest(const benchmark_case& what, const measure_options& options);

/// The time for a median error no larger than `error`: at the coarsest tolerance if its error is small enough, else
/// interpolated log-log between two measured points; 0 if it was not reached.
double milliseconds_at(const contest_result& of, double error);

}  // namespace cpu_peers
