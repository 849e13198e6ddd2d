// SPDX-License-Identifier: MIT
// Refuses phases that would have no length because time continues from phase to phase and has reached t_end. Host code
// only.
#pragma once

#include <cstdint>

#include "myriad/host/checks/data_check.hpp"
#include "myriad/host/ensemble/ensemble.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/model/hooks.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// Whether something can end a phase before t_end.
template <class Model, class R>
bool may_end_early(const options& o) {
    if constexpr (writes_time_domain<Model> || hooks_may_stop<Model, R>()) return true;
    return events_may_stop(o);
}

/// `find_phases_left` of the ensemble's data.
template <class Model, class R>
phases_left find_phases_left(const ensemble<Model, R>& e, const options& o, std::int64_t count) {
    return find_phases_left(ensemble_access::data(e), o, count, may_end_early<Model, R>(o));
}

}  // namespace myriad::host::inline MYRIAD_ABI
