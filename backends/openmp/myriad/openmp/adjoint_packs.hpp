// SPDX-License-Identifier: MIT
// The adjoint on the CPU: the lanes of a pack go back through the recorded steps of instances.
#pragma once

#include <cstdint>

#include "myriad/host/threads/default_arithmetic.hpp"
#include "myriad/openmp/packs.hpp"
// after the packs, whose functions it calls
#include "myriad/kernel/adjoint/adjoint_pack.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// The numbers of the lanes of an adjoint.
template <class Adjoint, class Method>
using adjoint_lanes = typename lane_kind<double, (default_batches<Adjoint, Method>() > 0 ? 1 : 0)>::type;

/// The instances from `first` to `end`.
template <class Adjoint, class Method>
void run_adjoint(const adjoint_call& call, std::int64_t first, std::int64_t end) {
    using S = adjoint_lanes<Adjoint, Method>;
    const default_arithmetic here;
    for (; first < end; first += lanes_of<S>) {
        if (call.values != nullptr) {
            adjoint_pack<Adjoint, Method, S, true>(call, first, end).run();
        } else {
            adjoint_pack<Adjoint, Method, S, false>(call, first, end).run();
        }
    }
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
