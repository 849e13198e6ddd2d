// SPDX-License-Identifier: MIT
// The matrix of stiff methods of a tape: its pattern, the groups of its columns and the tables of its factors, as they
// are found at compile time for models that are compiled (kernel/stepper/sparse_lu.hpp).
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "tape.hpp"

namespace myriad::python {

/// Rows and columns of the entries of a Jacobian that may differ from zero.
using tape_entries = std::vector<std::pair<int, int>>;

/// The tables with their memory. `tables()` points into it.
class stored_matrix {
public:
    stored_matrix(int states, const tape_entries& entries);
    stored_matrix(const stored_matrix&) = delete;
    stored_matrix& operator=(const stored_matrix&) = delete;
    const tape_matrix& tables() const { return tables_; }

private:
    using numbers = std::vector<std::int32_t>;
    void group_columns(int n);
    void factorise(int n);

    numbers row_, column_, group_of_column_, begin_, in_group_, pivot_, diagonal_, lower_begin_, upper_begin_,
        lower_entry_, lower_row_, upper_entry_, upper_column_, first_update_, target_, target_row_, position_,
        pivot_row_;
    tape_matrix tables_;
};

}  // namespace myriad::python
