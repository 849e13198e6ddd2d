// SPDX-License-Identifier: MIT
// `solve` on a GPU: in chunks, so that one is prepared by the host, others are copied, and one is integrated at the
// same time.
#pragma once

#include "myriad/host/backend/backend.hpp"
#include "myriad/host/checks/data_check.hpp"
#include "myriad/host/chunks/chunk_plan.hpp"
#include "myriad/host/chunks/idle_engines.hpp"
#include "myriad/host/chunks/progress_relay.hpp"
#include "myriad/host/ensemble/ensemble_data.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/host/report/report_of.hpp"
#include "myriad/kernel/core/abi.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// One call of `solve` on a GPU.
template <class R>
void solve_in_chunks(const options& o, const engine_source<R>& source, const any_arguments<R>& arguments,
                     ensemble_data<R>& instances, data_check<R>& check, progress_relay& relay, report_of<R>& result);

}  // namespace myriad::host::inline MYRIAD_ABI
