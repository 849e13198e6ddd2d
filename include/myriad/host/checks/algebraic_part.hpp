// SPDX-License-Identifier: MIT
// The algebraic equations of a system with a singular mass matrix, of any model. Host code.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "myriad/kernel/core/abi.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// The algebraic part of M y' = f: each `left` vector v, v M = 0, gives an equation v f = 0; each `right` vector w, M w
/// = 0, is a direction in which the state may be set without changing M y.
struct algebraic_part {
    int n, count = 0;
    std::vector<double> left, right;  // `count` rows of n

    algebraic_part(int size, const std::vector<double>& mass);
};

/// The algebraic equations at one state, linearised.
struct algebraic_equations {
    const algebraic_part& of;
    std::vector<double> residual;  // v f
    std::vector<double> slope;     // v df/dy, `of.count` rows of n

    /// The slopes f, and df/dy row by row.
    algebraic_equations(const algebraic_part& part, const std::vector<double>& f, const std::vector<double>& jacobian);
    /// The change along the right vectors with which all residuals vanish; false if the equations do not determine it,
    /// as in a system of a higher index.
    bool solve(std::vector<double>& change) const;
    /// Equation k as text, such as "0 = f_z", with what a function calls the states.
    std::string text(int k, const std::function<std::string(int)>& name_of) const;
};

}  // namespace myriad::host::inline MYRIAD_ABI
