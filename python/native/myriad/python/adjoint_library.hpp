// SPDX-License-Identifier: MIT
// What a file that the Python package compiles for gradients by an adjoint on CPUs includes: MYRIAD_ADJOINT makes the
// shared object's one exported function.
#pragma once

#include <cstdint>

#include "myriad/host/threads/default_arithmetic.hpp"
#include "myriad/kernel/stepper/method_check.hpp"
#include "myriad/methods.hpp"
#include "myriad/model.hpp"
#include "myriad/openmp/packs.hpp"
// after the packs, whose functions it calls
#include "myriad/python/adjoint_pack.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// The instances from `first` to `end`.
template <class Adjoint, class Method>
void run_adjoint(const python::adjoint_call& call, std::int64_t first, std::int64_t end) {
    constexpr int batches = default_batches<Adjoint, Method>() > 0 ? 1 : 0;
    using S = typename lane_kind<double, batches>::type;
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

/// Makes the adjoint of a model and a method the shared object's. The arguments may not contain commas.
#define MYRIAD_ADJOINT(Adjoint, Method)                                                                             \
    extern "C" __attribute__((visibility("default"))) void myriad_adjoint(const myriad::python::adjoint_call* call, \
                                                                          std::int64_t first, std::int64_t end) {   \
        myriad::detail::run_adjoint<Adjoint, Method>(*call, first, end);                                            \
    }
