// SPDX-License-Identifier: MIT
// The cases of the benchmark, as the host sees them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sweep.hpp"

namespace cpu_peers {

/// One way to integrate a case. `group` is what the option --implementations names.
struct implementation {
    std::string name, group;
    implementation_function run;
};

struct benchmark_case {
    std::string name;
    std::string work;        ///< what is integrated, for the header
    std::string difference;  ///< what max_difference compares
    double allowed_difference;
    int components, parameters;
    std::int64_t instances;
    int phases;
    int compared_phases;  ///< horizon of max_difference, short enough that no chaos amplifies rounding
    /// Fills in the parameters and the start of `instances` instances, evenly spread over the sweep's range.
    void (*fill)(std::int64_t instances, double* parameters, double* states);
    implementation_function reference;
    std::vector<implementation> implementations;
};

benchmark_case lorenz_rk4();
benchmark_case duffing_cash_karp();
benchmark_case keller_miksis_cash_karp();
benchmark_case relief_valve();

}  // namespace cpu_peers
