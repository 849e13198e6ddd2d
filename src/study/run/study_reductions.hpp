// SPDX-License-Identifier: MIT
// Reductions of a running study, of a chunk and of all chunks.
#pragma once

#include <vector>

#include "myriad/study/plan/study_plan.hpp"
#include "myriad/study/run/result_keeper.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

/// The partial result of a chunk, from its values. The library's own reductions do not depend on the order, so that
/// several threads share them.
std::vector<double> reduced_on_host(const reduction_plan& plan, const chunk_range& range,
                                    const std::vector<chunk_columns::column>& all);
/// Writes the results of all reductions that are not there, from the partial ones.
void finish_reductions(const study_plan& plan, result_keeper& keeper);

}  // namespace myriad::studies::inline MYRIAD_ABI
