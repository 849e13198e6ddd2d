// SPDX-License-Identifier: MIT
// Refuses event tolerances that rounding cannot meet. Compiled in the library. Host code only.
#pragma once

#include <cstdint>

#include "myriad/host/ensemble/ensemble_data.hpp"
#include "myriad/host/options/options.hpp"
#include "myriad/kernel/core/abi.hpp"

namespace myriad::host::inline MYRIAD_ABI {

/// `event_resolution` of any instance, without the model's type.
template <class R>
struct any_event_resolution {
    void* of;  ///< what `evaluate` takes
    /// What rounding leaves of the event functions of instance i: the larger of both, for each event.
    void (*evaluate)(void* of, std::int64_t i, R* finest);
};

/// Throws `error` if an event tolerance is below the resolution of its function in most instances; in single ones,
/// whose state may be huge, crossings are located as well as rounding lets them. Looks at a thousand or so of the first
/// `count` instances, spread over them.
template <class R>
void check_event_tolerances(const ensemble_data<R>& e, const options& o, std::int64_t count,
                            const any_event_resolution<R>& resolution);

extern template void check_event_tolerances(const ensemble_data<double>&, const options&, std::int64_t,
                                            const any_event_resolution<double>&);
extern template void check_event_tolerances(const ensemble_data<float>&, const options&, std::int64_t,
                                            const any_event_resolution<float>&);

}  // namespace myriad::host::inline MYRIAD_ABI
