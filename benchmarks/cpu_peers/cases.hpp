// SPDX-License-Identifier: MIT
// The cases of the benchmark, as the host sees them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sweep.hpp"

namespace cpu_peers {

/// One way to integrate a case. `group` is the name for the option --implementations.
struct implementation {
    std::string name, group;
    implementation_function run;
    /// Floating-point instructions per step of one SIMD batch; 0: not counted.
    double instructions_per_step = 0;
};

/// A comparison at equal achieved error: the lowest cost for a given median error.
struct contest {
    int phases = 0;  ///< horizon: short, since chaos lets errors grow until they tell nothing of the method
    /// Others are compared with the first. One whose function is null was not built.
    std::vector<implementation> contenders = {};
};

struct benchmark_case {
    std::string name;
    std::string work;        ///< description of the work, for the header
    std::string difference;  ///< quantities compared by max_difference
    double allowed_difference;
    double tolerance, event_tolerance;  ///< for the table of times
    int components, parameters;
    std::int64_t instances;
    int phases;
    int compared_phases;  ///< horizon of max_difference, short enough that no chaos amplifies rounding
    /// Sets the parameters and the start of `instances` instances, evenly spread over the sweep's range.
    void (*fill)(std::int64_t instances, double* parameters, double* states);
    implementation_function reference;
    std::vector<implementation> implementations;
    contest at_equal_error = {};
};

benchmark_case lorenz_rk4();
benchmark_case duffing_cash_karp();
benchmark_case keller_miksis_cash_karp();
benchmark_case relief_valve();
template <int states>
benchmark_case lorenz96_case();

}  // namespace cpu_peers
