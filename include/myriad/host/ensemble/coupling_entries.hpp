// SPDX-License-Identifier: MIT
// The entries of a coupling's matrix as its units read them. Host code only.
#pragma once

#include <cstdint>
#include <vector>

#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/model/coupling.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// The entries of a coupling in the order of its layout, from a matrix stored column by column. Throws `error` if the
/// matrix is not square, has a row for other than every unit, or entries that are not finite or not of that shape.
std::vector<double> coupling_entries(const detail::coupling_layout& layout, int coupling, const double* matrix,
                                     std::int64_t rows, std::int64_t columns);

}  // namespace host::inline MYRIAD_ABI
