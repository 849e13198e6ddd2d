// SPDX-License-Identifier: MIT
// `solve` on GPUs: in chunks, so that one is prepared by the host, others are copied, and one is integrated at the same
// time, on one GPU or on several.
#pragma once

#include <vector>

#include "myriad/host/backend/backend.hpp"
#include "myriad/host/checks/data_check.hpp"
#include "myriad/host/chunks/idle_engines.hpp"
#include "myriad/host/chunks/progress_relay.hpp"
#include "myriad/host/chunks/results_on_gpu.hpp"
#include "myriad/host/ensemble/ensemble_data.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/host/report/report_of.hpp"
#include "myriad/kernel/core/abi.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// One call of `solve` on GPUs. Throws `error` if an input is invalid or a GPU fails. If `stay` is not null, results
/// stay on the GPU, the only one, where they fit.
template <class R>
void solve_in_chunks(const options& o, const std::vector<engine_source<R>>& gpus, const any_arguments<R>& arguments,
                     ensemble_data<R>& instances, data_check<R>& check, progress_relay& relay, report_of<R>& result,
                     results_on_gpu<R>* stay);

}  // namespace myriad::host::inline MYRIAD_ABI
