// SPDX-License-Identifier: MIT
// Refuses event tolerances that rounding cannot meet. Compiled in the library. Host code only.
#pragma once

#include <cstdint>

#include "myriad/host/checks/instance_functions.hpp"
#include "myriad/host/ensemble/ensemble_data.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/kernel/core/abi.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// Throws `error` if an event tolerance is below the resolution of its function in most instances; in single ones,
/// whose state may be huge, crossings are located as well as rounding lets them. Looks at a thousand or so of the first
/// `count` instances, spread over them. Nothing is checked where the model cannot be asked.
template <class R>
void check_event_tolerances(const ensemble_data<R>& e, const options& o, std::int64_t count,
                            const single_instances<R>& of);

}  // namespace myriad::host::inline MYRIAD_ABI
