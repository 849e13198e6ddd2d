// SPDX-License-Identifier: MIT
// The threads that host code borrows for its loops over all instances.
#pragma once

#include <omp.h>

#include "myriad/core/macros.hpp"
#include "myriad/core/parallel.hpp"

namespace myriad::openmp {

// Weak, and so in every model's object file; the linker keeps one for each instruction set.
__attribute__((weak)) int most_parts(for_set<instruction_set::MYRIAD_INSTRUCTION_SET>) {
    return omp_in_parallel() != 0 ? 1 : omp_get_max_threads();
}

__attribute__((weak)) void in_parts(for_set<instruction_set::MYRIAD_INSTRUCTION_SET>, int parts, void (*body)(void*, int),
                                    void* context) {
#pragma omp parallel for num_threads(parts) schedule(static, 1)
    for (int part = 0; part < parts; ++part) body(context, part);
}

}  // namespace myriad::openmp
