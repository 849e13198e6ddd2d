// SPDX-License-Identifier: MIT
// Checks the matrices of couplings, and what a unit reads.
#include "myriad/host/ensemble/coupling_entries.hpp"

#include <cmath>

#include "myriad/host/core/error.hpp"

namespace myriad::host::inline MYRIAD_ABI {

std::vector<double> coupling_entries(const detail::coupling_layout& layout, int coupling, const double* matrix,
                                     std::int64_t rows, std::int64_t columns) {
    const int units = layout.units;
    require(rows == columns, "the matrix of coupling ", coupling, " is not square, but has ", rows, " rows and ",
            columns, " columns", cure, "give it a row and a column for each of the ", units, " units");
    require(rows == units, "the matrix of coupling ", coupling, " has ", rows, " rows, but there are ", units, " units",
            cure, "give it a row and a column for each");
    const auto at = [&](int i, int j) { return matrix[i + static_cast<std::int64_t>(j) * rows]; };
    std::vector<double> entries(static_cast<std::size_t>(layout.entries()), 0.0);
    for (int i = 0; i < units; ++i) {
        std::vector<bool> has_place(static_cast<std::size_t>(units), false);
        for (int k = 0; k < layout.entries_of_row(); ++k) {
            const int j = layout.column(i, k);
            if (!layout.in_matrix(j)) continue;
            has_place[static_cast<std::size_t>(j)] = true;
            double& entry = entries[static_cast<std::size_t>(layout.entry(i, k))];
            require(std::isfinite(at(i, j)), "entry (", i, ", ", j, ") of the matrix of coupling ", coupling, " is ",
                    at(i, j), cure, "give finite numbers");
            require(layout.shape != coupling_shape::circulant || i == 0 || entry == at(i, j), "the matrix of coupling ",
                    coupling, " is not circulant: entry (", i, ", ", j, ") is ", at(i, j), ", but ", entry, " in row 0",
                    cure, "make every row the one above it, moved by one place, or declare a full_coupling");
            entry = at(i, j);
        }
        for (int j = 0; j < units; ++j)
            require(has_place[static_cast<std::size_t>(j)] || at(i, j) == 0, "entry (", i, ", ", j,
                    ") of the matrix of coupling ", coupling, " is ", at(i, j), ", outside the band of ",
                    layout.bandwidth, " diagonals on either side", cure,
                    "declare the coupling with a larger bandwidth");
    }
    return entries;
}

}  // namespace myriad::host::inline MYRIAD_ABI

namespace myriad::detail {

void refuse_unit(int unit, int units) {
    host::refuse({"a unit reads unit ", unit, ", but there are ", units, " units, counted from 0", host::cure,
                  "write its number round the ends, (unit + 1) % y.units, or leave the last one out"});
}

}  // namespace myriad::detail
