// SPDX-License-Identifier: MIT
// `solve` on several GPUs: a thread for each, which takes the next part of the instances whenever it has done one.
#pragma once

#include <vector>

#include "myriad/host/backend/backend.hpp"
#include "myriad/host/checks/data_check.hpp"
#include "myriad/host/chunks/idle_engines.hpp"
#include "myriad/host/chunks/progress_relay.hpp"
#include "myriad/host/ensemble/ensemble_data.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/host/report/report_of.hpp"
#include "myriad/kernel/core/abi.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// One call of `solve` on several GPUs. Throws `error` if an input is invalid or a GPU fails.
template <class R>
void solve_on_several_gpus(const options& o, const std::vector<engine_source<R>>& sources,
                           const any_arguments<R>& arguments, ensemble_data<R>& instances, data_check<R>& check,
                           progress_relay& relay, report_of<R>& result);

}  // namespace myriad::host::inline MYRIAD_ABI
