// SPDX-License-Identifier: MIT
// Refuses phases that would have no length because time continues from phase to phase and has reached t_end. Host code
// only.
#pragma once

#include <cstdint>
#include <type_traits>
#include <utility>

#include "myriad/host/checks/data_check.hpp"
#include "myriad/host/ensemble/ensemble.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/kernel/core/abi.hpp"
#include "myriad/kernel/model/hooks.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// Whether a hook's return value can end a phase.
template <class Model, class R>
constexpr bool hooks_may_stop() {
    using one_lane = lane<Model, R>;
    if constexpr (has_generic_after_step<Model, R>) {
        if (!std::is_void_v<decltype(Model::template after_step<R>(std::declval<one_lane&>()))>) return true;
    } else if constexpr (has_after_step<Model>) {
        if (!std::is_void_v<decltype(Model::after_step(std::declval<one_lane&>()))>) return true;
    }
    if constexpr (has_after_event<Model>) {
        if (!std::is_void_v<decltype(Model::after_event(0, std::declval<one_lane&>()))>) return true;
    }
    return false;
}

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
