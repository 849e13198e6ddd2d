// SPDX-License-Identifier: MIT
// The library's LU factors behind plain arrays: declared for host files, which compare them with Eigen's; compiled in
// lu_lanes.cpp with the instruction-set flags, which Eigen must not see.
#pragma once

#include <cstddef>
#include <vector>

namespace lu_lanes {

enum class kind { one_double, one_float, pack_of_double, pack_of_float };

/// Systems of `n` equations, one in each lane: matrix[(lane * n + row) * n + column] and right[lane * n + row].
struct systems {
    int n = 0;
    std::vector<double> matrix, right;
};
struct solutions {
    std::vector<double> x;      // x[lane * n + row]
    std::vector<bool> regular;  // by lane
};

constexpr int largest_system = 32;
/// All unrolled sizes, the first rolled ones and a few more, as each takes time to compile; fewer in single precision.
constexpr bool is_compiled(kind which, int n) {
    const bool wide = which == kind::one_double || which == kind::pack_of_double;
    return wide ? n <= 8 || n % 8 == 0 : n == 2 || n == 6 || n == 7 || n == 32;
}

int lanes(kind which);
/// Factorises and solves `lanes(which)` systems at once.
solutions solve(kind which, const systems& given);

}  // namespace lu_lanes
