// SPDX-License-Identifier: MIT
// Loops over the components of a state, written out as far as a method's steps gain from it.
#pragma once

#include "myriad/kernel/core/macros.hpp"
#include "myriad/kernel/methods/rosenbrock_tableau.hpp"

namespace myriad::detail::inline MYRIAD_TARGET {

/// Calls use(c) for the components from `first` to `end`. On a GPU, beside factors that are written out, a loop keeps a
/// copy of every vector in local memory: a ring of 64 states took 14.1 kB a thread and 119 ms for 1000 instances, and
/// written out 9.4 kB and 87 ms (NVIDIA H200, rodas_5p). Explicit steps of about 60 states are too large for nvcc when
/// written out, and all lie in local memory: 65 536 instances of Lorenz 96 with 64 states, by dormand_prince_5, took 62
/// ms written out and 16 as loops; with 48 states 4.8 and 8.4 (NVIDIA H100). On a CPU, loops keep factors in memory,
/// too: the pollution model by rodas_5p took 0.10 microseconds a step written out and 0.22 otherwise. Explicit steps
/// lie in memory from 17 states on, and there written out their code outgrows the instruction cache: Lorenz 96 with 32,
/// 64 and 128 states by tsitouras_5 took 2.1, 2.2 and 2.5 ns a state written out, and 1.3, 1.4 and 2.0 as loops (Zen 5,
/// AVX-512, g++ 12).
template <class Method, int first, int end, class Use>
MYRIAD_FUNCTION void each_component(Use&& use) {
    if constexpr (rosenbrock_method<Method>) {
        MYRIAD_UNROLL_UP_TO(128, 128)
        for (int c = first; c < end; ++c) use(c);
    } else {
        MYRIAD_UNROLL_UP_TO(54, 16)
        for (int c = first; c < end; ++c) use(c);
    }
}
/// The same for the first n.
template <class Method, int n, class Use>
MYRIAD_FUNCTION void each_component(Use&& use) {
    detail::each_component<Method, 0, n>(use);
}

}  // namespace myriad::detail::inline MYRIAD_TARGET
