// SPDX-License-Identifier: MIT
// What a report says of the matrix of a stiff method. Compiled in the library. Host code only.
#pragma once

#include "myriad/host/report/report_of.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/model/matrix_facts.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// What a stiff method makes of the Jacobian; adds a note if its pattern is not known and would be of use.
template <class R>
void note_matrix(report_of<R>& r, const matrix_facts& facts);

}  // namespace myriad::host::inline MYRIAD_ABI
