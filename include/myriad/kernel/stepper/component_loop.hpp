// SPDX-License-Identifier: MIT
// Loops over the components of a state, written out as far as a method's steps gain from it.
#pragma once

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/methods/rosenbrock_tableau.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// Calls use(c) for the components from `first` to `end`. The limits up to which loops are written out were measured:
/// - Stiff methods, GPU: beside factors that are written out, a loop keeps a copy of every vector in local memory. 1000
///   rings of 64 states by rodas_5p took 119 ms and 14.1 kB a thread as loops, and 87 ms and 9.4 kB written out (H200).
/// - Stiff methods, CPU: loops keep factors in memory. A step of the pollution model by rodas_5p took 0.22 microseconds
///   with loops and 0.10 written out.
/// - Explicit methods, GPU: written out, steps of about 60 states are too large for nvcc, which puts all of them in
///   local memory. 65 536 instances of Lorenz 96 by dormand_prince_5 took, written out and as loops, 4.8 and 8.4 ms
///   with 48 states, and 62 and 16 ms with 64 (H100).
/// - Explicit methods, CPU: from 17 states on, steps lie in memory anyway, and written out they outgrow the instruction
///   cache. Lorenz 96 with 32, 64 and 128 states by tsitouras_5 took 2.1, 2.2 and 2.5 ns per state and step written
///   out, and 1.3, 1.4 and 2.0 as loops (Zen 5, AVX-512, g++ 12).
template <class Method, int first, extent end, class Use>
MYRIAD_FUNCTION void each_component(Use&& use) {
    if constexpr (rosenbrock_method<Method>) {
        MYRIAD_UNROLL_UP_TO(128, 128)
        for (int c = first; c < MYRIAD_LENGTH(end); ++c) use(c);
    } else {
        MYRIAD_UNROLL_UP_TO(54, 16)
        for (int c = first; c < MYRIAD_LENGTH(end); ++c) use(c);
    }
}
/// The same for the first n.
template <class Method, extent n, class Use>
MYRIAD_FUNCTION void each_component(Use&& use) {
    detail::each_component<Method, 0, n>(use);
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
