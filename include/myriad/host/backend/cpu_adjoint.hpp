// SPDX-License-Identifier: MIT
// The interface between host code and the adjoint of a model on the CPU.
#pragma once

#include "myriad/host/backend/cpu_backend.hpp"
#include "myriad/kernel/adjoint/adjoint_call.hpp"

namespace myriad::openmp {

/// The adjoint for one instruction set, as the kernels: cpu_backend.hpp.
#define MYRIAD_DECLARE_ADJOINT(set)                                                                     \
    template <class Model, class Method, class Counts = component_counts<Model>>                        \
    __attribute__((weak)) run_statistics adjoint_on(for_set<instruction_set::set>, const adjoint_call&, \
                                                    const run_options&);
MYRIAD_DECLARE_ADJOINT(avx512)
MYRIAD_DECLARE_ADJOINT(avx2)
MYRIAD_DECLARE_ADJOINT(sse2)
MYRIAD_DECLARE_ADJOINT(generic)
#undef MYRIAD_DECLARE_ADJOINT

}  // namespace myriad::openmp
