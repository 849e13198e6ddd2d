// SPDX-License-Identifier: MIT
// What is known of the matrix of a stiff method before it runs: plain data.
#pragma once

#include <cstdint>

namespace myriad {

/// The matrix that a stiff method factorises in every step; zeros for other methods.
struct matrix_facts {
    std::int32_t states = 0;            ///< its rows and columns
    std::int32_t jacobian_entries = 0;  ///< derivatives that may differ from zero, as far as the compiler could find
    std::int32_t factor_entries = 0;    ///< numbers in its factors
    /// Evaluations of `rhs` with dual numbers that give the Jacobian: groups of columns without a common row, or all
    /// columns; 0 where the model has its own `jacobian`.
    std::int32_t jacobian_evaluations = 0;
    bool lacks_pattern = false;  ///< no pattern could be found, and one would be of use
};

}  // namespace myriad
