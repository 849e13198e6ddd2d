// SPDX-License-Identifier: MIT
// How far a run is to stop: what the host asks of kernels while they run.
#pragma once

#include <cstdint>

namespace myriad::detail {

/// How far a run is to stop.
enum class stop_request : std::uint32_t {
    none,
    begin_no_more,  ///< of its instances
    end_now,        ///< those under way end as `interrupted`
    end_all,        ///< those not begun, too, as they are
};
/// Whether instances under way are to end. Until then a GPU completes the chunks that it has.
constexpr bool ends_kernels(stop_request r) { return r >= stop_request::end_now; }

}  // namespace myriad::detail
